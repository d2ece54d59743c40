// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// What one side of a row pulls at: a soft body's end, a point of a rigid proxy, or, with neither, the world.
struct ConstraintSide
{
    int m_body = -1, m_end = -1;  ///< soft: indices into the problem's bodies, and into the body's ends
    int m_rigidProxy = -1;        ///< rigid: index into the problem's rigid proxies
    bool m_angular = false;       ///< rigid: its velocity is the angular one, and impulses are angular
    Vec3 m_arm;                   ///< rigid: from the rigid proxy's centre [m]

    bool sharesOwner(const ConstraintSide& other) const
    {
        return m_body == other.m_body && m_rigidProxy == other.m_rigidProxy;
    }
};

/// A contact, a joint or a torsional friction: three impulses between two ends. What every look at it reads comes
/// first.
struct ContactRow
{
    bool m_joint = false;
    bool m_held = false;     ///< of a joint: at a limit, and swept like a contact
    bool m_touch = false;    ///< of rigid proxies
    bool m_torsion = false;  ///< of rolling and spinning friction: angular about all axes
    bool m_idle = false;     ///< nothing can move: no compliance
    ConstraintSide m_a, m_b;
    Vec3 m_impulse;           ///< on end a [N s] or [N m s]
    Vec3 m_target;            ///< relative velocity along the axes: at least (normal), exactly (joint) [m/s]
    Vec3 m_axes[3];           ///< normal and tangents; a joint's axes [-]
    Vec3 m_rowCompliance;     ///< of every axis; a contact's tangents share the largest of their plane [1/kg]
    Vec3 m_yield;             ///< compliance added along the axes [1/kg]
    double m_friction = 0;    ///< [-]
    Mat3 m_compliance;        ///< of the relative velocity to the impulse [1/kg]
    Vec3 m_bestImpulse;       ///< at the end of the best round
    Vec3 m_limit;             ///< of a joint's impulses
    double m_maxImpulse = 0;  ///< and of their sum
    double m_softness = 0;    ///< of a joint: compliance added, as a share of its own [-]
    double m_spring = 0;      ///< of a joint: compliance added [1/kg]
    int m_pressed = -1;       ///< of a contact: row of the torsional friction that its normal impulse presses on
    double m_load = 0;        ///< of a torsional friction: the sum of these normal impulses [N s]
    double m_lever = 1;       ///< of a torsional friction: a spin times it counts as a speed [m]
};

/// True if both pull at the same two owners.
inline bool sharesOwners(const ContactRow& a, const ContactRow& b)
{
    return a.m_a.sharesOwner(b.m_a) && a.m_b.sharesOwner(b.m_b);
}

/// True of a joint within its limits.
inline bool isSolvedAtOnce(const ContactRow& row)
{
    return row.m_joint && !row.m_held;
}

/// The impulse that a row wants for a relative velocity [m/s] that it has at another impulse. `step`: share of the way;
/// only at 1 are axes solved one after another, as in Gauss-Seidel.
Vec3 wantedImpulse(const ContactRow& row, const Vec3& impulse, const Vec3& velocity, double step);

/// True of a contact whose friction is below what its normal impulse allows: it does not slide.
bool sticks(const ContactRow& row);

/// A change of a row's impulse as a velocity: what it does to the row's own point [m/s].
double speedOf(const ContactRow& row, const Vec3& difference);

}  // namespace bullet_fem
