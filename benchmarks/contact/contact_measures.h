// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "benchmarks/contact/contact_world.h"

namespace bullet_fem
{

// Measured on Bullet's bodies alone, so that both engines answer to the same ruler.

/// How deep the soft surfaces lie within `distance` [m] of the boxes and of each other [m], >= 0; NaN if a node's
/// position is not finite. Every surface triangle is sampled at 15 points in a triangular lattice, against the boxes as
/// Bullet means them (margin included). Between soft bodies, points of lower sides are measured straight down to upper
/// sides below them: right for slabs, face to face.
double deepestPenetration(const ContactWorld& world, double distance);

/// Linear [kg m/s] and angular momentum about the origin [kg m2/s] of all that moves, and the sum of the bodies'
/// |p_i| [kg m/s].
struct Momentum
{
    Vec3 m_linear, m_angular;
    double m_scale = 0;
};

Momentum momentumOf(const ContactWorld& world);

/// Centres of mass, soft bodies' first [m]; of pinned bodies, of their free nodes.
std::vector<Vec3> centersOf(const ContactWorld& world);

}  // namespace bullet_fem
