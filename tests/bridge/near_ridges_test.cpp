// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/geometry/surface/near_ridges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "bridge/random_vectors.h"
#include "bullet_fem/fem/mesh/generators.h"

namespace bullet_fem
{
namespace
{

constexpr double kNear = 0.2, kBand = 0.02;  // [m]

struct TestEdge
{
    std::array<Vec3, 2> m_x, m_change;

    TestEdge(Random& random, const Vec3& place)
    {
        const Vec3 middle = place + 0.5 * random.point(), way = 0.3 * random.point();
        for (int k = 0; k < 2; ++k)
        {
            m_x[k] = middle + 0.5 * random.point();
            m_change[k] = way + 0.05 * random.point();
        }
    }

    CoarseBox box() const
    {
        CoarseBox box = CoarseBox::of(m_x[0], m_change[0]);
        box.add(CoarseBox::of(m_x[1], m_change[1]));
        box.last(SurfaceRidges::kSteps);
        return box;
    }

    Vec3 at(double s, double time) const
    {
        return (1 - s) * (m_x[0] + time * m_change[0]) + s * (m_x[1] + time * m_change[1]);
    }
};

class PlacedRidges : public testing::TestWithParam<Vec3>
{
};

// The exact test in double precision: the lines cross between their end points at a small distance.
bool crossNearby(const TestEdge& a, const TestEdge& b)
{
    LineParameters at;
    if (!nearestOfLines({a.m_x[0], a.m_x[1], b.m_x[0], b.m_x[1]}, 0.05, at)) return false;
    const bool interior = std::min(at.m_a, at.m_b) > 0 && std::max(at.m_a, at.m_b) < 1;
    return interior && norm(a.at(at.m_a, 0) - b.at(at.m_b, 0)) < kNear;
}

TEST_P(PlacedRidges, BatchCullingKeepsCrossingAndMeetingEdges)
{
    Random random;
    int crossings = 0, kept = 0, count = 0;
    for (int k = 0; k < 5000; ++k)
    {
        const TestEdge a(random, GetParam());
        const std::array<TestEdge, 4> b = {TestEdge(random, GetParam()), TestEdge(random, GetParam()),
                                           TestEdge(random, GetParam()), TestEdge(random, GetParam())};
        RidgeLanes one = RidgeLanes::empty(), four = RidgeLanes::empty();
        one.set(2, a.box(), a.m_x[0] - GetParam(), a.m_x[1] - a.m_x[0]);
        for (int lane = 0; lane < 4; ++lane)
            four.set(lane, b[lane].box(), b[lane].m_x[0] - GetParam(), b[lane].m_x[1] - b[lane].m_x[0]);
        const RidgesMay may = ridgesMay(one.spread(2), four, {coarse(kNear), coarse(kBand), 1e-6f});
        for (int lane = 0; lane < 4; ++lane)
        {
            const bool crosses = crossNearby(a, b[lane]);
            EXPECT_TRUE(may.m_cross[lane] || !crosses);
            EXPECT_EQ(may.m_meet[lane] != 0, a.box().meets(b[lane].box(), coarse(kBand)));
            ++count;
            crossings += crosses;
            kept += may.m_cross[lane] != 0;
        }
    }
    EXPECT_GT(crossings, 100);
    EXPECT_LT(kept, 3 * crossings) << "and not much more";
    EXPECT_LT(kept, count / 5);
}

INSTANTIATE_TEST_SUITE_P(Places, PlacedRidges, testing::Values(Vec3{0, 0, 0}, Vec3{1000, -2000, 500}));

TEST(RidgeLanes, UnusedOnesMeetNothing)
{
    Random random;
    const TestEdge a(random, {});
    RidgeLanes one = RidgeLanes::empty();
    one.set(0, a.box(), a.m_x[0], a.m_x[1] - a.m_x[0]);
    const RidgesMay may = ridgesMay(one.spread(0), one, {10, 10, 0});
    EXPECT_TRUE(may.m_meet[0]);
    for (int lane = 1; lane < 4; ++lane) EXPECT_FALSE(may.m_meet[lane] || may.m_cross[lane]);
}

struct TestSurface
{
    TestSurface(Random& random, const Vec3& place, const Vec3& way)
        : m_mesh(makeSphere(1, 6)), m_surface(boundaryOf(m_mesh))
    {
        std::vector<Vec3> x = m_mesh.restPositions(), v(x.size());
        for (std::size_t i = 0; i < x.size(); ++i)
        {
            x[i] += place + 0.02 * random.point();
            v[i] = way + 0.02 * random.point();
        }
        m_surface.place(x, v, 1);
        m_surface.prepareAll();
    }

