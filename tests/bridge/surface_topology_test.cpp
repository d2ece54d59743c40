// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include "bullet_bridge/geometry/surface/surface_topology.h"
#include "bullet_fem/fem/mesh/generators.h"

namespace bullet_fem
{
namespace
{

TEST(SurfaceTopology, ClosedSurfaceHasTwoTrianglesAtEveryEdge)
{
    const TetMesh mesh = makeBox({1, 1, 1}, {2, 2, 2});
    const SurfaceTopology topology(mesh.surface(), mesh.nodeCount());
    EXPECT_TRUE(topology.isClosed());
    EXPECT_EQ(topology.vertices(), mesh.surfaceNodes());
    EXPECT_EQ(2 * topology.edgeCount(), 3 * topology.triangleCount());
    for (int edge = 0; edge < topology.edgeCount(); ++edge)
    {
        std::vector<int> visited;
        topology.visitTrianglesOf(edge, [&](int t) { visited.push_back(t); });
        const auto [first, last] = topology.trianglesOf(edge);
        EXPECT_EQ(visited, (std::vector<int>{first, last}));
    }
}

// Three triangles share the edge 0-1; vertex 3 has none.
TEST(SurfaceTopology, EdgesOfOneAndOfThreeTrianglesAreNotManifold)
{
    const SurfaceTopology topology({{0, 1, 2}, {1, 0, 4}, {0, 1, 5}}, 6);
    EXPECT_FALSE(topology.isClosed());
    EXPECT_EQ(topology.vertices(), (std::vector<int>{0, 1, 2, 4, 5}));
    const int shared = topology.edgesOf(0)[0], boundary = topology.edgesOf(1)[1];
    EXPECT_EQ(topology.edges()[shared], (std::array<int, 2>{0, 1}));
    EXPECT_EQ(topology.edges()[boundary], (std::array<int, 2>{0, 4}));
    EXPECT_FALSE(topology.isManifold(shared));
    EXPECT_FALSE(topology.isManifold(boundary));
    EXPECT_EQ(topology.trianglesOf(shared), (std::array<int, 2>{0, 2}));
    EXPECT_EQ(topology.trianglesOf(boundary), (std::array<int, 2>{1, 1}));
    const TriangleRange around = topology.trianglesAt(4), none = topology.trianglesAt(3);
    EXPECT_EQ(std::vector<int>(around.begin(), around.end()), (std::vector<int>{1}));
    EXPECT_EQ(none.begin(), none.end());
}

}  // namespace
}  // namespace bullet_fem
