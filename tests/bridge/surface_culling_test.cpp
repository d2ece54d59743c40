// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/rigid/surface_culling.h"

#include <gtest/gtest.h>

#include "bridge/bridge_test_shapes.h"

namespace bullet_fem
{
namespace
{

constexpr double kReach = 0.1;       // [m]
constexpr double kAnywhere = 1e30;   // [m]
constexpr double kGradients = 2e-5;  // error of the gradients of round hulls

/// A random triangle near a solid, or an edge (a triangle whose last corner equals the first).
class SurfaceCullingTest : public ::testing::TestWithParam<NamedShape>
{
protected:
    SurfaceCullingTest() : m_surface(RestSurface{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, 1, 1, {}}) {}

    void next(int k)
    {
        const auto corners = m_random.triangle(1, 0.4);
        m_x.assign(corners.begin(), corners.end());
        m_nodes = k % 2 ? Triangle{0, 1, 2} : Triangle{0, 1, 0};
        m_culling.begin(m_surface, m_x);
        m_inBounds = m_culling.meets({m_leaf.m_boundsMin, m_leaf.m_boundsMax, kReach});
        for (int i = 0; i < 3; ++i)
        {
            m_culling.noteVertex(i, m_x[i], m_x[i]);
            SurfaceDistance d;
            ASSERT_TRUE(pointShapeDistance(m_leaf, m_x[i], kAnywhere, d));
            m_culling.noteGap(i, d.m_gap, d.m_normal);
        }
        ASSERT_TRUE(
            triangleShapeDistance(m_leaf, {m_x[m_nodes[0]], m_x[m_nodes[1]], m_x[m_nodes[2]]}, kAnywhere, m_nearest));
    }

    SoftSurface m_surface;
    RandomPoints m_random;
    ShapePtr m_shape = GetParam().m_make();
    ShapeLeaf m_leaf = leafOf(*m_shape, m_random.placement(0.3));
    SurfaceCulling m_culling;
    std::vector<Vec3> m_x;
    Triangle m_nodes;
    bool m_inBounds = false;
    SurfaceDistance m_nearest;
};

TEST_P(SurfaceCullingTest, NothingWithinReachIsRuledOut)
{
    int near = 0, ruledOut = 0;
    for (int k = 0; k < 2000; ++k)
    {
        next(k);
        const bool isNear = m_nearest.m_gap < kReach;
        const bool outside = !m_inBounds || m_culling.isOutside(m_nodes);
        near += isNear;
        ruledOut += outside || m_culling.minGap(m_nodes) > kReach;
        EXPECT_FALSE(isNear && outside);
    }
    EXPECT_GT(near, 200);
    EXPECT_GT(ruledOut, 0.8 * (2000 - near));
}

TEST_P(SurfaceCullingTest, NoPointIsNearerThanTheLeastGap)
{
    for (int k = 0; k < 2000; ++k)
    {
        next(k);
        EXPECT_LE(m_culling.minGap(m_nodes), m_nearest.m_gap + kGradients);
    }
}

TEST_P(SurfaceCullingTest, TestsTheWholePathOfANode)
{
    next(1);
    const Vec3 middle = 0.5 * (m_leaf.m_boundsMin + m_leaf.m_boundsMax), away = {10, 0, 0};
    for (int i = 0; i < 3; ++i) EXPECT_FALSE(m_culling.noteVertex(i, middle + away, middle + 2 * away));
    EXPECT_TRUE(m_culling.isOutside(m_nodes));
    EXPECT_TRUE(m_culling.noteVertex(2, middle + away, middle - away));
    EXPECT_FALSE(m_culling.isOutside(m_nodes));
    EXPECT_FALSE(m_culling.noteVertex(0, middle + away, middle + away));
    EXPECT_FALSE(m_culling.noteVertex(1, middle - away, middle - away));
    EXPECT_FALSE(m_culling.isOutside({0, 1, 0}));  // the shape is between the two
}

INSTANTIATE_TEST_SUITE_P(Solids, SurfaceCullingTest, ::testing::ValuesIn(convexSolids()), shapeName);

}  // namespace
}  // namespace bullet_fem
