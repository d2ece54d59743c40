// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Factors of baked bodies are used without factoring again.
#include <gtest/gtest.h>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/baked/baked_body.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/baked_bodies.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

class BakedBodies : public testing::Test
{
protected:
    BakedBodies()
    {
        m_settings.m_material = {3e5, 0.37, 900, 0.01, 0.003};
        m_settings.m_singlePrecision = kSingle;
        m_settings.m_step = static_cast<double>(kStep);
    }

    /// A box of 0.6 m, slightly above the ground and off the world's origin.
    static TetMesh box() { return makeBox({0.6, 0.5, 0.4}, {4, 4, 3}, {0.1, -0.7, 0.05}); }

    BakedBody bakedBox() const { return throughAFile(bakeBody(box(), m_settings)); }

    btSoftBody& addBaked(const BakedBody& baked)
    {
        btSoftBody* body = btFemHelpers::createFromBaked(m_world.info(), baked);
        m_fem.useBaked(body, baked);
        return m_world.addSoft(body);
    }

    bool has(const btSoftBody& body, int flag) const { return (m_fem.stepReport(&body).m_flags & flag) != 0; }

    BakeSettings m_settings;
    btFemSoftBodySolver m_fem;
    SoftWorld m_world{m_fem};
};

TEST_F(BakedBodies, ShareTheirFactor)
{
    const BakedBody baked = bakedBox(), again = bakedBox();
    btSoftBody &a = addBaked(baked), &b = addBaked(again);
    b.translate(btVector3(3, 0, 0));
    btSoftBody* plain = btFemHelpers::createFromTetMesh(m_world.info(), box());
    plain->translate(btVector3(6, 0, 0));
    m_fem.setMaterial(plain, bulletMaterial(m_settings.m_material));
    m_world.addSoft(plain);
    m_world.step(2);
    for (const btSoftBody* body : std::initializer_list<const btSoftBody*>{&a, &b, plain})
        EXPECT_TRUE(m_fem.stepReport(body).m_bakedFactor);
}

TEST_F(BakedBodies, AreUsedInTheOtherPrecision)
{
    m_settings.m_singlePrecision = !kSingle;
    btSoftBody& body = addBaked(bakedBox());
    m_world.addPlane();
    m_world.step(60);
    EXPECT_TRUE(m_fem.stepReport(&body).m_bakedFactor);
    EXPECT_FALSE(has(body, BT_FEM_STALE_FACTOR));
    EXPECT_TRUE(allFinite(body));
}

/// The body is set up differently from the baked one.
class StaleBakedFactor : public BakedBodies
{
protected:
    void expectStaleButUsed(const btSoftBody& body)
    {
        m_world.step();
        EXPECT_TRUE(m_fem.isFem(&body));
        EXPECT_TRUE(m_fem.stepReport(&body).m_bakedFactor);
        EXPECT_TRUE(has(body, BT_FEM_STALE_FACTOR));
        EXPECT_FALSE(has(body, BT_FEM_NOT_CONVERGED | BT_FEM_BREAKDOWN | BT_FEM_BAKED_UNUSED));
        EXPECT_LE(m_fem.stepReport(&body).m_residual, btScalar(1e-3));
    }
    void expectFreshWhenRefactored(btSoftBody& body)
    {
        m_fem.refactor(&body);
        m_world.step();
        EXPECT_FALSE(has(body, BT_FEM_STALE_FACTOR));
        EXPECT_FALSE(m_fem.stepReport(&body).m_bakedFactor);
    }
};

TEST_F(StaleBakedFactor, IsUsedForAnotherStep)
{
    m_settings.m_step = 1.0 / 100;
    btSoftBody& body = addBaked(bakedBox());
    expectStaleButUsed(body);
    expectFreshWhenRefactored(body);
}

TEST_F(StaleBakedFactor, IsUsedForOtherMasses)
{
    btSoftBody& body = addBaked(bakedBox());
    body.setTotalMass(2 * body.getTotalMass());
    expectStaleButUsed(body);
    expectFreshWhenRefactored(body);
}

TEST_F(StaleBakedFactor, IsUsedForOtherPins)
{
    btSoftBody& body = addBaked(bakedBox());
    body.m_nodes[3].m_im = 0;
    const btVector3 place = body.m_nodes[3].m_x;
    expectStaleButUsed(body);
    EXPECT_EQ(body.m_nodes[3].m_x, place);
    expectFreshWhenRefactored(body);
}

TEST_F(StaleBakedFactor, IsUsedForARemovedPin)
{
    m_settings.m_pins = {3};
    const BakedBody baked = bakedBox();
    btSoftBody& body = addBaked(baked);
    EXPECT_EQ(body.m_nodes[3].m_im, 0);
    body.m_nodes[3].m_im = static_cast<btScalar>(baked.m_inverseMass[3]);
    const btVector3 place = body.m_nodes[3].m_x;
    expectStaleButUsed(body);
    EXPECT_LT(body.m_nodes[3].m_x.z(), place.z());
    expectFreshWhenRefactored(body);
}

TEST_F(StaleBakedFactor, IsUsedForAnotherMaterial)
{
    btSoftBody& body = addBaked(bakedBox());
    Material stiffer = m_settings.m_material;
    stiffer.m_youngModulus *= 2;
    m_fem.setMaterial(&body, bulletMaterial(stiffer));
    expectStaleButUsed(body);
    expectFreshWhenRefactored(body);
}

