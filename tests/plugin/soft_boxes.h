// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>

#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/fem/vec3.h"
#include "plugin/soft_world.h"

namespace bullet_fem
{

/// A soft box along the axes.
struct SoftBox
{
    Vec3 m_size = {1, 1, 1};                  ///< [m]
    std::array<int, 3> m_cells = {4, 4, 4};   ///< along every axis
    Vec3 m_center;                            ///< [m]
    btScalar m_youngModulus = btScalar(1e6);  ///< [Pa]
    btScalar m_density = 1000;                ///< [kg/m3]
    btScalar m_friction = btScalar(0.5);      ///< its kDF [-]
};

/// Makes one and gives it its material.
btSoftBody* makeSoftBox(SoftWorld& world, btFemSoftBodySolver& fem, const SoftBox& box);

/// And adds it to the world.
btSoftBody& addSoftBox(SoftWorld& world, btFemSoftBodySolver& fem, const SoftBox& box);

/// A rigid box with these edges [m].
btRigidBody& addRigidBox(SoftWorld& world, const Vec3& size, const RigidSettings& settings);

}  // namespace bullet_fem
