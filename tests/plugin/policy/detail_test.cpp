// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <stdexcept>

#include "bullet_fem/btFemHelpers.h"
#include "plugin/record/btFemDetailLevel.h"
#include "plugin/scenes/clamped_beam.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Returns a constant interest.
class PlainInterest : public btFemInterest
{
public:
    explicit PlainInterest(double value = 1) : m_value(static_cast<btScalar>(value)) {}
    btScalar interest(const btSoftBody&) override
    {
        ++m_calls;
        return m_value;
    }

    btScalar m_value;
    int m_calls = 0;
};

// --- Detail level by interest, in steps of 0.1 s with a dwell time of 0.45 s ---

class DetailLevel : public testing::Test
{
protected:
    DetailLevel() { m_policy.m_dwell = btScalar(0.45); }

    btFemDetail after(double interest, int steps = 1)
    {
        for (int k = 0; k < steps; ++k) m_level.update(interest, 0.1, m_policy);
        return m_level.detail();
    }

    btFemDetailPolicy m_policy;
    btFemDetailLevel m_level;
};

TEST_F(DetailLevel, StartsAtTheLevelOfTheFirstInterest)
{
    EXPECT_EQ(m_level.detail(), btFemDetail::nodalWarp);
    EXPECT_EQ(after(0.05), btFemDetail::direct);
    m_level = {};
    EXPECT_EQ(after(0.3), btFemDetail::oneIteration);
}

TEST_F(DetailLevel, RisesAtOnce)
{
    after(0);
    EXPECT_EQ(after(0.21), btFemDetail::oneIteration);
    EXPECT_EQ(after(0.51), btFemDetail::nodalWarp);
    m_level = {};
    after(0);
    EXPECT_EQ(after(1), btFemDetail::nodalWarp);
}

TEST_F(DetailLevel, SinksAfterTheDwellOnly)
{
    after(1);
    EXPECT_EQ(after(0, 4), btFemDetail::nodalWarp);
    EXPECT_EQ(after(0), btFemDetail::direct);
}

TEST_F(DetailLevel, StaysBetweenItsTwoBoundsForGood)
{
    after(1);
    EXPECT_EQ(after(0.41, 100), btFemDetail::nodalWarp);
    EXPECT_EQ(after(0.39), btFemDetail::oneIteration);
    EXPECT_EQ(after(0.49, 100), btFemDetail::oneIteration);
    EXPECT_EQ(after(0.11, 100), btFemDetail::oneIteration);
    EXPECT_EQ(after(0.09), btFemDetail::direct);
    EXPECT_EQ(after(0.19, 100), btFemDetail::direct);
}

TEST_F(DetailLevel, ChangesAtMostTwicePerDwell)
{
    int changes = 0;
    btFemDetail last = after(1);
    for (int k = 0; k < 1000; ++k)
    {
        const btFemDetail now = after(k % 2);
        changes += now != last;
        last = now;
    }
    // The level rises in a step of high interest, falls in the fifth step after it, and rises again in the next.
    EXPECT_EQ(changes, 2 * (1000 / 6));
}

TEST(DetailPolicy, RejectsBoundsOutOfOrderAndNamesThem)
{
    const auto expectRejected = [](btScalar btFemDetailPolicy::*member, double value, const char* name)
    {
        SCOPED_TRACE(name);
        btFemDetailPolicy policy;
        policy.*member = static_cast<btScalar>(value);
        std::string why;
        EXPECT_FALSE(policy.valid(&why));
        EXPECT_NE(why.find(name), std::string::npos) << why;
        btFemSoftBodySolver fem;
        EXPECT_THROW(fem.setInterest(nullptr, policy), std::invalid_argument);
    };
    using Policy = btFemDetailPolicy;
    EXPECT_TRUE(Policy().valid());
    expectRejected(&Policy::m_fullFrom, 1.1, "m_fullFrom");
    expectRejected(&Policy::m_fullFrom, kNaN, "m_fullFrom");
    expectRejected(&Policy::m_fullUntil, 0.6, "m_fullUntil");
    expectRejected(&Policy::m_fullUntil, 0.05, "m_reducedUntil");
    expectRejected(&Policy::m_reducedFrom, 0.6, "m_reducedFrom");
    expectRejected(&Policy::m_reducedUntil, 0.3, "m_reducedUntil");
    expectRejected(&Policy::m_reducedUntil, -0.1, "m_reducedUntil");
    expectRejected(&Policy::m_dwell, -1, "m_dwell");
    expectRejected(&Policy::m_dwell, kNaN, "m_dwell");
}

