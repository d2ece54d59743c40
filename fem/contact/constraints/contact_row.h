// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// One side of a row: a point or group of a soft body, a point of a rigid proxy, or, with neither, the world.
struct ConstraintSide
{
    int m_body = -1, m_end = -1;  ///< soft: index into the problem's bodies, and side index within the body
    int m_rigidProxy = -1;        ///< rigid: index into the problem's rigid proxies
    bool m_angular = false;       ///< rigid: its velocity is the angular one, and impulses are angular
    int m_jacobian = -1;          ///< rigid: index into the problem's Jacobians, see JointEnd; -1: none
    Vec3 m_arm;                   ///< rigid: lever arm from the rigid proxy's centre [m]

    bool sharesOwner(const ConstraintSide& other) const
    {
        return m_body == other.m_body && m_rigidProxy == other.m_rigidProxy;
    }
};

/// A contact, a joint or a torsional friction: three impulses between two sides. The members read most often come
/// first.
struct ContactRow
{
    bool m_joint = false;
    bool m_held = false;     ///< a joint at a limit, which is swept like a contact
    bool m_touch = false;    ///< a contact between rigid proxies
    bool m_torsion = false;  ///< rolling and spinning friction: angular about all axes
    bool m_idle = false;     ///< nothing can move: no compliance
    ConstraintSide m_a, m_b;
    Vec3 m_impulse;         ///< impulse on side a [N s] or [N m s]
    Vec3 m_target;          ///< target of the relative velocity along the axes: minimum (normal) or exact (joint) [m/s]
    Vec3 m_axes[3];         ///< normal and tangents; a joint's axes [-]
    Vec3 m_rowCompliance;   ///< compliance of every axis; a contact's tangents share the largest of their plane [1/kg]
    Vec3 m_yield;           ///< compliance added along the axes [1/kg]
    double m_friction = 0;  ///< Coulomb friction coefficient [-]
    double m_aspect = 1;    ///< that along the second tangent over that along the first
    Mat3 m_compliance;      ///< response of the relative velocity to the impulse [1/kg]
    Vec3 m_bestImpulse;     ///< impulse at the end of the best outer iteration
    Vec3 m_limit;           ///< maximum impulses of a joint along its axes
    Vec3 m_lower;           ///< minimum impulses of a joint along its axes, at least -m_limit
    double m_maxImpulse = 0;  ///< maximum norm of a joint's impulse
    double m_softness = 0;    ///< joint: added compliance as a multiple of its own [-]
    double m_spring = 0;      ///< joint: added compliance [1/kg]
    int m_pressed = -1;       ///< contact: row of the torsional friction that its normal impulse loads
    double m_load = 0;        ///< torsional friction: sum of these normal impulses [N s]
    double m_maxLoad = 0;     ///< torsional friction: maximum of m_load that counts [N s]
    double m_lever = 1;       ///< torsional friction: lever that converts spin to speed [m]
};

/// True if both rows act on equal owners.
inline bool sharesOwners(const ContactRow& a, const ContactRow& b)
{
    return a.m_a.sharesOwner(b.m_a) && a.m_b.sharesOwner(b.m_b);
}

/// True for a joint within its limits.
inline bool isSolvedAtOnce(const ContactRow& row)
{
    return row.m_joint && !row.m_held;
}

/// The impulse that satisfies a row's law, for a relative velocity [m/s] at the given impulse. `step`: relaxation
/// factor; only at 1 are axes solved one after another, as in Gauss-Seidel.
Vec3 wantedImpulse(const ContactRow& row, const Vec3& impulse, const Vec3& velocity, double step);

/// True for a contact whose friction is below its Coulomb limit: it does not slide.
bool sticks(const ContactRow& row);

/// Change of a row's impulse, expressed as the velocity change of its own point [m/s].
double speedOf(const ContactRow& row, const Vec3& difference);

}  // namespace bullet_fem
