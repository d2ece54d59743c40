// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "bullet_bridge/geometry/surface/surface_curvature.h"
#include "bullet_fem/fem/mesh/generators.h"

namespace bullet_fem
{
namespace
{

/// Minimum and maximum of curvature times `radius` over the vertices for which `counts` is true.
template <class Counts>
std::pair<double, double> roundnessOf(const TetMesh& mesh, double radius, const Counts& counts)
{
    const SurfaceCurvature curvature({mesh.surface(), mesh.nodeCount()}, mesh.restPositions());
    std::pair<double, double> range(1e9, 0);
    for (const int i : mesh.surfaceNodes())
    {
        if (!counts(mesh.restPositions()[i])) continue;
        range.first = std::min(range.first, radius * curvature.m_largest[i]);
        range.second = std::max(range.second, radius * curvature.m_largest[i]);
    }
    return range;
}

// The rim of a tyre rolls on the radius of its tread, too: by the mean vertex normals there the radius would be less
// than half. A rim's triangles lie on one side of its vertices, which tilts their normals by part of an edge.
TEST(SurfaceCurvature, CylinderRimHasTheCurvatureOfItsMantle)
{
    constexpr double kRadius = 0.4;  // [m]
    for (const int cells : {6, 8, 12})
    {
        const auto isMantle = [](const Vec3& X) { return std::hypot(X.x, X.y) > 0.99 * kRadius; };
        const auto range = roundnessOf(makeCylinder(kRadius, 0.2, cells, 2), kRadius, isMantle);
        EXPECT_GT(range.first, 0.8) << cells;
        EXPECT_LT(range.second, 1.2) << cells;
    }
}

TEST(SurfaceCurvature, BallHasTheCurvatureOfItsRadius)
{
    const auto range = roundnessOf(makeSphere(0.25, 8), 0.25, [](const Vec3&) { return true; });
    EXPECT_GT(range.first, 0.85);
    EXPECT_LT(range.second, 1.3);
}

// A box rolls over its edges, which are creases without curved faces.
TEST(SurfaceCurvature, BoxIsCurvedOnlyAtItsEdges)
{
    const TetMesh box = makeBox({1, 1, 1}, {4, 4, 4});
    const auto outside = [](const Vec3& X)
    {
        int count = 0;
        for (int c = 0; c < 3; ++c) count += X[c] < 0.01 || X[c] > 0.99;
        return count;
    };
    EXPECT_GT(roundnessOf(box, 1, [&](const Vec3& X) { return outside(X) > 1; }).first, 1);
    EXPECT_LT(
        roundnessOf(box, 1, [&](const Vec3& X) { return X.x > 0.4 && X.x < 0.6 && X.y > 0.4 && X.y < 0.6; }).second,
        1e-6);
}

}  // namespace
}  // namespace bullet_fem
