// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/cage/surface_mesh.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{

/// A body in a cage with a render surface, which may collide.
struct SkinBody
{
    SurfaceMesh m_surface;
    double m_cell = 0.13;  ///< of the cage [m]
    bool m_surfaceCollides = true;
    btScalar m_youngModulus = btScalar(5e5);  ///< [Pa]
    btScalar m_friction = btScalar(0.5);      ///< its kDF [-]
};

/// A ball of radius 0.5 m around a point, of 1,280 triangles, in a cage of eight cells across.
SkinBody skinBall(const Vec3& centre);

/// A box with these edges [m] around a point, of squares of some 0.1 m by default, in a cage that protrudes on all
/// sides.
SkinBody skinBox(const Vec3& size, const Vec3& centre, double square = 0.1);

/// Makes the body, of 1000 kg/m3; the caller owns it.
btSoftBody* makeSkinBody(SoftWorld& world, btFemSoftBodySolver& fem, const SkinBody& body);

/// Makes the body and adds it to the world.
btSoftBody& addSkinBody(SoftWorld& world, btFemSoftBodySolver& fem, const SkinBody& body);

/// Makes a body's own boundary its render surface.
void drawBoundary(btSoftBody& body);

/// Minimum height of a render vertex above the plane through the origin with this normal [m].
double lowestVertex(const btSoftBody& body, const Vec3& normal = {0, 0, 1});

}  // namespace bullet_fem
