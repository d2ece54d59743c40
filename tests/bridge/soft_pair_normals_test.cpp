// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Contact normals of pairs of soft bodies: with several faces in reach, and in overlaps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bridge/soft_pair_bodies.h"

namespace bullet_fem
{
namespace
{

TEST(SoftPairNormals, InitialOverlapIsResolvedTheShortWay)
{
    for (double depth : {0.05, 0.2, 0.45})
    {
        PairBody upper(cube(4)), lower(cube(4));
        upper.move({0.13, 0.07, 1 - depth});
        const PairContacts found(upper, lower);
        int up = 0;
        for (const ContactPoint& c : found.m_contacts)
        {
            EXPECT_TRUE(isFinite(c.m_normal));
            EXPECT_NEAR(norm(c.m_normal), 1, kExact);
            EXPECT_GE(c.m_gap, -depth - kExact);
            EXPECT_LT(c.m_gap, 0.02);
            if (c.m_gap < -1e-9) up += std::fabs(c.m_normal.z) > 0.99;
        }
        EXPECT_GE(up, 8) << depth;
    }
}

// A tetrahedron whose first node, at the origin, points in the direction (-1, 0, -1).
TetMesh obliqueTip()
{
    return TetMesh({{0, 0, 0}, {0.3, 0.1, 0.1}, {0.1, 0.1, 0.3}, {0.2, -0.1, 0.2}}, {{0, 1, 2, 3}});
}

TEST(SoftPairNormals, NearerFaceGivesTheNormalInsideAnEdge)
{
    PairBody tip(obliqueTip()), block(cube(4));
    tip.move({0.98, 0.4, 0.99});  // 0.02 under one face, 0.01 under the other
    const PairContacts found(tip, block);
    ASSERT_EQ(found.count(SoftPairKind::nodeOfFirst), 1);
    EXPECT_NEAR(found.m_contacts[0].m_normal.z, 1, kExact);
    EXPECT_NEAR(found.m_contacts[0].m_gap, -0.01, kExact);
}

TEST(SoftPairNormals, OneFaceGivesTheContactOnARim)
{
    PairBody tip(obliqueTip()), block(cube(4));
    tip.move({1 + 1e-6, 0.4, 1 + 1e-6});
    const PairContacts found(tip, block);
    ASSERT_EQ(found.m_contacts.size(), 1u);
    EXPECT_NEAR(found.m_contacts[0].m_gap, 1e-6, kExact);
}

TEST(SoftPairNormals, ATipSunkIntoTheFloorOfAGrooveIsHeldByItsWallToo)
{
    PairBody tip(obliqueTip());
    PairBody groove(without(cube(2), [](const Vec3& middle) { return middle.x > 0.5 && middle.z > 0.5; }));
    for (const Vec3& at : {Vec3{0.501, 0.4, 0.4999}, Vec3{0.4999, 0.4, 0.501}, Vec3{0.4999, 0.4, 0.499}})
    {
        tip.m_x = tip.m_fem.m_body.m_model->mesh().restPositions();
        tip.move(at);
        const PairContacts found(tip, groove);
        ASSERT_EQ(found.count(SoftPairKind::nodeOfFirst), 2);
        for (const ContactPoint& c : {found.m_contacts[0], found.m_contacts[1]})
        {
            EXPECT_NEAR(std::max(c.m_normal.x, c.m_normal.z), 1, kExact);
            EXPECT_NEAR(c.m_gap, c.m_normal.x > 0.5 ? at.x - 0.5 : at.z - 0.5, kExact);
        }
    }
}

// Four nearly equal faces meet under the tip: none is preferred.
TEST(SoftPairNormals, MeanNormalIsUsedOverAFlatCorner)
{
    PairBody tip(TetMesh({{0, 0, 0}, {-0.1, -0.11, 0.5}, {0.1, -0.1, 0.5}, {0, 0.2, 0.5}}, {{0, 1, 2, 3}}));
    PairBody block(makeBox({1, 1, 1}, {2, 2, 2}, {-0.5, -0.5, -1}));
    block.bend([](const Vec3& x) { return norm(x) == 0 ? Vec3{0, 0, -0.02} : x; });
    tip.move({0, 0, -0.019});
    const PairContacts found(tip, block);
    ASSERT_EQ(found.m_contacts.size(), 1u);
    EXPECT_NEAR(found.m_contacts[0].m_normal.z, 1, kExact);
    EXPECT_NEAR(found.m_contacts[0].m_gap, 0.001, 0.04 * 0.04 * 0.001) << "to the slope of the dent squared";
}

TEST(SoftPairNormals, FirstOfTwoLayersStopsAFastTip)
{
    PairBody tip(TetMesh({{0.4, 0.15, 1}, {0.3, 0.1, 1.5}, {0.5, 0.1, 1.5}, {0.4, 0.25, 1.5}}, {{0, 1, 2, 3}}));
    tip.throwAt({0, 0, -90});  // 1.5 m a step
    PairBody strip(makeBox({2, 0.3, 0.1}, {20, 3, 1}));
    strip.bend([](const Vec3& X) { return X.x <= 1 ? X + Vec3{0, 0, 0.4 * X.x} : Vec3{2 - X.x, X.y, 0.7 - X.z}; });
    const PairContacts found(tip, strip);
    ASSERT_EQ(found.count(SoftPairKind::nodeOfFirst), 1);
    EXPECT_NEAR(found.m_contacts[0].m_gap, 0.3, 1e-9) << "the layer at z = 0.7 is level";
}

TEST(SoftPairNormals, EdgesFacingAwayMakeNoContact)
{
    PairBody upper(makeBox({3, 0.5, 0.5}, {1, 1, 1})), lower(makeBox({0.5, 3, 0.02}, {1, 1, 1}));
    upper.move({-1.2, 1.1, 0.021});
    const PairContacts found(upper, lower);  // the lower edges of the plate are in reach
    EXPECT_EQ(found.m_contacts.size(), 4u);
    expectAlongZ(found, 0.001);
}

// An edge that rises outwards from a point under the face crosses the rim in a direction that separates nothing.
TEST(SoftPairNormals, EdgeContactsARimOnlyBetweenItsFaceNormals)
{
    PairBody tip(TetMesh({{0.9, 0.4, 0.98}, {1.3, 0.45, 1.08}, {1, 0.2, 1.5}, {1.1, 0.7, 1.5}}, {{0, 1, 2, 3}}));
    PairBody block(cube(4));
    const PairContacts found(tip, block);
    ASSERT_EQ(found.m_contacts.size(), 1u);
    expectAlongZ(found, -0.02);
}

TEST(SoftPairNormals, SmallSidewaysOverlapIsNotLiftedUp)
{
    PairBody a(cube(1)), b(cube(1));
    a.move({0.99, 0.3, 0.7});
    const PairContacts found(a, b);
    ASSERT_FALSE(found.m_contacts.empty());
    for (const ContactPoint& c : found.m_contacts)
    {
        EXPECT_NEAR(std::fabs(c.m_normal.x), 1, kExact);
        EXPECT_NEAR(c.m_gap, -0.01, kExact);
    }
}

}  // namespace
}  // namespace bullet_fem
