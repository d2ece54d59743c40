// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/soft/soft_pair_finder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "bridge/soft_pair_bodies.h"

namespace bullet_fem
{
namespace
{

Vec3 at(const std::vector<Vec3>& x, const SurfacePoint& p)
{
    return p.m_weights[0] * x[p.m_nodes[0]] + p.m_weights[1] * x[p.m_nodes[1]] + p.m_weights[2] * x[p.m_nodes[2]];
}

TEST(SoftPairFinder, NodesOfEitherCubeContactTheOthersFace)
{
    PairBody upper(cube(3)), lower(cube(2));
    upper.move({0.2, 0.3, 1.001});
    const PairContacts found(upper, lower);
    EXPECT_EQ(found.count(SoftPairKind::nodeOfFirst), 9) << "3 x 3 of 4 x 4 nodes are over the lower cube";
    EXPECT_EQ(found.count(SoftPairKind::nodeOfSecond), 4);
    EXPECT_EQ(found.count(SoftPairKind::edges), 2) << "where the rims cross";
    expectAlongZ(found, 0.001);
    for (const ContactPoint& c : found.m_contacts)
    {
        const Vec3 a = at(c.m_soft.m_body ? lower.m_x : upper.m_x, c.m_soft);
        const Vec3 b = at(c.m_other.m_body ? lower.m_x : upper.m_x, c.m_other);
        EXPECT_LT(norm(a - b - c.m_gap * c.m_normal), kExact);
        EXPECT_LT(norm(0.5 * (a + b) - c.m_point), kExact);
    }
}

class FlushCubes : public testing::TestWithParam<Vec3>
{
};

TEST_P(FlushCubes, HoldEachOtherUpAndDoNotSqueezeEachOtherAside)
{
    PairBody upper(cube()), lower(cube());
    upper.move(Vec3{0, 0, 1} + GetParam());
    const PairContacts found(upper, lower);
    EXPECT_EQ(found.m_contacts.size(), 9u) << "every pair of nodes once";
    expectAlongZ(found, GetParam().z);
}

INSTANTIATE_TEST_SUITE_P(Offsets, FlushCubes,
                         testing::Values(Vec3{0, 0, 0}, Vec3{1e-7, 0, -1e-6}, Vec3{-1e-6, 1e-7, -1e-7},
                                         Vec3{1e-7, 1e-7, 1e-6}, Vec3{0, -1e-5, -1e-3}, Vec3{1e-5, 0, 1e-3}));

TEST(SoftPairFinder, TheGapOfATipIsExactOnBothSidesOfTheFace)
{
    for (double gap : {0.01, 1e-6, -1e-6, -0.01, -0.2})
    {
        PairBody tip(uprightTip());
        PairBody block(cube());
        tip.move({0, 0, 1 + gap});
        const PairContacts found(tip, block);
        ASSERT_EQ(found.m_contacts.size(), 1u) << gap;
        expectAlongZ(found, gap);
        EXPECT_EQ(found.m_contacts[0].m_soft.m_body, 0);
        EXPECT_EQ(found.m_contacts[0].m_other.m_body, 1);
        EXPECT_EQ(found.m_contacts[0].m_rigidProxy, -1);
    }
}

// The bodies have no relative velocity, but the ground may stop the lower one.
TEST(SoftPairFinder, SmallBodiesContactIfGravityClosesTheGapInAStep)
{
    const double fall = 10.0 / (60 * 60), edgeOfUnitCube = cube().meanEdgeLength();  // [m], [-]
    const auto countAt = [&](double gap, double fallPerEdge)
    {
        const double size = fall / (fallPerEdge * edgeOfUnitCube);
        PairBody upper(makeBox({size, size, size}, {2, 2, 2})), lower(makeBox({size, size, size}, {2, 2, 2}));
        upper.move({0, 0, size + gap});
        return PairContacts(upper, lower).m_contacts.size();
    };
    EXPECT_EQ(countAt(0.9 * fall, 4), 9u);
    EXPECT_EQ(countAt(0.9 * fall, 0.26), 9u) << "a quarter of an edge is far";
    EXPECT_EQ(countAt(0.9 * fall, 0.24), 0u);
    EXPECT_EQ(countAt(1.1 * fall, 4), 0u) << "a contact band above";
}

TEST(SoftPairFinder, ATipNearTheFarSideOfAThinPlateIsNotDeepInside)
{
    PairBody tip(uprightTip());
    PairBody plate(makeBox({1, 1, 0.05}, {4, 4, 1}, {0, 0, -0.05}));
    tip.move({0, 0, 0.002});
    const PairContacts above(tip, plate);
    ASSERT_EQ(above.m_contacts.size(), 1u);
    expectAlongZ(above, 0.002);
}

TEST(SoftPairFinder, FindsExactlyTheContactsClosingWithinTheStep)
{
    PairBody upper(cube()), lower(cube());
    upper.move({0.1, 0.1, 1.1});
    EXPECT_TRUE(PairContacts(upper, lower).m_contacts.empty());
    upper.throwAt({0, 0, -10});  // 0.17 m a step
    lower.throwAt({0, 0, -3});
    const PairContacts closing(upper, lower);
    EXPECT_GE(closing.m_contacts.size(), 8u);
    expectAlongZ(closing, 0.1);
    lower.throwAt({0, 0, -11});  // moves away
    EXPECT_TRUE(PairContacts(upper, lower).m_contacts.empty());
    // A common velocity does not matter.
    upper.throwAt({300, 0, -10});
    lower.throwAt({300, 0, -3});
    EXPECT_EQ(PairContacts(upper, lower).m_contacts.size(), closing.m_contacts.size());
}

TEST(SoftPairFinder, FastBodiesMeetThinPlatesManyThicknessesAway)
{
    PairBody ball(makeSphere(0.1, 4)), plate(makeBox({1, 1, 0.01}, {5, 5, 1}, {-0.5, -0.5, -0.01}));
    ball.move({0.03, 0.02, 0.25}).throwAt({3, 0, -40});  // 0.67 m a step
    const PairContacts found(ball, plate);
    EXPECT_GE(found.count(SoftPairKind::nodeOfFirst), 25) << "the lower half of the ball's nodes";
    for (const ContactPoint& c : found.m_contacts)
    {
        EXPECT_NEAR(std::fabs(c.m_normal.z), 1, kExact);
        EXPECT_GT(c.m_gap, 0);
        EXPECT_NEAR(c.m_gap,
                    at(c.m_soft.m_body ? plate.m_x : ball.m_x, c.m_soft).z -
                        at(c.m_other.m_body ? plate.m_x : ball.m_x, c.m_other).z,
                    kExact);
    }
    ball.throwAt({40, 0, -3});  // flies past
    EXPECT_TRUE(PairContacts(ball, plate).m_contacts.empty());
}

// Both orders of the pair find equal points.
TEST(SoftPairFinder, ExchangingTheBodiesChangesTheOrderOnly)
{
    PairBody a(makeSphere(0.5, 6)), b(makeSphere(0.4, 4));
    b.turn(testRotation(1, 2, 3)).move({0.3, 0.3, 0.76});
    const PairContacts ab(a, b), ba(b, a);
    ASSERT_EQ(ab.m_contacts.size(), ba.m_contacts.size());
    ASSERT_GE(ab.m_contacts.size(), 6u);
    for (const ContactPoint& c : ab.m_contacts)
        EXPECT_EQ(
            std::count_if(ba.m_contacts.begin(), ba.m_contacts.end(),
                          [&](const ContactPoint& d)
                          { return norm(c.m_point - d.m_point) < kExact && std::fabs(c.m_gap - d.m_gap) < kExact; }),
            1);
}

class PlacedPairs : public testing::TestWithParam<int>
{
};

// A pair that is rotated and moved 100 m away has equal contacts.
TEST_P(PlacedPairs, HaveTheSameContactPoints)
{
    PairBody a(makeSphere(0.5, 6)), b(cube(3));
    b.turn(testRotation(0.3, 0.2, 0.1)).move({-0.5, -0.45, 0.37});
    b.throwAt({0, 0, -1});
    const PairContacts here(a, b);
    const double seed = GetParam();
    const Mat3 R = testRotation(seed, 2.1 * seed, 0.7 * seed);
    const Vec3 away = {100, -50 * seed, 30};
    a.turn(R).move(away);
    b.turn(R).move(away);
    const PairContacts there(a, b);
    ASSERT_EQ(here.m_contacts.size(), there.m_contacts.size());
    ASSERT_GE(here.m_contacts.size(), 5u);
    for (std::size_t k = 0; k < here.m_contacts.size(); ++k)
    {
        EXPECT_NEAR(here.m_contacts[k].m_gap, there.m_contacts[k].m_gap, 1e-12) << "100 m resolve 1.4e-14 m";
        EXPECT_LT(norm(R * here.m_contacts[k].m_normal - there.m_contacts[k].m_normal), 1e-11);
        EXPECT_EQ(here.m_origins[k].m_feature, there.m_origins[k].m_feature);
    }
}

INSTANTIATE_TEST_SUITE_P(Turns, PlacedPairs, testing::Values(1, 2, 3));

// The sum of the solid angles of all triangles is 4 pi inside [van Oosterom and Strackee 1983].
bool isInside(const SoftSurface& surface, const Vec3& p)
{
    double sum = 0;
    for (const Triangle& t : surface.topology().triangles())
    {
        const Vec3 a = surface.position()[t[0]] - p, b = surface.position()[t[1]] - p, c = surface.position()[t[2]] - p;
        const double A = norm(a), B = norm(b), C = norm(c);
        sum += 2 * std::atan2(dot(a, cross(b, c)), A * B * C + dot(a, b) * C + dot(b, c) * A + dot(c, a) * B);
    }
    return sum > 6;
}

double signedDistance(const SoftSurface& surface, const Vec3& p)
{
    double least = 1e9;
    for (std::size_t t = 0; t < surface.topology().triangles().size(); ++t)
        least = std::min(least, norm(p - nearestOnTriangle(surface.tree().corners(static_cast<int>(t)), p).m_point));
    return isInside(surface, p) ? -least : least;
}

// The oracle is a search over all pairs: nodes of two overlapping balls within the band or inside.
TEST(SoftPairFinder, MatchesBruteForceOverAllPairs)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (int scene = 0; scene < 20; ++scene)
    {
        PairBody a(makeSphere(0.5, 8)), b(makeSphere(0.4, 6));
        const Vec3 direction = {uniform(random), uniform(random), uniform(random)};
        b.turn(testRotation(3 * uniform(random), 3 * uniform(random), 3 * uniform(random)));
        b.move((0.8 / norm(direction)) * direction);
        const PairContacts found(a, b);
        const double band = 0.05 * std::min(a.m_fem.m_surface.meanEdge(), b.m_fem.m_surface.meanEdge());
        int expected = 0;
        for (int i : b.m_fem.m_surface.topology().vertices())
        {
            const double distance = signedDistance(a.m_fem.m_surface, b.m_x[i]);
            if (distance > 0.99 * band) continue;
            ++expected;
            double nearest = 1e9;
            for (std::size_t k = 0; k < found.m_contacts.size(); ++k)
                if (found.m_origins[k].m_kind == SoftPairKind::nodeOfSecond && found.m_origins[k].m_feature == i)
                    nearest = std::min(nearest, std::fabs(found.m_contacts[k].m_gap - distance));
            EXPECT_LT(nearest, 1e-2 * std::fabs(distance) + kExact) << "mean normals of nearly flat edges";
        }
        EXPECT_GT(expected, 3);
    }
}

TEST(SoftPairFinder, MaterialsOfBothMakeTheContact)
{
    PairBody upper(cube()), lower(cube());
    upper.move({0.1, 0.1, 1});
    upper.m_soft->m_cfg.kDF = btScalar(0.25);
    lower.m_soft->m_cfg.kDF = btScalar(0.75);
    upper.m_soft->setRestitution(btScalar(0.5));
    lower.m_soft->setRestitution(btScalar(0.25));
    upper.m_soft->m_cfg.kSHR = btScalar(0.5);
    upper.m_fem.m_settings.m_contactOffset = 0.01;
    const PairContacts found(upper, lower);
    ASSERT_FALSE(found.m_contacts.empty());
    for (const ContactPoint& c : found.m_contacts)
    {
        EXPECT_EQ(c.m_friction, 0.75);
        EXPECT_EQ(c.m_restitution, 0.125);
        EXPECT_EQ(c.m_hardness, 0.5);
        EXPECT_NEAR(c.m_gap, -0.01, kExact);
    }
    upper.m_soft->m_cfg.kDF = lower.m_soft->m_cfg.kDF = -1;
    EXPECT_EQ(PairContacts(upper, lower).m_contacts[0].m_friction, 0);
}

TEST(SoftPairFinder, KeepsTheDeepestOfTheContactsThinnedToTheLimit)
{
    PairBody upper(cube()), lower(cube());
    upper.turn(testRotation(0, 0.01, 0)).move({0.1, 0.1, 1});
    const PairContacts all(upper, lower), some(upper, lower, 3);
    EXPECT_TRUE(some.m_report.m_limited);
    ASSERT_LE(some.m_contacts.size(), 3u);
    const auto deepestOf = [](const PairContacts& found)
    {
        double least = 1;
        for (const ContactPoint& c : found.m_contacts) least = std::min(least, c.m_gap);
        return least;
    };
    EXPECT_EQ(deepestOf(some), deepestOf(all));
}

TEST(SoftPairFinder, TakesOverTheImpulsesOfTheLastStepToTheNextFace)
{
    PairBody upper(cube()), lower(cube(4));
    upper.move({0.1, 0.1, 1});
    PairContacts found(upper, lower);
    for (std::size_t k = 0; k < found.m_contacts.size(); ++k) found.m_contacts[k].m_impulse = {0, 0, 1.0 + double(k)};
    const std::vector<ContactPoint> before = found.m_contacts;
    const std::vector<SoftPairOrigin> origins = found.m_origins;
    EXPECT_TRUE(std::is_sorted(origins.begin(), origins.end()));
    found.m_memory.remember({before.data(), origins.data(), before.size()});
    found.m_memory.beginStep();
    upper.move({0.21, 0, 0}).ready();  // now the nodes are over other triangles
    found.m_contacts.clear();
    found.m_origins.clear();
    found.m_finder.find({upper.m_fem, 0}, {lower.m_fem, 1}, 1000, found.m_contacts, found.m_origins);
    int taken = 0;
    double sum = 0, sumBefore = 0;  // over the first body
    const auto onFirst = [](const ContactPoint& c, const SoftPairOrigin& origin)
    { return origin.m_kind == SoftPairKind::nodeOfSecond ? -c.m_impulse.z : c.m_impulse.z; };
    for (std::size_t k = 0; k < before.size(); ++k) sumBefore += onFirst(before[k], origins[k]);
    for (std::size_t k = 0; k < found.m_contacts.size(); ++k)
    {
        const SoftPairOrigin& now = found.m_origins[k];
        const auto isSame = [&](const SoftPairOrigin& last)
        {
            return last.m_kind == now.m_kind && last.m_feature == now.m_feature &&
                   (last.m_kind != SoftPairKind::edges || last.m_otherFeature == now.m_otherFeature);
        };
        const auto last = std::find_if(origins.begin(), origins.end(), isSame);
        sum += onFirst(found.m_contacts[k], now);
        if (last == origins.end()) continue;
        // Its own impulse, and the impulses of lost contacts near it.
        const double own = before[last - origins.begin()].m_impulse.z;
        taken += found.m_contacts[k].m_impulse.z == own ? 1 : 0;
    }
    EXPECT_GE(taken, 4);
    EXPECT_NEAR(sum, sumBefore, 1e-12);
    const std::vector<ContactPoint> once = found.m_contacts;
    found.m_contacts.clear();
    found.m_finder.find({upper.m_fem, 0}, {lower.m_fem, 1}, 1000, found.m_contacts, found.m_origins);
    ASSERT_EQ(found.m_contacts.size(), once.size());
    for (std::size_t k = 0; k < once.size(); ++k)
        EXPECT_EQ(found.m_contacts[k].m_impulse.z, once[k].m_impulse.z) << "a pair may be searched twice in a step";
}

TEST(SoftPairFinder, CollapsedAndNonFiniteSurfacesGiveNoNonFiniteContacts)
{
    PairBody body(cube()), flat(cube()), point(cube()), broken(cube());
    flat.bend([](const Vec3& x) { return Vec3{x.x, x.y, 1}; });
    point.bend([](const Vec3&) { return Vec3{0.3, 0.3, 1}; });
    broken.move({0, 0, 1});
    broken.m_x[3].x = std::numeric_limits<double>::quiet_NaN();
    broken.m_v[5].y = std::numeric_limits<double>::infinity();
    int checked = 0;
    for (PairBody* other : {&flat, &point, &broken})
        for (const PairContacts& found : {PairContacts(body, *other), PairContacts(*other, *other)})
            for (const ContactPoint& c : found.m_contacts)
            {
                EXPECT_TRUE(isFinite(c.m_normal) && isFinite(c.m_point) && std::isfinite(c.m_gap));
                EXPECT_NEAR(norm(c.m_normal), 1, 1e-9);
                ++checked;
            }
    EXPECT_GT(checked, 9) << "the flat body's and the broken one's";
}

}  // namespace
}  // namespace bullet_fem
