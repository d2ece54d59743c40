// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>
#include <functional>

#include "bullet_fem/fem/mesh/generators.h"

namespace bullet_fem
{

/// A hollow ball around the origin [m]: the triangles of a sphere of `cells` cells, extruded to `layers` layers of
/// prisms of three elements each.
inline TetMesh hollowSphere(double inner, double outer, int cells, int layers)
{
    const TetMesh ball = makeSphere(1, cells);
    const int count = static_cast<int>(ball.surfaceNodes().size());
    std::vector<int> number(ball.nodeCount(), -1);
    for (int k = 0; k < count; ++k) number[ball.surfaceNodes()[k]] = k;
    std::vector<Vec3> X;
    for (int layer = 0; layer <= layers; ++layer)
        for (const int node : ball.surfaceNodes())
        {
            const Vec3& direction = ball.restPositions()[node];
            X.push_back((inner + (outer - inner) * layer / layers) / norm(direction) * direction);
        }
    std::vector<Tet> tets;
    for (int layer = 0; layer < layers; ++layer)
        for (const Triangle& triangle : ball.surface())
        {
            Triangle t = {number[triangle[0]], number[triangle[1]], number[triangle[2]]};
            std::sort(t.begin(), t.end());  // so that neighbours split their common face equally
            const int a = t[0] + layer * count, b = t[1] + layer * count, c = t[2] + layer * count;
            tets.push_back({a, b, c, c + count});
            tets.push_back({a, b, b + count, c + count});
            tets.push_back({a, a + count, b + count, c + count});
        }
    return TetMesh(X, tets);
}

/// A copy of a mesh without the elements whose centroid is in a hole.
inline TetMesh withHoles(const TetMesh& mesh, const std::function<bool(const Vec3& middle)>& isHole)
{
    const std::vector<Vec3>& X = mesh.restPositions();
    std::vector<int> number(X.size(), -1);
    std::vector<Vec3> kept;
    std::vector<Tet> tets;
    for (Tet tet : mesh.tets())
    {
        if (isHole(0.25 * (X[tet[0]] + X[tet[1]] + X[tet[2]] + X[tet[3]]))) continue;
        for (int& node : tet)
        {
            if (number[node] < 0)
            {
                number[node] = static_cast<int>(kept.size());
                kept.push_back(X[node]);
            }
            node = number[node];
        }
        tets.push_back(tet);
    }
    return TetMesh(kept, tets);
}

}  // namespace bullet_fem
