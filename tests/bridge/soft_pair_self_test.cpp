// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
// Contact of a soft body with itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bridge/soft_pair_bodies.h"

namespace bullet_fem
{
namespace
{

class UndeformedBodies : public testing::TestWithParam<int>
{
protected:
    static TetMesh mesh(int k)
    {
        if (k == 0) return cube(4);
        if (k == 1) return makeSphere(0.5, 12);
        if (k == 2) return makeBox({2, 2, 0.1}, {20, 20, 1});
        if (k == 3) return makeBox({2, 2, 0.02}, {20, 20, 1});  // flat cells
        if (k == 4) return makeBox({1, 1, 0.3}, {3, 3, 3});     // three flat cells
        return makeCylinder(0.05, 2, 2, 40);
    }
};

TEST_P(UndeformedBodies, HaveNoSelfContact)
{
    PairBody body(mesh(GetParam()));
    EXPECT_TRUE(PairContacts(body, body).m_contacts.empty());
}

TEST_P(UndeformedBodies, HaveNoSelfContactUnderModerateDeformation)
{
    PairBody body(mesh(GetParam()));
    body.bend([](const Vec3& x) { return Vec3{std::sin(x.x) * (1 + x.z), x.y, (1 + x.z) * std::cos(x.x)}; });
    EXPECT_TRUE(PairContacts(body, body).m_contacts.empty());
    PairBody squeezed(mesh(GetParam()));
    squeezed.bend([](const Vec3& x) { return Vec3{1.3 * x.x, x.y, 0.6 * x.z}; });
    EXPECT_TRUE(PairContacts(squeezed, squeezed).m_contacts.empty());
}

INSTANTIATE_TEST_SUITE_P(Shapes, UndeformedBodies, testing::Range(0, 6));

// Folds a strip along x about x = 1 into two layers with inner faces `distance` apart, joined by a round fold.
Vec3 folded(const Vec3& X, double distance)
{
    const double r = 0.5 * distance, s = X.x - 1, half = 0.5 * 3.14159265358979 * r;
    if (s <= -half) return {s + half, X.y, X.z};
    const double roof = r - (X.z - 0.1);  // radius of this layer; the axis is r above the strip's top at z = 0.1
    const double angle = std::min(s + half, 2 * half) / r;
    const double beyond = std::max(0.0, s - half);
    return {roof * std::sin(angle) - beyond, X.y, 0.1 + r - roof * std::cos(angle)};
}

TEST(SelfPair, LayersOfAFoldedStripAreInContact)
{
    PairBody strip(makeBox({2, 0.3, 0.1}, {20, 3, 1}));
    for (double distance : {0.004, -0.004, -0.03})
    {
        PairBody body(makeBox({2, 0.3, 0.1}, {20, 3, 1}));
        // Two parallel layers: the far half is turned over onto the near one.
        body.bend([&](const Vec3& X) { return X.x <= 1 ? X : Vec3{2 - X.x + 0.03, X.y, 0.2 + distance - X.z}; });
        const PairContacts found(body, body);
        int between = 0;
        for (const ContactPoint& c : found.m_contacts)
        {
            EXPECT_NEAR(std::fabs(c.m_normal.z), 1, 1e-9);
            EXPECT_NEAR(c.m_gap, distance, 1e-9);
            ++between;
        }
        EXPECT_GE(between, 40) << distance;
    }
    strip.bend([](const Vec3& X) { return folded(X, 0.35); });
    EXPECT_TRUE(PairContacts(strip, strip).m_contacts.empty()) << "folded, but far apart";
}

// A slit narrower than an edge: its sides are close at rest, but far apart along the mesh.
TEST(SelfPair, ClosingSidesOfANarrowSlitAreInContact)
{
    // Without the cells around x = 0.55, from z = 0.2 upwards.
    PairBody body(without(makeBox({1, 0.2, 1}, {10, 2, 10}),
                          [](const Vec3& middle) { return middle.x > 0.5 && middle.x < 0.6 && middle.z > 0.2; }));
    EXPECT_TRUE(PairContacts(body, body).m_contacts.empty());
    body.bend([](const Vec3& x) { return x.x < 0.55 ? x + Vec3{0.099 * x.z, 0, 0} : x; });  // closes at the top
    const PairContacts found(body, body);
    EXPECT_GE(found.m_contacts.size(), 3u);
}

}  // namespace
}  // namespace bullet_fem