// --- Automatic and explicit levels ---

class AutomaticDetail : public testing::Test
{
protected:
    btFemDetail detailAfterAStep()
    {
        m_world.step();
        return m_fem.stepReport(&m_cube).m_detail;
    }

    PlainInterest m_interest;
    btFemSoftBodySolver m_fem;
    SoftWorld m_world{m_fem, btVector3(0, 0, 0)};
    btSoftBody& m_cube = addUnitCube(m_world, btVector3(0, 0, 10));
};

TEST_F(AutomaticDetail, IsFullWithoutAnInterestAndAgainWhenItIsTakenBack)
{
    EXPECT_EQ(detailAfterAStep(), btFemDetail::nodalWarp);
    m_interest.m_value = 0;
    m_fem.setInterest(&m_interest);
    EXPECT_EQ(detailAfterAStep(), btFemDetail::direct);
    m_fem.setInterest(nullptr);
    EXPECT_EQ(detailAfterAStep(), btFemDetail::nodalWarp);
    EXPECT_EQ(m_interest.m_calls, 1);
}

TEST_F(AutomaticDetail, AsksOnceAStepAndBody)
{
    m_fem.setInterest(&m_interest);
    addUnitCube(m_world, btVector3(0, 0, 20));
    m_world.step(7);
    EXPECT_EQ(m_interest.m_calls, 14);
}

TEST_F(AutomaticDetail, GivesWayToTheUsersChoiceUntilItIsGivenBack)
{
    m_interest.m_value = 0;
    m_fem.setInterest(&m_interest);
    EXPECT_EQ(detailAfterAStep(), btFemDetail::direct);
    for (const btFemDetail chosen : {btFemDetail::globalWarp, btFemDetail::nodalWarp, btFemDetail::oneIteration})
    {
        m_fem.setDetail(&m_cube, chosen);
        EXPECT_EQ(detailAfterAStep(), chosen);
    }
    m_interest.m_value = btScalar(0.3);
    m_fem.setDetail(&m_cube, btFemDetail::automatic);
    EXPECT_EQ(detailAfterAStep(), btFemDetail::oneIteration);
    EXPECT_EQ(m_interest.m_calls, 2);
}

TEST_F(AutomaticDetail, TakesNaNForFullInterestAndReportsIt)
{
    m_interest.m_value = 0;
    m_fem.setInterest(&m_interest);
    EXPECT_EQ(detailAfterAStep(), btFemDetail::direct);
    EXPECT_EQ(m_fem.stepReport(&m_cube).m_flags, 0);
    m_interest.m_value = static_cast<btScalar>(kNaN);
    EXPECT_EQ(detailAfterAStep(), btFemDetail::nodalWarp);
    EXPECT_EQ(m_fem.stepReport(&m_cube).m_flags, BT_FEM_BAD_INTEREST);
    m_interest.m_value = 1;
    EXPECT_EQ(detailAfterAStep(), btFemDetail::nodalWarp);
    EXPECT_EQ(m_fem.stepReport(&m_cube).m_flags, 0);
}

TEST_F(AutomaticDetail, ClampsInterestOutOfRangeAndReportsIt)
{
    const btScalar infinity = std::numeric_limits<btScalar>::infinity();
    m_fem.setInterest(&m_interest);
    for (const btScalar low : {btScalar(-0.01), -infinity})
    {
        m_interest.m_value = low;
        m_fem.setDetail(&m_cube, btFemDetail::automatic);  // again, without a dwell time
        EXPECT_EQ(detailAfterAStep(), btFemDetail::direct) << low;
        EXPECT_EQ(m_fem.stepReport(&m_cube).m_flags, BT_FEM_BAD_INTEREST) << low;
    }
    for (const btScalar high : {btScalar(1.01), infinity})
    {
        m_interest.m_value = high;
        EXPECT_EQ(detailAfterAStep(), btFemDetail::nodalWarp) << high;
        EXPECT_EQ(m_fem.stepReport(&m_cube).m_flags, BT_FEM_BAD_INTEREST) << high;
    }
}

