// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/geometry/surface/noted_place.h"

#include <gtest/gtest.h>

namespace bullet_fem
{
namespace
{

struct NotedPlaceTest : testing::Test
{
    NotedPlace m_place{{0, 2}};
    std::vector<Vec3> m_x = {{1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, m_v = std::vector<Vec3>(3);
};

TEST_F(NotedPlaceTest, IsStillWhileItsVerticesAreAndStayWithinReach)
{
    EXPECT_FALSE(m_place.isStill(m_x, m_v, 1, 0.5));
    m_place.note(m_x);
    m_x[1].y = 7;  // not a vertex of the surface
    EXPECT_TRUE(m_place.isStill(m_x, m_v, 1, 0.5));
    m_x[2].y = 0.3;
    EXPECT_TRUE(m_place.isStill(m_x, m_v, 1, 0.5));
    m_v[2].z = 0.3;
    EXPECT_FALSE(m_place.isStill(m_x, m_v, 1, 0.5));
    EXPECT_TRUE(m_place.isStill(m_x, m_v, 0.5, 0.5));
    m_place.forget();
    EXPECT_FALSE(m_place.isStill(m_x, m_v, 0.5, 0.5));
}

TEST_F(NotedPlaceTest, IsRestoredFromItsPositions)
{
    m_place.note(m_x);
    NotedPlace other({0, 2});
    other.restore(m_place.positions());
    EXPECT_TRUE(other.isStill(m_x, m_v, 1, 0));
    other.restore({});
    EXPECT_FALSE(other.isNoted());
    EXPECT_TRUE(other.positions().empty());
}

}  // namespace
}  // namespace bullet_fem
