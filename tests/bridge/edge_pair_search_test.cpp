// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/soft/edge_pair_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bridge/soft_pair_bodies.h"

namespace bullet_fem
{
namespace
{

TEST(EdgePairSearch, CrossingBarsContactAtRimCrossings)
{
    PairBody upper(makeBox({3, 0.5, 0.5}, {1, 1, 1})), lower(makeBox({0.5, 3, 0.5}, {1, 1, 1}));
    upper.move({-1.2, 1.1, 0.501});
    const PairContacts found(upper, lower);
    EXPECT_EQ(found.count(SoftPairKind::edges), 4);
    EXPECT_EQ(found.m_contacts.size(), 4u) << "no node is near";
    expectAlongZ(found, 0.001);
    upper.move({0, 0, -0.101});
    const PairContacts sunk(upper, lower);
    EXPECT_EQ(sunk.count(SoftPairKind::edges), 4);
    expectAlongZ(sunk, -0.1);
}

// The sides at the rims lean outwards, as those of compressed bodies do.
TEST(EdgePairSearch, OverlappingRimsOfLeaningBarsAreInContact)
{
    for (const double slope : {-0.2, 0.01, 0.05, 0.2})
    {
        PairBody upper(makeBox({3, 0.5, 0.5}, {1, 1, 1})), lower(makeBox({0.5, 3, 0.5}, {1, 1, 1}));
        upper.bend([=](const Vec3& x) { return Vec3{x.x, x.y + slope * x.z, x.z}; });
        lower.bend([=](const Vec3& x) { return Vec3{x.x + slope * x.z, x.y, x.z}; });
        upper.move({-1.2, 1.1, 0.4});
        const PairContacts sunk(upper, lower);
        EXPECT_EQ(sunk.count(SoftPairKind::edges), 4) << slope;
        expectAlongZ(sunk, -0.1);
    }
}

TEST(EdgePairSearch, FastCrossingBarsMeet)
{
    PairBody upper(makeBox({3, 0.1, 0.1}, {1, 1, 1})), lower(makeBox({0.1, 3, 0.1}, {1, 1, 1}));
    upper.move({-1.2, 1.1, 0.5}).throwAt({0, 0, -60});
    const PairContacts found(upper, lower);
    EXPECT_GE(found.count(SoftPairKind::edges), 4);
    expectAlongZ(found, 0.4);
}

TEST(EdgePairSearch, EdgePairsContactAlongTheirCommonNormal)
{
    PairBody upper(makeBox({2, 1, 1}, {1, 1, 1}, {-1, -0.5, -0.5})),
        lower(makeBox({2, 1, 1}, {1, 1, 1}, {-1, -0.5, -0.5}));
    upper.turn(testRotation(0.7, 0, 0));  // rests on an edge along x
    lower.turn(testRotation(0.75, 0, 0)).turn(testRotation(0, 0, 1.1));
    double lowest = 1, highest = -1;
    for (const Vec3& x : upper.m_x) lowest = std::min(lowest, x.z);
    for (const Vec3& x : lower.m_x) highest = std::max(highest, x.z);
    upper.move({0, 0, highest - lowest + 0.004});
    const PairContacts found(upper, lower);
    ASSERT_EQ(found.m_contacts.size(), 1u);
    EXPECT_EQ(found.m_origins[0].m_kind, SoftPairKind::edges);
    expectAlongZ(found, 0.004);
}

// Two plates, each bent along its middle, in contact there: the lower one bent along y, the upper one along x with
// short edges whose end points are equally far from the crossing.
class BentPlates : public testing::Test
{
protected:
    void bend(double slope, double gap)
    {
        m_upper.m_x = m_restOfUpper;
        m_lower.m_x = m_restOfLower;
        m_upper.bend([=](const Vec3& x) { return Vec3{x.x, x.y, x.z + gap + slope * std::fabs(x.y)}; });
        m_lower.bend([=](const Vec3& x) { return Vec3{x.x, x.y, x.z - slope * std::fabs(x.x)}; });
    }

    // Counts contacts of edges at the bends, without those of the rims.
    static int countCrossings(const PairContacts& found, double gap)
    {
        int count = 0;
        for (std::size_t k = 0; k < found.m_contacts.size(); ++k)
            count += found.m_origins[k].m_kind == SoftPairKind::edges &&
                     std::fabs(found.m_contacts[k].m_gap - gap) < kExact &&
                     norm(found.m_contacts[k].m_normal - Vec3{0, 0, 1}) < kExact;
        return count;
    }

    PairBody m_upper{makeBox({2, 2, 0.5}, {10, 2, 1}, {-0.9, -1, 0})},
        m_lower{makeBox({2, 2, 0.5}, {2, 1, 1}, {-1, -1, -0.5})};
    const std::vector<Vec3> m_restOfUpper = m_upper.m_x, m_restOfLower = m_lower.m_x;
};

TEST_F(BentPlates, CrossingEdgesWithPenetratingEndsAreInContact)
{
    bend(0.1, -0.0101);  // the ends, .1 m away, are 0.1 mm deep
    const PairContacts found(m_upper, m_lower);
    EXPECT_EQ(countCrossings(found, -0.0101), 1);
    EXPECT_GT(found.count(SoftPairKind::nodeOfFirst), 0);
}

TEST_F(BentPlates, FlattenedEdgesRemainAPairUntilOneIsAGroove)
{
    constexpr double kGap = 1e-4;
    constexpr double kRidge = 0.02, kFlat = 0.005, kGroove = -0.02;  // slopes: 2.3, 0.6 and -2.3 degrees in all
    const auto countAfterRidge = [&](double slope, double impulse)
    {
        bend(kRidge, kGap);
        PairContacts found(m_upper, m_lower);
        EXPECT_EQ(countCrossings(found, kGap), 1);
        for (ContactPoint& c : found.m_contacts) c.m_impulse = impulse * c.m_normal;
        found.m_memory.remember(found.solved());
        found.m_memory.beginStep();
        bend(slope, kGap);
        found.m_contacts.clear();
        found.m_origins.clear();
        found.m_finder.find({m_upper.ready(), 0}, {m_lower.ready(), 1}, 1000, found.m_contacts, found.m_origins);
        return countCrossings(found, kGap);
    };
    EXPECT_EQ(countAfterRidge(kRidge, 1), 1) << "once";
    EXPECT_EQ(countAfterRidge(kFlat, 0), 0) << "nodes carry all that flat edges can";
    EXPECT_EQ(countAfterRidge(kFlat, 1), 1);
    EXPECT_EQ(countAfterRidge(kGroove, 1), 0);
}

TEST_F(BentPlates, EdgesOfAReplacedSurfaceFormNoPair)
{
    bend(0.02, 1e-4);
    PairContacts found(m_upper, m_lower);
    const std::size_t count = found.m_contacts.size();
    for (ContactPoint& c : found.m_contacts) c.m_impulse = c.m_normal;
    for (SoftPairOrigin& origin : found.m_origins) origin.m_feature += 10000000;
    found.m_memory.remember(found.solved());
    found.m_memory.beginStep();
    found.m_contacts.clear();
    found.m_origins.clear();
    found.m_finder.find({m_upper.ready(), 0}, {m_lower.ready(), 1}, 1000, found.m_contacts, found.m_origins);
    EXPECT_EQ(found.m_contacts.size(), count);
}

}  // namespace
}  // namespace bullet_fem