TEST(AutomaticDetailInContact, IsFullWhileInContact)
{
    PlainInterest none(0);
    btFemSoftBodySolver fem;
    SoftWorld world(fem);
    world.addPlane();
    btSoftBody& cube = addUnitCube(world, btVector3(0, 0, btScalar(0.51)));
    fem.setInterest(&none);
    world.step();
    EXPECT_EQ(fem.stepReport(&cube).m_detail, btFemDetail::direct);
    world.step(180);
    EXPECT_EQ(fem.stepReport(&cube).m_detail, btFemDetail::nodalWarp);
    EXPECT_NEAR(impulseOn(fem, cube).z / kStep, massOf(cube) * kGravity, 1e-3 * massOf(cube) * kGravity);
    cube.translate(btVector3(0, 0, 5));
    world.step(2);  // the first step still has the last one's contacts
    EXPECT_EQ(fem.stepReport(&cube).m_detail, btFemDetail::direct);
    fem.setDetail(&cube, btFemDetail::oneIteration);
    world.step();
    EXPECT_EQ(fem.stepReport(&cube).m_detail, btFemDetail::oneIteration);
    EXPECT_LE(fem.stepReport(&cube).m_iterations, 1);
}

// --- Bodies of low interest ---

struct Coarse
{
    double m_young;     // [Pa]
    bool m_isPinned;    // pinned after its factor was made, at a corner: it swings
    double m_ofFactor;  // the factor's step over that of others [-]
};

void PrintTo(const Coarse& coarse, std::ostream* out)
{
    *out << coarse.m_young << (coarse.m_isPinned ? " pinned" : " free") << " factor of " << coarse.m_ofFactor;
}

class CoarseDetail : public testing::TestWithParam<std::tuple<btFemDetail, Coarse>>
{
};

// A single iteration a step, with any residual, would accelerate such bodies to hundreds of metres a second.
TEST_P(CoarseDetail, AddsNoEnergy)
{
    const auto& [detail, coarse] = GetParam();
    btFemSoftBodySolver fem;
    SoftWorld world(fem, btVector3(0, 0, btScalar(coarse.m_isPinned ? -kGravity : 0)));
    SoftBox box;
    box.m_size = {0.4, 0.2, 0.14};
    box.m_cells = {4, 2, 1};
    box.m_youngModulus = btScalar(coarse.m_young);
    btSoftBody& bar = addSoftBox(world, fem, box);
    fem.setDetail(&bar, detail);
    world.bullet().stepSimulation(btScalar(coarse.m_ofFactor * kStep), 0);
    if (coarse.m_isPinned)
        bar.setMass(0, 0);
    else
        for (int i = 0; i < bar.m_nodes.size(); ++i)
            bar.m_nodes[i].m_v += btVector3(0, 1, 6).cross(bar.m_nodes[i].m_x) * btScalar(1 + 0.2 * (i % 3));
    const double mass = massOf(bar), height = centerOf(bar).z, start = motionOf(bar).m_energy;
    for (int k = 0; k < 600; ++k)
    {
        world.step();
        const double fallen = coarse.m_isPinned ? height - centerOf(bar).z + 0.01 : 0;
        ASSERT_LE(motionOf(bar).m_energy, 1.02 * start + mass * kGravity * fallen) << "step " << k;
        ASSERT_EQ(fem.stepReport(&bar).m_detail, detail);
    }
}

INSTANTIATE_TEST_SUITE_P(Bars, CoarseDetail,
                         testing::Combine(testing::Values(btFemDetail::direct, btFemDetail::oneIteration),
                                          testing::Values(Coarse{1e5, false, 10}, Coarse{1e7, true, 1},
                                                          Coarse{1e9, false, 1}, Coarse{1e9, true, 1})));

class StalePinTest : public testing::TestWithParam<btFemDetail>
{
};