    // Points along a ridge at several times within two steps.
    std::vector<Vec3> trace(int edge, double time) const
    {
        const auto [a, b] = m_surface.topology().edges()[edge];
        const std::vector<Vec3>&x = m_surface.position(), &change = m_surface.change();
        std::vector<Vec3> points;
        for (double s : {0.0, 0.25, 0.5, 0.75, 1.0})
            points.push_back((1 - s) * (x[a] + time * change[a]) + s * (x[b] + time * change[b]));
        return points;
    }

    TetMesh m_mesh;
    SoftSurface m_surface;
};

std::set<int> listed(const SoftSurface& surface, const SoftSurface& other)
{
    const Vec3 toSurface = unit(middleOf(surface) - middleOf(other));
    const BeyondPlane plane(other, toSurface, SurfaceRidges::kSteps);
    NearRidges ridges;
    ridges.list(surface, {other.tree().coarseBounds(), plane, kNear, kBand}, middleOf(surface));
    std::set<int> edges;
    for (const NearRidges::Run& run : ridges.runs())
        for (int k = run.m_first; k < run.m_end; ++k) EXPECT_TRUE(edges.insert(ridges[k].m_ridge.m_edge).second);
    return edges;
}

double minDistance(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    double least = 1e9;
    for (const Vec3& p : a)
        for (const Vec3& q : b) least = std::min(least, norm(p - q));
    return least;
}

// Two balls approach each other along an oblique direction.
TEST(NearRidges, IncludesAllPossibleContactsAndFewMore)
{
    Random random;
    const Vec3 toB = unit({1, 0.8, 1.2});
    const TestSurface a(random, {}, {}), b(random, 2.15 * toB, -0.05 * toB);
    const std::set<int> ofA = listed(a.m_surface, b.m_surface), ofB = listed(b.m_surface, a.m_surface);
    const int edges = a.m_surface.topology().edgeCount();
    int touching = 0;
    for (int m = 0; m < edges; ++m)
        for (int n = 0; n < edges; ++n)
        {
            if (!(a.m_surface.bend(m) < -0.03 && b.m_surface.bend(n) < -0.03)) continue;
            if (minDistance(a.trace(m, 0), b.trace(n, 0)) > kNear && minDistance(a.trace(m, 1), b.trace(n, 1)) > kBand)
                continue;
            ++touching;
            EXPECT_TRUE(ofA.count(m) && ofB.count(n));
        }
    EXPECT_GT(touching, 10);
    EXPECT_LT(static_cast<int>(ofA.size() + ofB.size()), edges / 2);
}

TEST(BeyondPlane, ExcludesLeavesThatStayBeyondWithinTheSteps)
{
    Random random;
    const TestSurface ball(random, {}, {});
    const BeyondPlane plane(ball.m_surface, {1, 0, 0}, 2);
    const double front = 2 - plane.distance({2, 0, 0});
    EXPECT_NEAR(front, 1, 0.05);
    const auto isBeyond = [&](double distance, double speed)
    {
        const Vec3 x = {front + distance, 0.3, 5}, far = x + Vec3{1, 0, 0};
        return plane.isBeyond(x, {speed, 0, 0}, far, {}, kNear, kBand);
    };
    EXPECT_TRUE(isBeyond(0.21, 0));
    EXPECT_FALSE(isBeyond(0.19, 0)) << "near at the start";
    EXPECT_TRUE(isBeyond(0.6, -0.2));
    EXPECT_FALSE(isBeyond(0.6, -0.3)) << "there within two steps";
}

}  // namespace
}  // namespace bullet_fem
