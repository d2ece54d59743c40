// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

/// Sheets of one layer of cells, with their sides one over another. Staggered coupling only: the support is static.
class LargePatch : public testing::Test
{
protected:
    btSoftBody& addSheet(double side, int cells, double lowest)
    {
        const double cell = side / cells;
        const TetMesh mesh = makeBox({side, side, cell}, {cells, cells, 1}, {-side / 2, -side / 2, lowest});
        btSoftBody* sheet = btFemHelpers::createFromTetMesh(m_world.info(), mesh);
        btFemMaterial material;
        material.m_massDamping = 2;
        m_fem.setMaterial(sheet, material);
        return m_world.addSoft(sheet);
    }

    // Maximum depth of a body's nodes below a height [m]: under a flat rigid face that is the surface's maximum depth.
    static double depthUnder(const btSoftBody& body, double height) { return height - lowestHeight(body); }

    btFemSoftBodySolver m_fem;
    SoftWorld m_world{m_fem};
};

TEST_F(LargePatch, TwoThousandPointsOnAFloorCarryTheWeight)
{
    constexpr double kSide = 2;
    btRigidBody& floor = m_world.addFloorBox();
    btSoftBody& sheet = addSheet(kSide, 43, 0.0005);  // 44 x 44 = 1936 nodes below
    m_world.step(30);
    const double weight = massOf(sheet) * kGravity;
    int fewest = 10000;
    double deepest = 0, worstForce = 0;
    for (int k = 0; k < 30; ++k)
    {
        m_world.step();
        ASSERT_TRUE(allFinite(sheet));
        fewest = std::min(fewest, m_fem.stepReport(&sheet).m_contacts);
        deepest = std::max(deepest, depthUnder(sheet, 0));
        worstForce = std::max(worstForce, norm(vec3(m_fem.contactForce(&sheet, &floor)) - Vec3{0, 0, weight}) / weight);
    }
    EXPECT_GE(fewest, 1900);
    EXPECT_LT(deepest, 1e-3 * kSide);
    EXPECT_LT(worstForce, 0.01);
    EXPECT_EQ(m_fem.stepReport(&sheet).m_flags & BT_FEM_CONTACT_LIMIT, 0);
}

TEST_F(LargePatch, FiveHundredPointsBetweenTwoSheetsCarryTheWeight)
{
    constexpr double kSide = 1;
    constexpr int kCells = 22;  // 23 x 23 = 529 nodes a side
    btRigidBody& floor = m_world.addFloorBox();
    btSoftBody& lower = addSheet(kSide, kCells, 0.0005);
    btSoftBody& upper = addSheet(kSide, kCells, kSide / kCells + 0.001);
    m_world.step(60);
    const double weight = massOf(upper) * kGravity;
    int fewest = 10000;
    double deepest = 0, worstForce = 0, worstFloor = 0;
    for (int k = 0; k < 30; ++k)
    {
        m_world.step();
        ASSERT_TRUE(allFinite(lower) && allFinite(upper));
        fewest = std::min(fewest, m_fem.stepReport(&upper).m_contacts);
        deepest = std::max({deepest, depthUnder(lower, 0), double(m_fem.stepReport(&upper).m_deepestPenetration)});
        worstForce = std::max(worstForce, norm(vec3(m_fem.contactForce(&upper, &lower)) - Vec3{0, 0, weight}) / weight);
        worstFloor = std::max(worstFloor,
                              norm(vec3(m_fem.contactForce(&lower, &floor)) - Vec3{0, 0, 2 * weight}) / (2 * weight));
    }
    EXPECT_GE(fewest, 500);
    EXPECT_LT(deepest, 1e-3 * kSide);
    EXPECT_LT(worstForce, 0.01);
    EXPECT_LT(worstFloor, 0.01);
}

}  // namespace
}  // namespace bullet_fem
