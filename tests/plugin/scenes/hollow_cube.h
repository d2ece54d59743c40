// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "bullet_fem/btFemHelpers.h"
#include "fem/scenes/hollow_meshes.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{

// A cube of .3 m with a cavity of .1 m in its middle.
inline TetMesh hollowCube()
{
    const auto inside = [](double x) { return std::fabs(x - 0.15) < 0.05; };
    return withHoles(makeBox({0.3, 0.3, 0.3}, {6, 6, 6}),
                     [&](const Vec3& X) { return inside(X.x) && inside(X.y) && inside(X.z); });
}

inline btSoftBody& addHollowCube(SoftWorld& world, btFemSoftBodySolver& fem, const btVector3& corner)
{
    btSoftBody* body = btFemHelpers::createFromTetMesh(world.info(), hollowCube());
    body->translate(corner);
    btFemMaterial material;
    material.m_youngModulus = btScalar(3e5);
    material.m_stiffnessDamping = btScalar(0.02);
    material.m_density = 1000;
    fem.setMaterial(body, material);
    return world.addSoft(body);
}

inline btFemChamber cavityOf(const btSoftBody& body)
{
    std::vector<btFemChamber> cavities;
    btFemChamber::find(&body, cavities);
    EXPECT_EQ(cavities.size(), 1u);
    return cavities.at(0);
}

inline btFemCable cableThrough(std::initializer_list<int> nodes)
{
    btFemCable cable;
    for (const int node : nodes) cable.m_points.emplace_back(node);
    return cable;
}

// Node at the corner (0.3 x, 0.3 y, 0); x and y are 0 or 1.
inline int corner(int x, int y)
{
    const std::vector<Vec3> X = hollowCube().restPositions();
    for (std::size_t i = 0; i < X.size(); ++i)
        if (norm(X[i] - Vec3{0.3 * x, 0.3 * y, 0}) < 1e-9) return static_cast<int>(i);
    return -1;
}

}  // namespace bullet_fem
