// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/mesh/tet_mesh.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "bullet_fem/fem/mesh/generators.h"
#include "fem/scenes/expect_rejected.h"

namespace bullet_fem
{
namespace
{

const std::vector<Vec3> kCorner = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}};  // one tet of volume 1

/// Volume enclosed by the mesh's surface, by the divergence theorem: equals volume() only if it is closed and outward.
double volumeOfSurface(const TetMesh& mesh)
{
    const std::vector<Vec3>& X = mesh.restPositions();
    double sum = 0;
    for (const Triangle& t : mesh.surface()) sum += dot(X[t[0]], cross(X[t[1]], X[t[2]])) / 6;
    return sum;
}

TEST(TetMesh, MeasuresOneElement)
{
    const TetMesh mesh(kCorner, {{0, 1, 2, 3}});
    EXPECT_EQ(mesh.nodeCount(), 4);
    EXPECT_EQ(mesh.tetCount(), 1);
    EXPECT_EQ(mesh.turnedCount(), 0);
    EXPECT_EQ(mesh.componentCount(), 1);
    EXPECT_DOUBLE_EQ(mesh.tetVolume(0), 1);
    EXPECT_DOUBLE_EQ(mesh.volume(), 1);
    EXPECT_NEAR(mesh.shortestHeight(), 6. / 7, 1e-14);  // of the corner over the plane x + y / 2 + z / 3 = 1
    EXPECT_EQ(mesh.surface().size(), 4u);
    EXPECT_EQ(mesh.surfaceNodes(), (std::vector<int>{0, 1, 2, 3}));
    EXPECT_NEAR(volumeOfSurface(mesh), 1, 1e-14);
    const double edges = 1 + 2 + 3 + std::sqrt(5.0) + std::sqrt(10.0) + std::sqrt(13.0);
    EXPECT_NEAR(mesh.meanEdgeLength(), edges / 6, 1e-14);
}

TEST(TetMesh, TurnsNegativeElementsAndCountsThem)
{
    const TetMesh mesh(kCorner, {{0, 1, 3, 2}});
    EXPECT_EQ(mesh.turnedCount(), 1);
    EXPECT_EQ(mesh.tets()[0], (Tet{0, 1, 2, 3}));
    EXPECT_DOUBLE_EQ(mesh.tetVolume(0), 1);
    EXPECT_NEAR(volumeOfSurface(mesh), 1, 1e-14);
}

TEST(TetMesh, SurfaceHasNoInnerFaceAndPointsOutward)
{
    const TetMesh mesh = makeBox({2, 3, 4}, {2, 3, 4}, {10, -20, 30});
    EXPECT_EQ(mesh.surface().size(), 2u * 2 * (2 * 3 + 3 * 4 + 2 * 4));
    EXPECT_EQ(mesh.surfaceNodes().size(), 3u * 4 * 5 - 1 * 2 * 3);
    EXPECT_NEAR(volumeOfSurface(mesh), 24, 24 * 1e-11);  // cancellation at 30 m from the origin
    std::set<int> nodes;
    for (const Triangle& triangle : mesh.surface()) nodes.insert(triangle.begin(), triangle.end());
    EXPECT_EQ(std::vector<int>(nodes.begin(), nodes.end()), mesh.surfaceNodes());
}

TEST(TetMesh, LabelsComponentsByTheirLowestNode)
{
    std::vector<Vec3> X;
    for (int i = 0; i < 8; ++i) X.push_back(kCorner[i / 2] + Vec3{i % 2 * 10.0, 0, 0});  // even nodes here, odd there
    const TetMesh mesh(X, {{1, 3, 5, 7}, {0, 2, 4, 6}});
    EXPECT_EQ(mesh.componentCount(), 2);
    EXPECT_EQ(mesh.nodeComponent(), (std::vector<int>{0, 1, 0, 1, 0, 1, 0, 1}));
}