// The factor does not include the pin, and a residual of 5 % of the forces in a bar of 1 GPa bends it further in each
// step.
TEST_P(StalePinTest, AddsNoEnergyInVaryingSteps)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem, btVector3(0, 0, btScalar(-kGravity)));
    SoftBox box;
    box.m_size = {0.4, 0.2, 0.14};
    box.m_cells = {4, 2, 1};
    btSoftBody& bar = addSoftBox(world, fem, box);
    btFemMaterial material;
    material.m_youngModulus = btScalar(1e9);
    material.m_poissonRatio = btScalar(0.487);
    material.m_density = 1000;
    material.m_stiffnessDamping = btScalar(1.6e-5);
    fem.setMaterial(&bar, material);
    fem.setDetail(&bar, GetParam());
    world.step();
    bar.setMass(0, 0);
    for (int i = 1; i < bar.m_nodes.size(); ++i)
        bar.m_nodes[i].m_v = btVector3(1, 4, 3).cross(bar.m_nodes[i].m_x - bar.m_nodes[0].m_x);
    const double mass = massOf(bar), height = centerOf(bar).z, start = motionOf(bar).m_energy;
    const double rates[] = {60, 60, 60, 240, 60, 175, 690};  // [Hz]
    for (int k = 0; k < 1200; ++k)
    {
        world.bullet().stepSimulation(btScalar(1 / rates[k % std::size(rates)]), 0);
        const double fallen = height - centerOf(bar).z + 0.01;
        ASSERT_LE(motionOf(bar).m_energy, 1.02 * start + mass * kGravity * fallen) << "step " << k;
    }
}

INSTANTIATE_TEST_SUITE_P(Bars, StalePinTest, testing::Values(btFemDetail::direct, btFemDetail::oneIteration));

TEST(Detail, RejectsUnknownValues)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem);
    btSoftBody& cube = addUnitCube(world, btVector3(0, 0, 0));
    std::string why;
    EXPECT_FALSE(fem.setDetail(&cube, static_cast<btFemDetail>(77), &why));
    EXPECT_EQ(why, "setDetail: the detail is 77; it must be one of btFemDetail, 0 to 4");
    EXPECT_THROW(fem.setDetail(&cube, static_cast<btFemDetail>(-1)), std::invalid_argument);
}

// --- Viewer interest ---

TEST(ViewerInterest, FallsLinearlyWithTheDistanceToTheBox)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem, btVector3(0, 0, 0));
    btSoftBody& cube = addUnitCube(world, btVector3(0, 0, 0));
    btVector3 lower, upper;
    cube.getAabb(lower, upper);
    btFemViewerInterest viewer(10, 50);
    for (const double distance : {0.0, 5.0, 10.0, 20.0, 30.0, 49.0, 50.0, 1000.0})
    {
        viewer.setViewer(btVector3(upper.x() + btScalar(distance), 0, 0));
        EXPECT_NEAR(viewer.interest(cube), std::min(1.0, std::max(0.0, (50 - distance) / 40)), 1e-5) << distance;
    }
    viewer.setViewer(upper + btVector3(3, 4, 12) * 2);  // off a corner: 26 m
    EXPECT_NEAR(viewer.interest(cube), 24.0 / 40, 1e-5);
    viewer.setViewer(btVector3(static_cast<btScalar>(kNaN), 0, 0));
    EXPECT_TRUE(std::isnan(viewer.interest(cube)));
}

TEST(ViewerInterest, IsZeroForInvisibleBodies)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem, btVector3(0, 0, 0));
    btSoftBody &seen = addUnitCube(world, btVector3(0, 0, 0)), &hidden = addUnitCube(world, btVector3(5, 0, 0));
    btFemViewerInterest viewer(10, 50);
    viewer.setVisibility([&](const btSoftBody& body) { return &body != &hidden; });
    fem.setInterest(&viewer);
    world.step();
    EXPECT_EQ(fem.stepReport(&seen).m_detail, btFemDetail::nodalWarp);
    EXPECT_EQ(fem.stepReport(&hidden).m_detail, btFemDetail::direct);
    viewer.setVisibility(nullptr);
    world.step();
    EXPECT_EQ(fem.stepReport(&hidden).m_detail, btFemDetail::nodalWarp);
}

TEST(ViewerInterest, RejectsDistancesOutOfOrder)
{
    const btScalar infinity = std::numeric_limits<btScalar>::infinity(), nan = static_cast<btScalar>(kNaN);
    EXPECT_THROW(btFemViewerInterest(-1, 10), std::invalid_argument);
    EXPECT_THROW(btFemViewerInterest(10, 10), std::invalid_argument);
    EXPECT_THROW(btFemViewerInterest(1, infinity), std::invalid_argument);
    EXPECT_THROW(btFemViewerInterest(nan, 10), std::invalid_argument);
    EXPECT_THROW(btFemViewerInterest(1, nan), std::invalid_argument);
}

