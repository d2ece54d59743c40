// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <optional>

#include "bullet_fem/fem/body/body.h"

namespace bullet_fem
{

/// The rigid part of a body's motion.
struct MeanMotion
{
    Vec3 m_velocity;  ///< of the centre of mass [m/s]
    Vec3 m_spin;      ///< angular velocity from the angular momentum about the centre of mass [rad/s]
};

/// Mean motion of a body without its loose nodes. Zero if it has several connected components or a fixed node.
MeanMotion meanMotion(const Body& body);

/// One side of a contact between two surfaces.
struct ContactPatchSide
{
    Vec3 m_velocity;         ///< of the material at the contact [m/s]
    Vec3 m_spin;             ///< angular velocity of the body [rad/s]
    double m_curvature = 0;  ///< [1/m]; 0: flat
    double m_size = 0;  ///< size of the body [m]; between two flat sides the patch moves with the smaller one; may be
                        ///< infinite
    std::optional<Vec3> m_ofMass;  ///< velocity of the centre of mass of a body with few facets [m/s]
};

/// Displacement between the contact patch and the material point of side a after a time h [s], across `normal` (unit,
/// from b to a) [m]. Adding it to the point of contact gives the lever of the impulse about centres at the start of the
/// step. The patch of a rolling ball moves with the ball's centre, while the material in contact is at rest; between
/// two curved surfaces, the patch is on the line between their centres of curvature. A body with few facets rolls from
/// corner to corner: its patch is not faster than its centre of mass, otherwise its own weight would drive it. With a
/// lever to the material at the start of the step, a ball that rolls with v would be braked as if its weight acted v h
/// ahead of it.
Vec3 patchLag(const ContactPatchSide& a, const ContactPatchSide& b, const Vec3& normal, double h);

/// The curvature [1/m] that counts for patches: 0 below half an inverse size [m], since flat sides have some curvature
/// by rounding.
double roundness(double curvature, double size);

}  // namespace bullet_fem