TEST(TetMesh, ElementsThatShareOneNodeAreOneComponent)
{
    std::vector<Vec3> X = kCorner;
    X.insert(X.end(), {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}});
    const TetMesh mesh(X, {{0, 1, 2, 3}, {0, 4, 6, 5}});
    EXPECT_EQ(mesh.componentCount(), 1);
    EXPECT_EQ(mesh.surface().size(), 8u);
}

TEST(TetMesh, QualityDoesNotDependOnTheUnitOfLength)
{
    for (const double scale : {1e-120, 1e-6, 1e6, 1e120})
    {
        std::vector<Vec3> X = kCorner;
        for (Vec3& x : X) x *= scale;
        EXPECT_NO_THROW(TetMesh(X, {{0, 1, 2, 3}})) << scale;
    }
}

TEST(TetMesh, IsTheSameWithKnownBoundarySides)
{
    std::vector<Vec3> X = makeBox({1, 2, 3}, {3, 2, 4}).restPositions();
    std::vector<Tet> tets = makeBox({1, 2, 3}, {3, 2, 4}).tets();
    X.push_back({9, 9, 9});  // an unused node
    tets.erase(tets.begin() + 7);
    const TetMesh mesh(X, tets, LooseNodes::kept);
    const TetMesh again = TetMesh::withSides(X, tets, mesh.boundarySides());
    EXPECT_EQ(again.surface(), mesh.surface());
    EXPECT_EQ(again.surfaceNodes(), mesh.surfaceNodes());
    EXPECT_EQ(again.nodeComponent(), mesh.nodeComponent());
    EXPECT_EQ(again.componentCount(), mesh.componentCount());
    EXPECT_EQ(again.looseCount(), 1);
    EXPECT_EQ(again.volume(), mesh.volume());
    EXPECT_EQ(again.meanEdgeLength(), mesh.meanEdgeLength());
    EXPECT_EQ(again.boundarySides(), mesh.boundarySides());
    EXPECT_EQ(TetMesh(kCorner, {{0, 1, 2, 3}}).boundarySides(), (std::vector<unsigned char>{15}));
}

TEST(TetMeshInput, RejectsInconsistentSides)
{
    expectRejected([] { TetMesh::withSides(kCorner, {{0, 1, 2, 3}}, {16}); }, {"element 0", "16", "[0, 15]"});
    expectRejected([] { TetMesh::withSides(kCorner, {{0, 1, 2, 3}}, {}); }, {"0 of 1 elements"});
    expectRejected([] { TetMesh::withSides(kCorner, {{0, 1, 3, 2}}, {15}); }, {"negative orientation"});
    expectRejected([] { TetMesh::withSides(kCorner, {{0, 1, 2, 4}}, {15}); }, {"node 4"});
}

TEST(TetMeshInput, RejectsAMeshWithoutElements)
{
    expectRejected([] { TetMesh(kCorner, {}); }, {"0 elements", "at least 1"});
}

TEST(TetMeshInput, RejectsIndicesOutOfRange)
{
    expectRejected([] { TetMesh(kCorner, {{0, 1, 2, 3}, {0, 1, 2, 4}}); }, {"element 1", "node 4", "[0, 3]"});
    expectRejected([] { TetMesh(kCorner, {{0, -7, 2, 3}}); }, {"element 0", "node -7", "[0, 3]"});
    expectRejected([] { TetMesh({}, {{0, 1, 2, 3}}); }, {"element 0", "node 0"});
}

TEST(TetMeshInput, RejectsARepeatedNodeInAnElement)
{
    expectRejected([] { TetMesh(kCorner, {{0, 1, 2, 3}, {0, 3, 2, 3}}); }, {"element 1", "node 3 twice"});
}

