// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/soft/soft_pair_search.h"

#include <gtest/gtest.h>

#include "bridge/soft_pair_bodies.h"
#include "bullet_fem/fem/common/threads.h"
#include "bullet_fem/fem/step/stepping.h"

namespace bullet_fem
{
namespace
{

constexpr double kSearchStep = 1.0 / 60;
constexpr int kManyContacts = 1000;

// A unit cube at rest, flush on another one, outside any world.
class SoftPairSearchTest : public testing::Test
{
protected:
    explicit SoftPairSearchTest(int cellsOfUpper = 2) : m_upper(cube(cellsOfUpper))
    {
        m_upper.m_fem.m_overlaps.m_soft.push_back(m_lower.m_soft.get());
        moveUpper({0, 0, 1});
    }

    void moveUpper(const Vec3& by)
    {
        for (Vec3& x : m_upper.m_fem.m_body.m_state.m_x) x += by;
    }

    void throwUpper(const Vec3& v)
    {
        std::vector<Vec3>& all = m_upper.m_fem.m_body.m_state.m_v;
        all.assign(all.size(), v);
    }

    /// The number of pairs searched in a step; contacts are remembered only if the step is solved.
    int searched(int maxContacts = kManyContacts, bool isSolved = true)
    {
        m_search.beginStep();
        return searchedAgain(maxContacts, isSolved);
    }

    int searchedAgain(int maxContacts = kManyContacts, bool isSolved = true)
    {
        StepSettings settings;
        settings.m_step = kSearchStep;
        for (FemSoftBody* fem : m_bodies) solveFreeMotion(fem->m_body, settings);
        m_search.find(m_bodies, kSearchStep, maxContacts);
        if (isSolved) m_search.remember(m_search.contacts().data());
        return m_search.searchedPairs();
    }

    double minGap() const
    {
        double least = 1e30;
        for (const ContactPoint& contact : m_search.contacts()) least = std::min(least, contact.m_gap);
        return least;
    }

