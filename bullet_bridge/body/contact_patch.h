// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <optional>

#include "bullet_fem/fem/body/body.h"

namespace bullet_fem
{

/// How a body moves as a whole.
struct MeanMotion
{
    Vec3 m_velocity;  ///< of the centre of mass [m/s]
    Vec3 m_spin;      ///< that the momentum has about it [rad/s]
};

/// 0 of bodies in several pieces, and of those of which some node is fixed.
MeanMotion meanMotion(const Body& body);

/// One of two surfaces where they touch.
struct TouchingSide
{
    Vec3 m_velocity;               ///< of its material there [m/s]
    Vec3 m_spin;                   ///< [rad/s]
    double m_curvature = 0;        ///< [1/m]; 0: flat
    double m_size = 0;             ///< of two flat ones the patch moves with the smaller; may be infinite [m]
    std::optional<Vec3> m_ofMass;  ///< velocity of the centre of mass of what has few facets [m/s]
};

/// How far the patch where two surfaces touch, as it moves, lags behind the point of the first one in a time h [s]:
/// what is to be added to a point that touches as the step ends, for the levers of its impulse about centres as the
/// step begins [m], across `normal` (unit, from b to a). The patch of a rolling ball moves with its centre, while the
/// material of either side stands still there; of two curved surfaces it is on the line between the centres of their
/// curvature. What has few facets rolls from corner to corner: there it goes no faster than the centre of mass, or the
/// body would be driven by its own weight. With levers to where the material is as the step begins a ball that rolls
/// with v would be braked as if its weight stood v h before it.
Vec3 patchLag(const TouchingSide& a, const TouchingSide& b, const Vec3& normal, double h);

/// A curvature [1/m] as far as it counts for patches: what is round has one of half an inverse size [m] at least, as a
/// flat side has some of rounding.
double roundness(double curvature, double size);

}  // namespace bullet_fem
