// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>

#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/fem/common/vec3.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{

/// A soft box, axis-aligned unless rotated.
struct SoftBox
{
    Vec3 m_size = {1, 1, 1};                  ///< [m]
    std::array<int, 3> m_cells = {4, 4, 4};   ///< along each axis
    Vec3 m_center;                            ///< [m]
    btScalar m_youngModulus = btScalar(1e6);  ///< [Pa]
    btScalar m_density = 1000;                ///< [kg/m3]
    btScalar m_friction = btScalar(0.5);      ///< its kDF [-]
    double m_turn = 0;                        ///< about the vertical through its centre [rad]
    btFemBending m_bending = btFemBending::automatic;
};

/// Makes the body with its material.
btSoftBody* makeSoftBox(btSoftBodyWorldInfo& info, btFemSoftBodySolver& fem, const SoftBox& box);
btSoftBody* makeSoftBox(SoftWorld& world, btFemSoftBodySolver& fem, const SoftBox& box);

/// Makes the body and adds it to the world.
btSoftBody& addSoftBox(SoftWorld& world, btFemSoftBodySolver& fem, const SoftBox& box);

/// A cube of the default material: edges of 1 m, cells of 0.25 m.
btSoftBody& addUnitCube(SoftWorld& world, const btVector3& center);

/// A cube of the default material: edges of 0.4 m, cells of 0.1 m; lower face at height `lowest`, centre at y = 0 and
/// this x [m].
btSoftBody& addSmallCube(SoftWorld& world, btScalar lowest, btScalar x = 0);

/// Pins the nodes that are below a height [m].
void clampBelow(btSoftBody& body, double height);

/// Four static walls around the origin, 8 m high, with inner faces at these distances [m].
void addWalls(SoftWorld& world, double halfX, double halfY);

/// A rigid box with these edges [m].
btRigidBody& addRigidBox(SoftWorld& world, const Vec3& size, const RigidSettings& settings);

}  // namespace bullet_fem
