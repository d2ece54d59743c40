// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>

#include "BulletSoftBody/btSoftBody.h"

namespace bullet_fem
{

/// Largest friction coefficient [-], as in Bullet's own contacts. Far larger values throw nodes: a contact that is
/// about to separate would still hold them with its small normal force.
constexpr double kLargestFriction = 10;

/// Coulomb's friction coefficient between a soft body and another object [-], in [0, kLargestFriction]: kDF times the
/// object's getFriction(), or the larger kDF of two soft bodies. NaN counts as 0.
inline double frictionBetween(const btSoftBody& body, const btCollisionObject& other)
{
    const btSoftBody* soft = btSoftBody::upcast(&other);
    const double mu =
        soft ? double(std::max(body.m_cfg.kDF, soft->m_cfg.kDF)) : double(body.m_cfg.kDF) * double(other.getFriction());
    return mu > 0 ? std::min(mu, kLargestFriction) : 0;
}

}  // namespace bullet_fem
