// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "benchmarks/contact/contact_world.h"

namespace bullet_fem
{

// Measured on Bullet's bodies alone, equally for both engines.

/// Largest penetration [m] of the soft surfaces into the boxes and into each other, where surfaces closer than
/// `distance` [m], >= 0, count as penetrating; NaN if a node's position is not finite. Each surface triangle is sampled
/// at 15 lattice points. Boxes include Bullet's collision margin. Between soft bodies, points of downward faces are
/// measured vertically to upward faces below them, which suits slabs in contact face to face.
double deepestPenetration(const ContactWorld& world, double distance);

/// Total linear [kg m/s] and angular momentum about the origin [kg m2/s] of the moving bodies, and the sum of the
/// bodies' |p_i| [kg m/s].
struct Momentum
{
    Vec3 m_linear, m_angular;
    double m_scale = 0;
};

Momentum momentumOf(const ContactWorld& world);

/// Centres of mass [m], soft bodies first; for pinned bodies, of their free nodes.
std::vector<Vec3> centersOf(const ContactWorld& world);

}  // namespace bullet_fem
