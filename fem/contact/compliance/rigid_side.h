// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/body/rigid_momentum.h"

namespace bullet_fem
{

/// Rigid motion of a component about its centre.
struct RigidMotion
{
    Vec3 m_linear, m_angular;  ///< [m/s], [rad/s]

    RigidMotion& operator+=(const RigidMotion& other)
    {
        m_linear += other.m_linear;
        m_angular += other.m_angular;
        return *this;
    }
};

/// A contact side's share in the rigid motion of its component, six numbers per axis in place of a column of W: exact
/// in double precision, where the elastic columns may be small differences.
struct RigidSide
{
    RigidMomentum::Share m_share;     ///< momenta per unit impulse
    RigidMomentum::Share m_response;  ///< velocities per unit impulse

    /// Component that moves; -1: none.
    int component() const { return m_response.m_component; }

    Vec3 velocity(const RigidMotion& motion) const
    {
        return transposeTimes(m_share.m_linear, motion.m_linear) + transposeTimes(m_share.m_angular, motion.m_angular);
    }

    RigidMotion response(const Vec3& impulse) const
    {
        return {m_response.m_linear * impulse, m_response.m_angular * impulse};
    }

    /// Velocity of this side per unit impulse on another [1/kg].
    Mat3 block(const RigidSide& from) const
    {
        if (component() < 0 || component() != from.component()) return {};
        return transpose(m_share.m_linear) * from.m_response.m_linear +
               transpose(m_share.m_angular) * from.m_response.m_angular;
    }

    /// Adds a weighted side of the same component.
    void add(double weight, const RigidSide& other)
    {
        if (other.component() < 0) return;
        m_share.m_component = m_response.m_component = other.component();
        m_share.m_linear += weight * other.m_share.m_linear;
        m_share.m_angular += weight * other.m_share.m_angular;
        m_response.m_linear += weight * other.m_response.m_linear;
        m_response.m_angular += weight * other.m_response.m_angular;
    }
};

}  // namespace bullet_fem
