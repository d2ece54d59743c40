// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/mesh/generators.h"
#include "bullet_fem/io/body_frame.h"

namespace bullet_fem
{

/// A box of 2 x 2 x 2 cells with all fields, stretched along x and lifted by `lift` [m].
inline BodyFrame sampleBox(int id, double lift = 0)
{
    const TetMesh mesh = makeBox({1, 1, 1}, {2, 2, 2}, {2.0 * id, 0, 0});
    BodyFrame body;
    body.m_id = id;
    body.m_tets = mesh.tets();
    body.m_triangles = mesh.surface();
    for (const Vec3& X : mesh.restPositions())
    {
        const Vec3 u = {0.25 * lift * X.x, 0, lift};
        body.m_positions.push_back(X + u);
        body.m_displacement.push_back(u);
        body.m_velocity.push_back({0, 0, 2 * lift});
        body.m_contactForce.push_back({0, 0, X.z == 0 ? 4.0 : 0.0});
        body.m_reactionForce.push_back({X.z == 0 ? 7.0 : 0.0, 0, 0});
        Stress stress;
        stress.xx = 1000 * (1 + lift) * X.x;
        stress.xy = 10;
        body.m_nodeStress.push_back(stress);
    }
    for (std::size_t e = 0; e < body.m_tets.size(); ++e)
    {
        const double s = static_cast<double>(e);
        body.m_tetStress.push_back({s, s + 1, s + 2, s + 3, s + 4, s + 5});
        body.m_tetPlasticStrain.push_back(0.01 * s);
        body.m_tetActivation.push_back(-100 * s);
    }
    return body;
}

/// A triangle with positions only.
inline BodyFrame sampleTriangle(int id)
{
    BodyFrame body;
    body.m_id = id;
    body.m_positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
    body.m_triangles = {{0, 1, 2}};
    return body;
}

}  // namespace bullet_fem