// --- Continuity at changes of level ---

struct Switch
{
    const char* m_name;
    double m_before, m_after;  // interest
    btScalar m_youngModulus;
};

void PrintTo(const Switch& change, std::ostream* out)
{
    *out << change.m_name;
}

const btFemDetailPolicy g_shortDwell = []
{
    btFemDetailPolicy policy;
    policy.m_dwell = btScalar(0.3);  // less than 20 steps
    return policy;
}();

class DetailSwitch : public testing::TestWithParam<Switch>
{
protected:
    // Two beams with bitwise equal steps; one of them will change its level.
    void settle(double massDamping, int steps)
    {
        for (auto& beam : m_beam)
        {
            ClampedBeam::Settings settings;
            settings.m_info = implicitEuler();
            settings.m_youngModulus = GetParam().m_youngModulus;
            settings.m_massDamping = static_cast<btScalar>(massDamping);
            beam = std::make_unique<ClampedBeam>(settings);
        }
        for (int k = 0; k < 2; ++k)
        {
            m_interest[k].m_value = static_cast<btScalar>(GetParam().m_before);
            m_beam[k]->fem().setInterest(&m_interest[k], g_shortDwell);
            m_beam[k]->step(steps);
        }
        m_interest[1].m_value = static_cast<btScalar>(GetParam().m_after);
    }

    double tipDistance() const { return (m_beam[0]->tip() - m_beam[1]->tip()).length(); }

    PlainInterest m_interest[2];
    std::unique_ptr<ClampedBeam> m_beam[2];
};

// One of the two is fully solved in the step of the change. Motion is continuous by construction, because state and
// increments are kept; the difference is the error of one iteration. It is .1 % of the tip's displacement in the step
// or less (measured), except at the turning point, where the soft beam, hanging straight down, differs by 2e-5 m in a
// step of 7e-3 m. The bound is twice that share plus 1e-5 of the beam's length.
TEST_P(DetailSwitch, MovesASwingingTipAsTheFullSolutionWould)
{
    for (const int steps : {20, 37, 50, 75})
    {
        SCOPED_TRACE(steps);
        settle(0, steps);
        const btVector3 before = m_beam[0]->tip();
        ASSERT_EQ(tipDistance(), 0);
        for (auto& beam : m_beam) beam->step();
        EXPECT_NE(m_beam[0]->report().m_detail, m_beam[1]->report().m_detail);
        EXPECT_LE(tipDistance(), 2e-3 * (m_beam[0]->tip() - before).length() + 1e-5 * 4);
    }
}

// The beam is at rest; a second at the new level must not move it.
TEST_P(DetailSwitch, LeavesARestingTipInPlace)
{
    settle(4, 600);
    for (int k = 0; k < 60; ++k)
    {
        for (auto& beam : m_beam) beam->step();
        EXPECT_LE(tipDistance(), 1e-5) << k;
    }
    EXPECT_NE(m_beam[0]->report().m_detail, m_beam[1]->report().m_detail);
}

INSTANTIATE_TEST_SUITE_P(Switches, DetailSwitch,
                         testing::Values(Switch{"FullToReducedSoft", 1, 0.3, btScalar(1e6)},
                                         Switch{"FullToReducedStiff", 1, 0.3, btScalar(1e7)},
                                         Switch{"FullToDirectSoft", 1, 0, btScalar(1e6)},
                                         Switch{"FullToDirectStiff", 1, 0, btScalar(1e7)},
                                         Switch{"ReducedToFullSoft", 0.3, 1, btScalar(1e6)},
                                         Switch{"ReducedToFullStiff", 0.3, 1, btScalar(1e7)},
                                         Switch{"DirectToFullSoft", 0, 1, btScalar(1e6)},
                                         Switch{"DirectToFullStiff", 0, 1, btScalar(1e7)}),
                         [](const auto& suite) { return std::string(suite.param.m_name); });

}  // namespace
}  // namespace bullet_fem
