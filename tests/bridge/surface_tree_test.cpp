// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/geometry/surface/surface_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "bridge/random_vectors.h"
#include "bullet_bridge/geometry/surface/soft_surface.h"
#include "bullet_fem/fem/mesh/generators.h"

namespace bullet_fem
{
namespace
{

// A ball with a dented surface at any place, whose nodes have different velocities.
struct MovingBall
{
    MovingBall(Random& random, const Vec3& place)
        : m_mesh(makeSphere(1, 6)),
          m_tree(m_mesh.restPositions(), m_mesh.surface()),
          m_x(m_mesh.restPositions()),
          m_change(m_x.size())
    {
        for (std::size_t i = 0; i < m_x.size(); ++i)
        {
            m_x[i] += place + 0.02 * random.point();
            m_change[i] = Vec3{1, 0, 0} + 0.1 * random.point();
        }
        m_tree.refit(m_x, m_change);
    }

    int count() const { return static_cast<int>(m_mesh.surface().size()); }

    SweptBox exact(int triangle) const
    {
        SweptBox box;
        for (int i : m_mesh.surface()[triangle]) box.add(SweptBox::of(m_x[i], m_change[i]));
        return box;
    }

    TetMesh m_mesh;
    SurfaceTree m_tree;
    std::vector<Vec3> m_x, m_change;
};

TEST(SurfaceTree, FindsTheNearestTriangleAndAllThatABoxMayMeet)
{
    Random random;
    const MovingBall surface(random, {});
    const SurfaceTree& tree = surface.m_tree;
    const int count = surface.count();
    std::size_t met = 0;
    for (int k = 0; k < 100; ++k)
    {
        const Vec3 p = 1.5 * random.point();
        TrianglePoint nearest;
        const int found = tree.nearestTriangle(
            p, 10, [](int t) { return t % 7 == 0; }, nearest);
        ASSERT_GE(found, 0);
        EXPECT_NE(found % 7, 0);
        double least = 10;
        for (int t = 0; t < count; ++t)
            if (t % 7 != 0) least = std::min(least, norm(p - nearestOnTriangle(tree.corners(t), p).m_point));
        EXPECT_EQ(norm(p - nearest.m_point), least);

        const Vec3 way = Vec3{1, 0, 0} + 0.3 * random.point();
        std::vector<int> near;
        tree.visitNear(CoarseBox::of(p, way), 0.1, [&](int t) { near.push_back(t); });
        std::sort(near.begin(), near.end());
        std::vector<int> expected;
        for (int t = 0; t < count; ++t)
            if (surface.exact(t).meets(SweptBox::of(p, way), 0.1)) expected.push_back(t);
        EXPECT_TRUE(std::includes(near.begin(), near.end(), expected.begin(), expected.end()));
        EXPECT_LE(near.size(), 4 * expected.size() + 20) << "and not much more";
        met += expected.size();
    }
    EXPECT_GT(met, 100u);
}

TEST(SurfaceTree, ACommonMotionDoesNotMatter)
{
    const SweptBox a = SweptBox::of({0, 0, 0}, {100, 0, 0}), b = SweptBox::of({50, 0, 0}, {100, 0, 0});
    EXPECT_FALSE(a.meets(b, 1));
    EXPECT_TRUE(a.meets(SweptBox::of({50, 0, 0}, {0, 0, 0}), 1));
}

class PlacedTrees : public testing::TestWithParam<Vec3>
{
};

// Marks every other leaf, and all its ancestors.
std::vector<unsigned char> everyOtherLeaf(const SurfaceTree& tree)
{
    std::vector<unsigned char> has(tree.nodeCount());
    for (int node = tree.nodeCount() - 1; node >= 0; --node)
    {
        if (tree.isLeaf(node))
        {
            has[node] = node % 2;
            continue;
        }
        const auto [left, right] = tree.children(node);
        has[node] = has[left] | has[right];
    }
    return has;
}

TEST_P(PlacedTrees, FindAllMatchingLeavesThatABoxMayMeet)
{
    Random random;
    const MovingBall ball(random, GetParam());
    const SurfaceTree& tree = ball.m_tree;
    const std::vector<unsigned char> has = everyOtherLeaf(tree);
    const Vec3 corner = GetParam() + Vec3{0.8, 0.7, 0.6};
    std::set<int> found;
    tree.visitNearLeaves(CoarseBox::of(corner, {}), 0.3, has.data(),
                         [&](int node) { EXPECT_TRUE(found.insert(node).second); });
    int expected = 0;
    for (int node = 0; node < tree.nodeCount(); ++node)
    {
        if (!tree.isLeaf(node)) continue;
        const SurfaceTree::Leaf leaf = tree.leaf(node);
        bool meets = false;
        for (int k = leaf.m_first; k < leaf.m_end; ++k)
            meets = meets || ball.exact(tree.triangleAt(k)).meets(SweptBox::of(corner, {}), 0.3);
        if (meets && has[node])
        {
            ++expected;
            EXPECT_TRUE(found.count(node));
        }
        EXPECT_TRUE(has[node] || !found.count(node));
    }
    EXPECT_GT(expected, 3);
    EXPECT_LE(found.size(), 3u * expected) << "and not much more";
}

INSTANTIATE_TEST_SUITE_P(Places, PlacedTrees, testing::Values(Vec3{0, 0, 0}, Vec3{1000, -2000, 500}));

// Boxes of some points in exact and in coarse precision.
struct BothBoxes
{
    BothBoxes(Random& random, const Vec3& place)
    {
        const Vec3 middle = random.point();
        for (int k = 0; k < 2; ++k)
        {
            const Vec3 x = place + middle + 0.3 * random.point(), change = Vec3{1, 2, 3} + 0.3 * random.point();
            m_exact.add(SweptBox::of(x, change));
            m_coarse.add(CoarseBox::of(x, change));
        }
    }
    SweptBox m_exact;
    CoarseBox m_coarse = CoarseBox::empty();
};

// Within twice the coordinates' rounding the answers may differ, in one direction.
TEST_P(PlacedTrees, CoarseBoxesRejectOnlyPairsExactOnesReject)
{
    Random random;
    int no = 0, yes = 0, differ = 0;
    for (int k = 0; k < 20000; ++k)
    {
        const BothBoxes a(random, GetParam()), b(random, GetParam());
        // Reaches just beyond the distance of the boxes.
        double apart = 0, apartAtStart = 0;
        for (int c = 0; c < 3; ++c)
        {
            const VectorBounds &x = a.m_exact.m_start, &y = b.m_exact.m_start;
            const VectorBounds &dx = a.m_exact.m_change, &dy = b.m_exact.m_change;
            const double above = x.m_low[c] - y.m_high[c], below = y.m_low[c] - x.m_high[c];
            apartAtStart = std::max({apartAtStart, above, below});
            apart = std::max({apart, above + std::min(0.0, dx.m_low[c] - dy.m_high[c]),
                              below + std::min(0.0, dy.m_low[c] - dx.m_high[c])});
        }
        EXPECT_TRUE(a.m_coarse.startsWithin(b.m_coarse, coarse(apartAtStart)));
        EXPECT_TRUE(a.m_coarse.meets(b.m_coarse, coarse(apart)));
        const bool exact = a.m_exact.meets(b.m_exact, 0.1), quick = a.m_coarse.meets(b.m_coarse, coarse(0.1));
        ++(exact ? yes : no);
        differ += exact != quick;
        EXPECT_TRUE(quick || !exact);
    }
    EXPECT_GT(yes, 1000);
    EXPECT_GT(no, 1000);
    EXPECT_LT(differ, 100);
}

TEST(CoarseBox, EmptyBoxMeetsNoBox)
{
    const CoarseBox point = CoarseBox::of({1, 2, 3}, {4, 5, 6});
    EXPECT_FALSE(CoarseBox::empty().meets(point, 1e6f));
    EXPECT_FALSE(point.meets(CoarseBox::empty(), 1e6f));
    EXPECT_FALSE(CoarseBox::empty().meets(CoarseBox::empty(), 1e6f));
    EXPECT_FALSE(point.startsWithin(CoarseBox::empty(), 1e6f));
    EXPECT_TRUE(point.meets(point, 0));
}

std::vector<SurfaceRidges::Ridge> ridgesOf(const SoftSurface& surface)
{
    std::vector<SurfaceRidges::Ridge> all;
    const SurfaceTree& tree = surface.tree();
    for (int node = 0; node < tree.nodeCount(); ++node)
        if (tree.isLeaf(node))
            all.insert(all.end(), surface.ridges().begin(tree.leaf(node)), surface.ridges().end(tree.leaf(node)));
    return all;
}

// The list has the twelve edges of a cube, and none of its flat diagonals.
TEST(SurfaceRidges, AreListedOnceEach)
{
    const TetMesh mesh = makeBox({1, 1, 1}, {1, 1, 1});
    SoftSurface surface(boundaryOf(mesh));
    std::vector<Vec3> v(mesh.restPositions().size(), Vec3{6, 0, 0});
    surface.place(mesh.restPositions(), v, 1.0 / 60);
    surface.prepareAll();
    std::set<int> edges;
    for (const SurfaceRidges::Ridge& ridge : ridgesOf(surface))
    {
        const auto [a, b] = surface.topology().edges()[ridge.m_edge];
        EXPECT_NEAR(norm(mesh.restPositions()[b] - mesh.restPositions()[a]), 1, 1e-12);
        EXPECT_TRUE(edges.insert(ridge.m_edge).second);
        // It moves 0.2 m in two steps.
        const Vec3 later = mesh.restPositions()[a] + Vec3{0.199, 0, 0};
        const CoarseBox box = SurfaceRidges::boxOf(ridge, surface.tree());
        EXPECT_TRUE(box.meets(CoarseBox::of(later, {}), 0));
        EXPECT_FALSE(box.meets(CoarseBox::of(mesh.restPositions()[a] + Vec3{1.21, 0, 0}, {}), 0));
    }
    EXPECT_EQ(edges.size(), 12u);
}

// A ball with randomly displaced vertices, and a box beside it.
TEST(SoftSurface, PreparedNearABoxSaysTheSameAsPreparedEverywhere)
{
    const TetMesh mesh = makeSphere(1, 6);
    SoftSurface whole(boundaryOf(mesh)), part = whole;
    Random random;
    std::vector<Vec3> x = mesh.restPositions(), v(x.size());
    const std::vector<SurfaceTree::Nearby> boxes = {{CoarseBox::of({1.1, 0.3, 0}, {-0.1, 0, 0}), 0.2}};
    std::size_t listed = 0;
    for (int step = 0; step < 3; ++step)
    {
        for (std::size_t i = 0; i < x.size(); ++i)
        {
            x[i] += 0.02 * random.point();
            v[i] = 0.5 * random.point();
        }
        whole.place(x, v, 0.01);
        whole.prepareAll();
        part.place(x, v, 0.01);
        part.prepareNear(boxes);
        for (int t = 0; t < static_cast<int>(mesh.surface().size()); ++t)
            EXPECT_EQ(norm(whole.faceNormal(t) - part.faceNormal(t)), 0);
        for (int k = 0; k < whole.topology().edgeCount(); ++k) EXPECT_EQ(whole.bend(k), part.bend(k));
        const auto near = [&](const SoftSurface& surface)
        {
            std::vector<int> edges;
            const auto visit = [&](int leaf)
            {
                const SurfaceTree::Leaf places = surface.tree().leaf(leaf);
                for (const auto* at = surface.ridges().begin(places); at != surface.ridges().end(places); ++at)
                    edges.push_back(at->m_edge);
            };
            surface.tree().visitNearLeaves(boxes[0].m_box, boxes[0].m_reach, surface.ridges().has(), visit);
            return edges;
        };
        EXPECT_EQ(near(whole), near(part));
        listed = near(part).size();
        EXPECT_GT(listed, 10u);
        EXPECT_LT(ridgesOf(part).size(), ridgesOf(whole).size() / 2) << "those near alone";
    }
    part.prepareAll();
    EXPECT_EQ(ridgesOf(part).size(), ridgesOf(whole).size());
}

// For any initial guess.
TEST(SurfaceTree, FindsTheSameNearestTriangleForAnyGuess)
{
    const TetMesh mesh = makeSphere(1, 5);
    const std::vector<Triangle> triangles = mesh.surface();
    const SurfaceTree tree(mesh.restPositions(), triangles);
    const auto none = [](int) { return false; };
    Random random;
    for (int k = 0; k < 200; ++k)
    {
        // Every other query point is at a corner, where several triangles are equally near.
        const Vec3 p = k % 2 == 0 ? 2 * random.point() : mesh.restPositions()[triangles[k % triangles.size()][0]];
        TrianglePoint alone, guessed;
        const int found = tree.nearestTriangle(p, HUGE_VAL, none, alone);
        for (std::size_t guess = k % 7; guess < triangles.size(); guess += 7)
        {
            EXPECT_EQ(tree.nearestTriangle(p, HUGE_VAL, none, guessed, static_cast<int>(guess)), found);
            EXPECT_EQ(norm(alone.m_point - guessed.m_point), 0);
        }
        TrianglePoint best;
        EXPECT_EQ(tree.nearestTriangle(p, HUGE_VAL, none, best, found), found);
    }
}

}  // namespace
}  // namespace bullet_fem