TEST_F(StaleBakedFactor, GivesTheMotionOfAFreshOne)
{
    btFemSolverInfo info = implicitEuler();
    info.m_tolerance = btScalar(1e-6);
    btFemSoftBodySolver fem(info), plainFem(info);
    SoftWorld world(fem), plainWorld(plainFem);
    m_settings.m_pins = {0, 1, 2, 3, 4};
    const BakedBody baked = bakedBox();
    btSoftBody* a = btFemHelpers::createFromBaked(world.info(), baked);
    btSoftBody* b = btFemHelpers::createFromTetMesh(plainWorld.info(), box());
    fem.useBaked(a, baked);
    for (const int i : m_settings.m_pins) b->m_nodes[i].m_im = 0;
    Material softer = m_settings.m_material;
    softer.m_youngModulus /= 3;
    fem.setMaterial(a, bulletMaterial(softer));
    plainFem.setMaterial(b, bulletMaterial(softer));
    world.addSoft(a);
    plainWorld.addSoft(b);
    const std::vector<Vec3> before = edgesOf(*a);
    world.step(60);
    plainWorld.step(60);
    EXPECT_TRUE(fem.stepReport(a).m_bakedFactor);
    EXPECT_FALSE(plainFem.stepReport(b).m_bakedFactor);
    // Sixty steps with relative differences of 1e-6, and single precision.
    EXPECT_LT(largestDifference(edgesOf(*a), edgesOf(*b)), 1e-4 * largestDifference(edgesOf(*b), before));
}

TEST_F(StaleBakedFactor, IsRenewedByPolicy)
{
    btFemSolverInfo info;
    info.m_refactoring = btFemRefactoring::synchronous;
    btFemSoftBodySolver fem(info);
    SoftWorld world(fem);
    m_settings.m_step = 1.0 / 500;
    const BakedBody baked = bakedBox();
    btSoftBody* body = btFemHelpers::createFromBaked(world.info(), baked);
    fem.useBaked(body, baked);
    world.addSoft(body);
    body->m_nodes[0].m_v = btVector3(3, 2, 1);
    world.step(300);
    EXPECT_FALSE(fem.stepReport(body).m_bakedFactor);
    EXPECT_EQ(fem.stepReport(body).m_flags & BT_FEM_STALE_FACTOR, 0);
}

TEST_F(BakedBodies, AreRefactoredAndReportedIfScaled)
{
    btSoftBody& body = addBaked(bakedBox());
    body.scale(btVector3(2, 2, 2));
    m_world.step();
    EXPECT_FALSE(m_fem.stepReport(&body).m_bakedFactor);
    EXPECT_TRUE(has(body, BT_FEM_BAKED_UNUSED));
    EXPECT_FALSE(has(body, BT_FEM_STALE_FACTOR));
}

TEST_F(BakedBodies, AreRefactoredIfTheFactorExceedsTheLimit)
{
    const BakedBody baked = bakedBox();
    btFemSolverInfo info;
    info.m_factorChoice = btFemFactorChoice::lowMemoryBeyond;
    info.m_maxFactorMegabytes = btScalar(0.5e-6 * double(baked.m_model->factorReport().m_bytes));
    btFemSoftBodySolver fem(info);
    SoftWorld world(fem);
    btSoftBody* body = btFemHelpers::createFromBaked(world.info(), baked);
    fem.useBaked(body, baked);
    world.addSoft(body);
    world.step();
    EXPECT_TRUE(fem.stepReport(body).m_lowMemory);
    EXPECT_TRUE(fem.stepReport(body).m_flags & BT_FEM_BAKED_UNUSED);
}

TEST_F(BakedBodies, CanBeGivenToAnExistingFemBody)
{
    btSoftBody* body = btFemHelpers::createFromTetMesh(m_world.info(), box());
    m_world.addSoft(body);
    m_world.step(3);
    EXPECT_FALSE(m_fem.stepReport(body).m_bakedFactor);
    m_fem.useBaked(body, bakedBox());
    m_world.step(3);
    EXPECT_TRUE(m_fem.stepReport(body).m_bakedFactor);
    EXPECT_TRUE(allFinite(*body));
}

TEST_F(BakedBodies, AreRefusedForOtherBodies)
{
    const BakedBody baked = bakedBox();
    btSoftBody& other = addUnitCube(m_world, btVector3(0, 0, 3));
    const auto refusal = [&](btSoftBody* body, const BakedBody& b)
    { return messageOf<std::invalid_argument>([&] { m_fem.useBaked(body, b); }); };
    EXPECT_NE(refusal(&other, baked).find("125 nodes"), std::string::npos);
    EXPECT_NE(refusal(nullptr, baked).find("null"), std::string::npos);
    EXPECT_NE(refusal(&other, {}).find("empty"), std::string::npos);
    std::string why;
    EXPECT_FALSE(m_fem.useBaked(&other, baked, &why));
    EXPECT_NE(why.find("createFromBaked"), std::string::npos);
    EXPECT_EQ(btFemHelpers::createFromBaked(m_world.info(), {}, &why), nullptr);
    EXPECT_NE(why.find("empty"), std::string::npos);
}

}  // namespace
}  // namespace bullet_fem
