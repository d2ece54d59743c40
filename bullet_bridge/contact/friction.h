// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>

#include "BulletSoftBody/btSoftBody.h"

namespace bullet_fem
{

/// No contact of Bullet's own has more [-]. Far above it, a touch that is about to end throws nodes: what little it
/// presses with would still hold them.
constexpr double kLargestFriction = 10;

/// Coulomb's coefficient between a soft body and another object [-], in [0, kLargestFriction]: kDF times its
/// getFriction(), or the larger kDF where that is a soft body, too. What is no number counts as 0.
inline double frictionBetween(const btSoftBody& body, const btCollisionObject& other)
{
    const btSoftBody* soft = btSoftBody::upcast(&other);
    const double mu =
        soft ? double(std::max(body.m_cfg.kDF, soft->m_cfg.kDF)) : double(body.m_cfg.kDF) * double(other.getFriction());
    return mu > 0 ? std::min(mu, kLargestFriction) : 0;
}

}  // namespace bullet_fem
