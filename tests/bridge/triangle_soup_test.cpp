// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/geometry/shapes/triangle_soup.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "bridge/bridge_test_shapes.h"
#include "bridge/concave_test_shapes.h"
#include "bullet_bridge/contact/rigid/sheet_contact.h"

namespace bullet_fem
{
namespace
{

const btTransform kOneUp(btQuaternion::getIdentity(), btVector3(0, 0, 1));

TEST(TriangleSoup, ABoxVisitsTheTrianglesInItOnce)
{
    const ConcaveShape shape = makeTriangleMesh({100, 5, true, [](btScalar x, btScalar) { return x * x; }});
    const ShapeLeaf leaf = leafOf(shape.shape(), kOneUp);
    TriangleSoup soup;
    soup.collect(leaf, {-9, -9, -9}, {9, 9, 99});
    ASSERT_EQ(soup.triangles().size(), 20000u);
    const Vec3 low = {0.23, 0.11, 0}, high = {0.57, 0.39, 3};
    std::vector<int> visits(soup.triangles().size(), 0);
    soup.forEachIn(low, high, [&](int t) { ++visits[t]; });
    int within = 0;
    for (std::size_t t = 0; t < visits.size(); ++t)
    {
        const Corners& c = soup.triangles()[t].m_corners;
        bool inside = true;
        for (int a = 0; a < 2; ++a)
            inside = inside && std::max({c[0][a], c[1][a], c[2][a]}) > low[a] - 1e-9 &&
                     std::min({c[0][a], c[1][a], c[2][a]}) < high[a] + 1e-9;
        EXPECT_EQ(visits[t], inside ? 1 : 0);
        within += inside;
    }
    EXPECT_EQ(within, 24) << "4 x 3 cells";
}

TEST(TriangleSoup, APathMeetsTheFirstTriangle)
{
    const ConcaveShape shape = makeTriangleMesh();
    TriangleSoup soup;
    soup.collect(leafOf(shape.shape(), kOneUp), {-9, -9, -9}, {9, 9, 9});
    const SoupCrossing crossing = soup.firstCrossing({0.1, 0.2, 4}, {0.1, 0.2, -2});
    ASSERT_GE(crossing.m_triangle, 0);
    EXPECT_NEAR(crossing.m_along, 0.5, 1e-12);
    EXPECT_NEAR(crossing.m_normal.z, 1, 1e-12);
    EXPECT_EQ(soup.firstCrossing({0.1, 0.2, 4}, {0.1, 0.2, 1.1}).m_triangle, -1);
    EXPECT_EQ(soup.firstCrossing({3.1, 0.2, 4}, {3.1, 0.2, -2}).m_triangle, -1);
    // Lines through edges and corners between triangles count, too.
    EXPECT_GE(soup.firstCrossing({0.4, 0.4, 4}, {0.4, 0.4, -2}).m_triangle, 0);
    EXPECT_GE(soup.firstCrossing({0.2, 0.2, -4}, {0.2, 0.2, 2}).m_triangle, 0);
}

// The extension of a path through the sheet's thickness crosses a face beyond a ridge; the point meets the one below
// it.
TEST(TriangleSoup, APointOverAThickSlopeMeetsTheFaceBelowIt)
{
    const ConcaveShape shape =
        makeTriangleMesh({2, 2, true, [](btScalar x, btScalar) { return -btScalar(x < 0 ? 0.3 : 0.4) * x; }});
    TriangleSoup soup;
    soup.collect(leafOf(shape.shape()), {-2, -2, -2}, {2, 2, 2});
    SheetProbe probe;
    probe.m_thickness = 0.5;
    probe.m_band = 0.02;
    const Vec3 left = unit(Vec3{0.3, 0, 1});
    for (const Vec3& path : {Vec3{0, 0, -1e-6}, Vec3{1e-6, 0, -1e-6}, Vec3{0, 0, -0.1}, Vec3{-0.1, 0, -0.1}})
    {
        std::vector<SheetContact> touches;
        probe.m_position = probe.m_rightSide = Vec3{-0.1, 0.2, 0.03} + 0.501 * left;
        probe.m_path = path;
        findPointContacts(soup, probe, touches);
        ASSERT_EQ(touches.size(), 1u);
        EXPECT_NEAR(norm(touches[0].m_surface.m_normal - left), 0, 1e-6);
        EXPECT_NEAR(touches[0].m_surface.m_gap, 0.001, 1e-6);
    }
    // Far above, it comes to the ridge, or to the other slope.
    std::vector<SheetContact> touches;
    probe.m_position = probe.m_rightSide = Vec3{-0.1, 0.2, 0.03} + 1.0 * left;
    probe.m_path = {0.5, 0, -1};
    findPointContacts(soup, probe, touches);
    EXPECT_GT(touches.size(), 1u);
}

}  // namespace
}  // namespace bullet_fem