TEST(TetMeshInput, RejectsDegenerateElements)
{
    const auto withHeight = [](double z) { return std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, 0.5, z}}; };
    // Longest edge sqrt 2, volume z / 6: the bound 1e-9 is met at z = 1.697e-8.
    EXPECT_NO_THROW(TetMesh(withHeight(1.71e-8), {{0, 1, 2, 3}}));
    expectRejected(
        [&] {
            TetMesh(withHeight(1.69e-8), {{0, 1, 2, 3}});
        },
        {"element 0", "(nodes 0, 1, 2, 3)", "degenerate", "9.9", "1e-09", "remove it"});
    expectRejected([&] { TetMesh(withHeight(0), {{0, 1, 2, 3}}); }, {"element 0", "degenerate"});
    expectRejected([] { TetMesh({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {{0, 1, 2, 3}}); }, {"degenerate"});
}

TEST(TetMeshInput, RejectsNonFinitePositions)
{
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    {
        std::vector<Vec3> X = kCorner;
        X[2].y = bad;
        expectRejected([&] { TetMesh(X, {{0, 1, 2, 3}}); }, {"node 2", "not finite"});
    }
}

TEST(TetMeshInput, RejectsOverflowingExtents)
{
    std::vector<Vec3> X = kCorner;
    X[0].x = -1.7e308;
    X[1].x = 1.7e308;
    expectRejected([&] { TetMesh(X, {{0, 1, 2, 3}}); }, {"element 0", "degenerate"});
}

TEST(TetMeshInput, RejectsUnusedNodes)
{
    std::vector<Vec3> X = kCorner;
    X.insert(X.begin() + 1, {5, 5, 5});
    expectRejected([&] { TetMesh(X, {{0, 2, 3, 4}}); }, {"node 1 of 5", "no element", "remove"});
    const TetMesh mesh(X, {{0, 2, 3, 4}}, LooseNodes::kept);
    EXPECT_EQ(mesh.looseCount(), 1);
    EXPECT_EQ(mesh.componentCount(), 2);
    for (int i = 0; i < 5; ++i) EXPECT_EQ(mesh.isLoose(i), i == 1) << i;
}

TEST(TetMeshInput, RejectsFacesOfMoreThanTwoElements)
{
    std::vector<Vec3> X = kCorner;
    X.insert(X.end(), {{0, 0, -1}, {0.1, 0.1, 4}});
    expectRejected(
        [&] {
            TetMesh(X, {{0, 1, 2, 3}, {0, 2, 1, 4}, {0, 1, 2, 5}});
        },
        {"face (0, 1, 2)", "3 elements", "0, 1, 2", "at most 2"});
}

// A duplicate element, alone in its component, shares each face only with its copy.
TEST(TetMeshInput, RejectsDuplicateElements)
{
    expectRejected(
        [] {
            TetMesh(kCorner, {{0, 1, 2, 3}, {2, 1, 0, 3}});
        },
        {"1 of 2 elements repeat another one (none is there only once)", "element 1 (nodes 2, 1, ", "of element 0",
         "list each element once"});
    std::vector<Vec3> X = kCorner;
    for (const Vec3& x : kCorner) X.push_back(x + Vec3{9, 0, 0});
    expectRejected(
        [&] {
            TetMesh(X, {{0, 1, 2, 3}, {4, 5, 6, 7}, {7, 6, 5, 4}});
        },
        {"1 of 3 elements repeat another one: element 2", "of element 1"});
}

TEST(TetMeshInput, RejectsMeshesOfDuplicatesOnly)
{
    const TetMesh box = makeBox({1, 1, 1}, {2, 2, 2});
    std::vector<Tet> tets = box.tets();
    for (const Tet& t : box.tets()) tets.push_back({t[1], t[2], t[0], t[3]});
    const std::string half = std::to_string(box.tetCount()), all = std::to_string(2 * box.tetCount());
    expectRejected([&] { TetMesh(box.restPositions(), tets); },
                   {(half + " of " + all + " elements repeat another one (none is there only once)").c_str(),
                    ("element " + half + " ").c_str(), "of element 0;"});
}

}  // namespace
}  // namespace bullet_fem