    Threads m_threads;
    PairBody m_upper, m_lower = PairBody(cube());
    std::vector<FemSoftBody*> m_bodies = {&m_upper.m_fem, &m_lower.m_fem};
    SoftPairSearch m_search{m_threads};
    const double m_edge = m_lower.m_fem.m_surface.meanEdge();
};

class SearchOfAFineCube : public SoftPairSearchTest
{
protected:
    SearchOfAFineCube() : SoftPairSearchTest(8) {}
};

TEST_F(SoftPairSearchTest, UnmovedPairsKeepTheirContacts)
{
    EXPECT_EQ(searched(kManyContacts, false), 1);
    std::vector<ContactPoint> found = m_search.contacts();
    const std::vector<SoftPairOrigin> origins = m_search.origins();
    ASSERT_GT(found.size(), 8u);
    for (std::size_t k = 0; k < found.size(); ++k)
    {
        found[k].m_impulse = double(k) * found[k].m_normal;
        found[k].m_slip = {1e-3 * double(k), 0, 0};
    }
    m_search.remember(found.data());
    m_upper.m_soft->m_cfg.kDF = btScalar(0.75);
    EXPECT_EQ(searched(), 0);
    ASSERT_EQ(m_search.contacts().size(), found.size());
    for (std::size_t k = 0; k < found.size(); ++k)
    {
        const ContactPoint& kept = m_search.contacts()[k];
        EXPECT_EQ(kept.m_soft.m_body, found[k].m_soft.m_body);
        EXPECT_EQ(kept.m_other.m_body, found[k].m_other.m_body);
        EXPECT_EQ(norm(kept.m_impulse - found[k].m_impulse), 0);
        EXPECT_EQ(norm(kept.m_slip - found[k].m_slip), 0);
        EXPECT_NEAR(norm(kept.m_point - found[k].m_point), 0, kExact);
        EXPECT_NEAR(kept.m_gap, found[k].m_gap, kExact);
        EXPECT_EQ(kept.m_friction, 0.75);
        EXPECT_FALSE(m_search.origins()[k] < origins[k] || origins[k] < m_search.origins()[k]);
    }
}

TEST_F(SoftPairSearchTest, GapsOfKeptContactsFollowTheMotion)
{
    searched();
    const double before = minGap();
    moveUpper({0, 0, 0.004 * m_edge});
    EXPECT_EQ(searched(), 0);
    EXPECT_NEAR(minGap(), before + 0.004 * m_edge, kExact);
    moveUpper({0, 0, -0.008 * m_edge});
    EXPECT_EQ(searched(), 0);
    EXPECT_NEAR(minGap(), before - 0.004 * m_edge, kExact);
}

TEST_F(SoftPairSearchTest, MovedPairIsSearched)
{
    searched();
    moveUpper({0, 0, 0.01 * m_edge});
    EXPECT_EQ(searched(), 1);
    EXPECT_EQ(searched(), 0);
    moveUpper({0.01 * m_edge, 0, 0});
    EXPECT_EQ(searched(), 1);
}

TEST_F(SoftPairSearchTest, OneMovedNodeTriggersASearch)
{
    searched();
    m_lower.m_fem.m_body.m_state.m_x.back().x += 0.01 * m_edge;
    EXPECT_EQ(searched(), 1);
}

// The smallest steps accumulate to a search, too.
TEST_F(SoftPairSearchTest, CreepingPairIsSearchedOccasionally)
{
    searched();
    int searches = 0;
    for (int k = 0; k < 40; ++k)
    {
        moveUpper({0.001 * m_edge, 0, 0});
        searches += searched();
    }
    EXPECT_EQ(searches, 5);  // 7 steps of .001 edges exceed .00625
}

TEST_F(SoftPairSearchTest, PairExpectedToMoveIsSearched)
{
    searched();
    throwUpper({0, 0, 0.01 * m_edge / kSearchStep});
    EXPECT_EQ(searched(), 1);
    EXPECT_EQ(searched(), 1);
    throwUpper({0, 0, 0.004 * m_edge / kSearchStep});
    EXPECT_EQ(searched(), 0);
}

// The solver of a monolithic step may return it unsolved.
TEST_F(SoftPairSearchTest, UnsolvedPairIsSearchedAgain)
{
    searched();
    moveUpper({0, 0, 0.01 * m_edge});
    EXPECT_EQ(searched(kManyContacts, false), 1);
    const std::size_t count = m_search.contacts().size();
    EXPECT_EQ(searchedAgain(), 1);
    EXPECT_EQ(m_search.contacts().size(), count);
    EXPECT_EQ(searched(), 0);
}

TEST_F(SoftPairSearchTest, PreviouslySeparatePairIsSearched)
{
    searched();
    m_upper.m_fem.m_overlaps.m_soft.clear();
    EXPECT_EQ(searched(), 0);
    m_upper.m_fem.m_overlaps.m_soft.push_back(m_lower.m_soft.get());
    EXPECT_EQ(searched(), 1);
}

// A contact left out at the limit may matter in the next step.
TEST_F(SoftPairSearchTest, PairAboveTheContactLimitIsSearched)
{
    searched();
    EXPECT_EQ(searched(4), 0);  // no contact is left out
    EXPECT_EQ(m_search.contacts().size(), 4u);
    EXPECT_TRUE(m_search.isLimited(0));
    EXPECT_EQ(searched(4), 1);
    EXPECT_EQ(searched(4), 1);
    EXPECT_EQ(searched(), 1);
    EXPECT_GT(m_search.contacts().size(), 4u);
    EXPECT_EQ(searched(), 0);
}

TEST_F(SoftPairSearchTest, PairWithForgottenPlaceIsSearched)
{
    searched();
    m_lower.m_fem.m_memory.m_place.forget();
    EXPECT_EQ(searched(), 1);
    EXPECT_EQ(searched(), 0);
}

// A body may move by a quarter of half the finer body's contact band.
TEST_F(SearchOfAFineCube, LooksFromItsEdges)
{
    searched();
    const double fine = m_upper.m_fem.m_surface.meanEdge();
    ASSERT_LT(fine, 0.3 * m_edge);
    for (Vec3& x : m_lower.m_fem.m_body.m_state.m_x) x.z -= 0.004 * fine;
    EXPECT_EQ(searched(), 0);
    for (Vec3& x : m_lower.m_fem.m_body.m_state.m_x) x.z -= 0.004 * fine;
    EXPECT_EQ(searched(), 1);
}

}  // namespace
}  // namespace bullet_fem
