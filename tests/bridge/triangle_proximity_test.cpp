// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/geometry/surface/triangle_proximity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "bridge/random_vectors.h"

namespace bullet_fem
{
namespace
{

// No point of a fine grid on the triangle is nearer, and the point agrees with its barycentrics.
TEST(TriangleProximity, TheNearestPointIsNearerThanAllOthers)
{
    Random random;
    for (int k = 0; k < 500; ++k)
    {
        const Corners t = {random.point(), random.point(), random.point()};
        const Vec3 p = 2 * random.point();
        const TrianglePoint nearest = nearestOnTriangle(t, p);
        const auto& w = nearest.m_weights;
        EXPECT_GE(std::min({w[0], w[1], w[2]}), 0);
        EXPECT_LT(norm(w[0] * t[0] + w[1] * t[1] + w[2] * t[2] - nearest.m_point), 1e-14);
        EXPECT_EQ((w[0] == 0) + (w[1] == 0) + (w[2] == 0), static_cast<int>(nearest.m_feature));
        for (int i = 0; i <= 20; ++i)
            for (int j = 0; i + j <= 20; ++j)
            {
                const Vec3 other = (1.0 / 20) * (double(i) * t[0] + double(j) * t[1] + double(20 - i - j) * t[2]);
                EXPECT_LE(norm(p - nearest.m_point), norm(p - other) + 1e-14);
            }
    }
}

TEST(TriangleProximity, KnowsTheFeature)
{
    const Corners t = {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}};
    EXPECT_EQ(nearestOnTriangle(t, {0.2, 0.2, 1}).m_feature, TriangleFeature::face);
    const TrianglePoint edge = nearestOnTriangle(t, {1, 1, 1});
    EXPECT_EQ(edge.m_feature, TriangleFeature::edge);
    EXPECT_EQ(edge.m_number, 1);
    const TrianglePoint corner = nearestOnTriangle(t, {-1, 3, 1});
    EXPECT_EQ(corner.m_feature, TriangleFeature::corner);
    EXPECT_EQ(corner.m_number, 2);
}

TEST(TriangleProximity, LinesAndPointsAreTrianglesToo)
{
    const Corners line = {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{2, 0, 0}},
                  point = {Vec3{1, 1, 1}, Vec3{1, 1, 1}, Vec3{1, 1, 1}};
    EXPECT_LT(norm(nearestOnTriangle(line, {1.5, 1, 0}).m_point - Vec3{1.5, 0, 0}), 1e-15);
    EXPECT_LT(norm(nearestOnTriangle(point, {5, 1, 0}).m_point - Vec3{1, 1, 1}), 1e-15);
    std::array<double, 3> w;
    EXPECT_FALSE(projectOnPlane(line, {1, 1, 1}, w));
    EXPECT_FALSE(projectOnPlane(point, {1, 1, 1}, w));
}

TEST(TriangleProximity, NearestPointsOfLinesAreJoinedByTheCommonPerpendicular)
{
    Random random;
    for (int k = 0; k < 200; ++k)
    {
        const std::array<Vec3, 4> ends = {random.point(), random.point(), random.point(), random.point()};
        LineParameters at;
        ASSERT_TRUE(nearestOfLines(ends, 1e-6, at));
        const Vec3 a = ends[1] - ends[0], b = ends[3] - ends[2];
        const Vec3 d = ends[0] + at.m_a * a - ends[2] - at.m_b * b;
        const double tolerance = 1e-13 / std::pow(norm(cross(a, b)), 2);
        EXPECT_NEAR(dot(d, a), 0, tolerance);
        EXPECT_NEAR(dot(d, b), 0, tolerance);
    }
    LineParameters at;
    EXPECT_FALSE(nearestOfLines({Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{3, 1, 0}}, 1e-6, at));
    EXPECT_FALSE(nearestOfLines({Vec3{0, 0, 0}, Vec3{0, 0, 0}, Vec3{0, 1, 0}, Vec3{3, 1, 0}}, 1e-6, at));
}

// A determinant with the rows (f(t), 0, 0), (0, g(t), 0), (0, 0, k(t)) has the roots of its three factors.
TEST(TriangleProximity, FindsAllTimesInOnePlane)
{
    Random random;
    for (int k = 0; k < 500; ++k)
    {
        std::array<double, 3> roots = {random.number(), random.number(), random.number()};
        std::array<MovingVector, 3> vectors;
        for (int c = 0; c < 3; ++c)
        {
            vectors[c].m_at[c] = -roots[c];
            vectors[c].m_change[c] = 1;
        }
        std::sort(roots.begin(), roots.end());
        std::array<double, 3> times;
        const int count = timesInOnePlane(vectors, 0.5, times);
        std::vector<double> expected;
        for (double root : roots)
            if (root > 0 && root <= 0.5) expected.push_back(root);
        ASSERT_EQ(count, static_cast<int>(expected.size()));
        for (int c = 0; c < count; ++c) EXPECT_NEAR(times[c], expected[c], 1e-6) << "close roots lose half the digits";
    }
}

TEST(TriangleProximity, FallingPointMeetsTheTrianglePlaneInTime)
{
    const std::array<MovingVector, 3> vectors = {MovingVector{{0.2, 0.2, 3}, {0, 0, -10}}, MovingVector{{1, 0, 0}, {}},
                                                 MovingVector{{0, 1, 0}, {}}};
    std::array<double, 3> times;
    ASSERT_EQ(timesInOnePlane(vectors, 1, times), 1);
    EXPECT_NEAR(times[0], 0.3, 1e-15);
    EXPECT_EQ(timesInOnePlane(vectors, 0.29, times), 0);
}

}  // namespace
}  // namespace bullet_fem
