// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Welds between fragments: their strength, and when they break.
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>

#include "plugin/breaking/welded_scene.h"
#include "plugin/scenes/each_world.h"

namespace bullet_fem
{
namespace
{

constexpr double kLimit = 2000;       // of the welds [N]
constexpr double kArea = 0.25;        // of the bar's section [m2]
constexpr double kRise = kLimit / 4;  // of the force [N/s]

/// Increases the force on a clamped bar until a weld breaks or `seconds` are over; returns the last force [N].
double pullUntilItBreaks(CutBoxScene& scene, double seconds = 6)
{
    double force = 0;
    for (int k = 0; k < 60 * seconds && scene.breaks().size() == 0; ++k)
    {
        force = kRise * (k + 1) / 60;
        scene.pull(force);
        scene.m_world.step();
    }
    return force;
}

CutBox clampedBar()
{
    CutBox bar;
    bar.m_isClampedLeft = true;
    bar.m_massDamping = 5;
    return bar;
}

class WeldedBar : public testing::TestWithParam<Coupling>
{
};

INSTANTIATE_TEST_SUITE_P(Solvers, WeldedBar, testing::Values(Coupling::swap, Coupling::coupled),
                         [](const auto& scene) { return couplingName(scene.param); });

TEST_P(WeldedBar, BreaksAtTheSetForce)
{
    CutBoxScene scene(clampedBar(), GetParam());
    btFemWeldStrength strength;
    strength.m_breakForce = btScalar(kLimit);
    ASSERT_EQ(scene.weld(strength), 1);
    const double force = pullUntilItBreaks(scene);
    ASSERT_EQ(scene.breaks().size(), 1);
    const btFemWeldBreak event = scene.breaks()[0];
    EXPECT_NEAR(force, kLimit, 0.02 * kLimit);
    EXPECT_NEAR(double(event.m_force.x()), kLimit, 0.02 * kLimit);
    EXPECT_GT(double(event.m_force.length()), kLimit);
    EXPECT_EQ(event.m_a, scene.m_pieces[0].m_body);
    EXPECT_EQ(event.m_b, scene.m_pieces[1].m_body);
    EXPECT_EQ(event.m_broken, 9);
    EXPECT_EQ(event.m_left, 0);
    EXPECT_NEAR(double(event.m_time), force / kRise, 1e-3);
    EXPECT_TRUE(scene.welds().empty());
    const double before = centerOf(*scene.m_pieces[1].m_body).x;
    for (int k = 0; k < 30; ++k) scene.pull(force), scene.m_world.step();
    EXPECT_GT(centerOf(*scene.m_pieces[1].m_body).x, before + 0.1);  // it flies off
    EXPECT_EQ(scene.breaks().size(), 1);
    btFemWelds::clearBreaks(scene.m_fem);
    EXPECT_EQ(scene.breaks().size(), 0);
}

// With a Poisson's ratio of 0 the stress is uniform over the section.
TEST_P(WeldedBar, TearsAtTheSetStress)
{
    CutBoxScene scene(clampedBar(), GetParam());
    btFemWeldStrength strength;
    strength.m_breakStress = btScalar(kLimit / kArea);
    scene.weld(strength);
    EXPECT_NEAR(pullUntilItBreaks(scene), kLimit, 0.02 * kLimit);
    ASSERT_GT(scene.breaks().size(), 0);
    EXPECT_NEAR(double(scene.breaks()[0].m_stress), kLimit / kArea, 0.02 * kLimit / kArea);
    scene.pull(kLimit);
    scene.m_world.step();
    EXPECT_TRUE(scene.welds().empty());  // a weld that fails overloads the next ones
}

TEST_P(WeldedBar, StretchesGlueByItsComplianceAndTearsItAtItsStretch)
{
    CutBoxScene scene(clampedBar(), GetParam());
    btFemWeldStrength strength;
    strength.m_compliance = btScalar(1e-6);
    strength.m_breakStretch = btScalar(1e-6 * kLimit / kArea);
    scene.weld(strength);
    for (int k = 0; k < 120; ++k) scene.pull(kLimit / 2), scene.m_world.step();
    ASSERT_EQ(scene.welds().size(), 1u);
    EXPECT_NEAR(double(scene.welds()[0].m_stretch), 1e-6 * kLimit / 2 / kArea, 0.01 * 1e-6 * kLimit / 2 / kArea);
    const double force = pullUntilItBreaks(scene);
    EXPECT_NEAR(force, kLimit, 0.02 * kLimit);
}

TEST_P(WeldedBar, DoesNotBreakUnderPressure)
{
    CutBoxScene scene(clampedBar(), GetParam());
    btFemWeldStrength strength;
    strength.m_breakStress = btScalar(0.2 * kLimit / kArea);
    scene.weld(strength);
    for (int k = 0; k < 120; ++k) scene.pull(-kLimit * std::min(1.0, k / 60.0)), scene.m_world.step();
    EXPECT_EQ(scene.breaks().size(), 0);
    ASSERT_EQ(scene.welds().size(), 1u);
    EXPECT_NEAR(double(scene.welds()[0].m_force.x()), -kLimit, 0.02 * kLimit);
    EXPECT_LT(double(scene.welds()[0].m_stress), 0.05 * kLimit / kArea);
}

TEST_P(WeldedBar, CarriesTheLoadBelowAWeld)
{
    CutBox bar = clampedBar();
    bar.m_slices = 4;
    CutBoxScene scene(bar, GetParam());
    scene.m_world.setSoftGravity({btScalar(kGravity), 0, 0});  // along the bar
    EXPECT_EQ(scene.weld(), 3);
    scene.m_world.step(300);
    ASSERT_EQ(scene.welds().size(), 3u);
    for (int k = 0; k < 3; ++k)
    {
        const double weight = 1000 * 0.5 * kArea * kGravity * (3 - k);
        EXPECT_NEAR(double(scene.welds()[k].m_force.x()), weight, 1e-3 * weight);
        EXPECT_NEAR(double(scene.welds()[k].m_area), kArea, 1e-6);
        EXPECT_EQ(scene.welds()[k].m_nodes, 9);
    }
}

struct BendingCase
{
    Coupling m_coupling;
    int m_slices, m_voronoi;
    double m_band;
};

class WeldedBeam : public testing::TestWithParam<BendingCase>
{
};

double lowestTip(const CutBoxScene& scene)
{
    double lowest = 1e30;
    for (const btFemPiece& piece : scene.m_pieces) lowest = std::min(lowest, lowestHeight(*piece.m_body));
    return lowest;
}

// Welds add no stiffness: the mesh is that of the whole, and so is its bending.
TEST_P(WeldedBeam, BendsAsTheWhole)
{
    CutBox bar = clampedBar();
    bar.m_cells = {12, 3, 3};
    bar.m_poissonRatio = btScalar(0.3);
    bar.m_slices = 1;
    CutBoxScene whole(bar, GetParam().m_coupling, kGravity);
    bar.m_slices = GetParam().m_slices;
    bar.m_voronoi = GetParam().m_voronoi;
    CutBoxScene pieces(bar, GetParam().m_coupling, kGravity);
    EXPECT_GT(pieces.weld(), 0);
    whole.m_world.step(240);
    pieces.m_world.step(240);
    const double bent = -0.25 - lowestTip(whole);
    EXPECT_GT(bent, 0.1);
    EXPECT_NEAR(-0.25 - lowestTip(pieces), bent, GetParam().m_band * bent);
    EXPECT_LT(pieces.fastest(), 1e-3);
    EXPECT_EQ(pieces.contacts(), 0);
}

INSTANTIATE_TEST_SUITE_P(Cuts, WeldedBeam,
                         testing::Values(BendingCase{Coupling::swap, 2, 0, 1e-3},
                                         BendingCase{Coupling::swap, 6, 0, 1e-3},
                                         BendingCase{Coupling::swap, 0, 12, 1e-3},
                                         BendingCase{Coupling::coupled, 0, 12, 1e-3}),
                         [](const auto& cut)
                         {
                             return std::string(couplingName(cut.param.m_coupling)) + "_" +
                                    (cut.param.m_slices > 0 ? std::to_string(cut.param.m_slices) + "slices"
                                                            : std::to_string(cut.param.m_voronoi) + "cells");
                         });

// Coincident faces do not push fragments apart.
TEST(Welds, KeepFragmentsAtRestWithoutContactUntilTheyBreak)
{
    CutBox box;
    box.m_slices = 0;
    box.m_voronoi = 8;
    CutBoxScene scene(box);
    scene.weld();
    scene.m_world.step(60);
    EXPECT_LT(scene.fastest(), 1e-6);
    EXPECT_EQ(scene.contacts(), 0);
    for (const btFemWeldReport& weld : scene.welds())
        scene.m_fem.detach(const_cast<btSoftBody*>(weld.m_a), weld.m_weld);
    EXPECT_TRUE(scene.welds().empty());
    scene.m_world.step(60);
    EXPECT_LT(scene.fastest(), 1e-3);
    EXPECT_GT(scene.contacts(), 0);
}

// A bar bent into a hairpin, with its ends one upon another.
TEST(Welds, MakeFragmentsOneBodyWithOptionalSelfContact)
{
    for (const bool mayTouchItself : {false, true})
    {
        CutBox box;
        box.m_slices = 0;
        box.m_voronoi = 8;
        CutBoxScene scene(box);
        for (const btFemPiece& piece : scene.m_pieces)
            if (mayTouchItself) piece.m_body->m_cfg.collisions |= btSoftBody::fCollision::CL_SELF;
        scene.weld();
        btSoftBody& left = *scene.m_pieces[0].m_body;
        btSoftBody* right = nullptr;  // any fragment not welded to it
        for (const btFemPiece& piece : scene.m_pieces)
        {
            bool isWelded = piece.m_body == &left;
            for (const btFemWeldReport& weld : scene.welds())
                isWelded = isWelded || (weld.m_a == &left && weld.m_b == piece.m_body) ||
                           (weld.m_b == &left && weld.m_a == piece.m_body);
            if (!isWelded) right = piece.m_body;
        }
        ASSERT_NE(right, nullptr);
        const Vec3 way = centerOf(left) - centerOf(*right);
        right->translate(btVector3(btScalar(0.7 * way.x), btScalar(way.y), btScalar(way.z)));
        scene.m_world.step(2);
        EXPECT_EQ(scene.contacts() > 0, mayTouchItself);
    }
}

TEST(Welds, BrokenWeldsLetFragmentsCollide)
{
    CutBox box;
    CutBoxScene scene(box);
    btFemWeldStrength strength;
    strength.m_breakForce = 1000;
    scene.weld(strength);
    for (int side = 0; side < 2; ++side)  // separating at 1 m/s each
    {
        btSoftBody& body = *scene.m_pieces[side].m_body;
        body.setVelocity({btScalar(2 * side - 1), 0, 0});
    }
    scene.m_world.step(20);
    ASSERT_EQ(scene.breaks().size(), 1);
    EXPECT_LT(norm(scene.motion().m_linear), 1e-3);
    for (int side = 0; side < 2; ++side)
        for (int i = 0; i < scene.m_pieces[side].m_body->m_nodes.size(); ++i)
            scene.m_pieces[side].m_body->m_nodes[i].m_v = {btScalar(1 - 2 * side), 0, 0};
    scene.m_world.step(60);
    EXPECT_LT(centerOf(*scene.m_pieces[0].m_body).x, -0.4);  // they were in contact and did not pass through
    EXPECT_GT(centerOf(*scene.m_pieces[1].m_body).x, 0.4);
    EXPECT_LT(norm(scene.motion().m_linear), 1e-3);
}

TEST(Welds, AreRejectedForBadInput)
{
    CutBoxScene scene({});
    btSoftBody &a = *scene.m_pieces[0].m_body, &b = *scene.m_pieces[1].m_body;
    const btScalar inf = std::numeric_limits<btScalar>::infinity(), nan = std::numeric_limits<btScalar>::quiet_NaN();
    std::string why;
    const auto refuses = [&](const btFemWeldStrength& strength, const std::string& name)
    {
        why.clear();
        return btFemWelds::weld(scene.m_fem, &a, &b, strength, 0, &why) == 0 && why.find(name) != std::string::npos;
    };
    for (const btScalar bad : {btScalar(0), btScalar(-1), nan})
    {
        EXPECT_TRUE(refuses({bad, inf, inf, 0}, "m_breakForce")) << why;
        EXPECT_TRUE(refuses({inf, bad, inf, 0}, "m_breakStress")) << why;
        EXPECT_TRUE(refuses({inf, inf, bad, 0}, "m_breakStretch")) << why;
    }
    for (const btScalar bad : {btScalar(2), btScalar(-1), nan})
        EXPECT_TRUE(refuses({inf, inf, inf, bad}, "m_compliance")) << why;
    EXPECT_TRUE(scene.welds().empty());
    EXPECT_EQ(btFemWelds::weld(scene.m_fem, &a, &a, {}, 0, &why), 0);
    EXPECT_NE(why.find("itself"), std::string::npos) << why;
    EXPECT_EQ(btFemWelds::weld(scene.m_fem, &a, &b, {}, -1, &why), 0);
    EXPECT_NE(why.find("reach is -1"), std::string::npos) << why;
    EXPECT_THROW(btFemWelds::weld(scene.m_fem, &a, nullptr, {}), std::invalid_argument);
    EXPECT_THROW(btFemWelds::weld(scene.m_fem, scene.m_whole.get(), &b, {}), std::invalid_argument);
    btFemPiece none;
    EXPECT_EQ(btFemWelds::weldPieces(scene.m_fem, {none}, {}, &why), 0);
    EXPECT_NE(why.find("prepare()"), std::string::npos) << why;
    EXPECT_EQ(btFemWelds::weldPieces(scene.m_fem, {scene.m_pieces[0], scene.m_pieces[0]}, {}, &why), 0);
    EXPECT_NE(why.find("twice"), std::string::npos) << why;
    EXPECT_EQ(scene.weld(), 1);
    EXPECT_EQ(btFemWelds::weld(scene.m_fem, &b, &a, {}, 0, &why), 0);
    EXPECT_NE(why.find("welded already"), std::string::npos) << why;
    EXPECT_THROW(scene.weld(), std::invalid_argument);
    b.translate({btScalar(0.01), 0, 0});
    scene.m_fem.detach(&a, scene.welds()[0].m_weld);
    scene.m_world.step();  // the solver reads where b is
    EXPECT_EQ(btFemWelds::weld(scene.m_fem, &a, &b, {}, 0, &why), 0);
    EXPECT_NE(why.find("no face in common"), std::string::npos) << why;
    EXPECT_GT(btFemWelds::weld(scene.m_fem, &a, &b, {}, btScalar(0.02), &why), 0) << why;
    btAlignedObjectArray<btFemWeldReport> reports;
    EXPECT_FALSE(btFemWelds::welds(scene.m_fem, nullptr, reports));
    EXPECT_FALSE(btFemWelds::welds(scene.m_fem, scene.m_whole.get(), reports));
}

TEST(Welds, EndWithTheOtherBody)
{
    CutBoxScene scene({});
    scene.weld();
    scene.m_world.step(2);
    scene.m_world.deleteSoft(*scene.m_pieces[1].m_body);
    scene.m_pieces.pop_back();
    scene.m_world.step(2);
    EXPECT_TRUE(scene.welds().empty());
    EXPECT_EQ(scene.breaks().size(), 0);
}

class WeldsInWorld : public EachWorld
{
};

TEST_P(WeldsInWorld, BreakAtTheSetForce)
{
    CutBoxScene scene(clampedBar(), Coupling::swap, 0, implicitEuler(), GetParam());
    btFemWeldStrength strength;
    strength.m_breakForce = btScalar(kLimit);
    scene.weld(strength);
    EXPECT_NEAR(pullUntilItBreaks(scene), kLimit, 0.02 * kLimit);
    EXPECT_EQ(scene.breaks().size(), 1);
}

INSTANTIATE_TEST_SUITE_P(Worlds, WeldsInWorld, eachWorld(), nameOfWorld);

}  // namespace
}  // namespace bullet_fem
