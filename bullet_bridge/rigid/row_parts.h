// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>
#include <cmath>

#include "bullet_fem/fem/contact/contact_problem.h"

namespace bullet_fem
{

/// One side of a row of Bullet's constraint solvers: its rigid proxy, and its motion before the solve.
struct RowSide
{
    int m_proxy = -1;                    ///< -1: impulses do not move it
    Vec3 m_center, m_linear, m_angular;  ///< centre [m], velocities [m/s], [rad/s]

    Vec3 velocityAt(const Vec3& arm) const { return m_linear + cross(m_angular, arm); }
};

/// The target of J v + y lambda beyond J v0 [m/s] or [rad/s]; false if it is not finite.
template <class Row>
bool targetBeyond(const Row& row, double& beyond)
{
    const double diagonal = double(row.m_jacDiagABInv);
    beyond = double(row.m_rhs) / diagonal;
    return diagonal > 0 && std::isfinite(beyond) && std::isfinite(double(row.m_cfm));
}

/// The compliance y of a row with a finite target [1/kg] or [1/(kg m2)].
template <class Row>
double complianceOf(const Row& row)
{
    return std::max(0.0, double(row.m_cfm) / double(row.m_jacDiagABInv));
}

/// A contact of two sides at points on both [m]. `normal` points to the first side, which moves; the target of its
/// separation speed is `beyond` that before the solve [m/s].
RigidContact contactOf(const RowSide& first, const RowSide& second, const Vec3& at, const Vec3& atSecond,
                       const Vec3& normal, double beyond);

/// Two directions of friction in the tangent plane of a contact, which need be neither unit nor orthogonal vectors.
struct FrictionPlane
{
    Vec3 m_first, m_second;  ///< [-]

    /// Bullet's directions, which scaling along the axes of bodies may tilt, projected to the tangent plane.
    FrictionPlane(const Vec3& normal, const Vec3& first, const Vec3& second)
        : m_first(first - dot(first, normal) * normal), m_second(second - dot(second, normal) * normal)
    {
    }
    FrictionPlane() = default;

    /// Components of a vector's part in the plane along both directions.
    void split(const Vec3& v, double& first, double& second) const;

    /// The vector in the plane with these products with both directions; 0 if they are parallel.
    Vec3 withProducts(double first, double second) const;

    /// Sets the cone for Bullet's pyramid with this coefficient. Directions that are no unit vectors span an ellipse.
    void setCone(double coefficient, RigidContact& contact) const;
};

/// Rolling and spinning friction of a contact as Bullet has it: about the normal, and about up to two tangents.
struct RollingFriction
{
    double m_spinning = 0;         ///< coefficient [m]
    Vec3 m_axes[2];                ///< about which it rolls; no unit vectors if it is anisotropic [-]
    double m_rolling[2] = {0, 0};  ///< coefficients [m]
    int m_count = 0;               ///< number of axes
    double m_maxLoad = 1e300;      ///< maximum pressing impulse that counts [N s]
    double m_lever = 1;            ///< see TorsionalFriction

    /// Sets the torsional friction of a contact; false if its axes are not finite.
    bool set(const RigidContact& contact, TorsionalFriction& torsion) const;
};

/// Limits of a row's impulse in a joint [N s] or [N m s]; m_sign -1: the joint has the opposite impulse, so that its
/// larger limit is the upper one.
struct RowLimits
{
    double m_lower, m_upper, m_sign;

    /// `lower` <= `upper`.
    RowLimits(double lower, double upper);
    /// True if the impulse may have both signs.
    bool areTwoSided() const { return m_lower < 0 && m_upper > 0; }
};

/// A row of Bullet that is a contact of the problem.
struct RowOfContact
{
    int m_row = 0;          ///< index in Bullet's array
    double m_sign = 1;      ///< of the problem's impulse as impulse on Bullet's side A; -1: that is the second side
    FrictionPlane m_plane;  ///< Bullet's directions of friction
};

/// A row of Bullet that is an axis of a joint of the problem.
struct RowOfAxis
{
    int m_row = 0;                ///< index in Bullet's array
    int m_joint = 0, m_axis = 0;  ///< index in the problem, and axis of the joint
    double m_sign = 1;            ///< of the joint's impulse as that of the row
};

}  // namespace bullet_fem
