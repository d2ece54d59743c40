// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "plugin/scenes/deformable_scene.h"

namespace bullet_fem
{
namespace
{

class ElasticForces : public DeformableWorldTest, public ::testing::WithParamInterface<Elastic>
{
};

TEST_P(ElasticForces, StretchAHangingBarAsTheirModuliSay)
{
    const double length = 1;
    btSoftBody& bar = addBox(m_world, {0.25, 0.25, length}, {3, 3, 12}, {0, 0, -0.5 * length});
    addForces(m_world, bar, GetParam());
    for (int i = 0; i < bar.m_nodes.size(); ++i)
        if (bar.m_nodes[i].m_x.z() > btScalar(-1e-3)) bar.setMass(i, 0);
    bar.m_cfg.drag = btScalar(0.05);  // to settle
    m_world.step(400);
    ASSERT_TRUE(m_solver.fem().isFem(&bar));
    EXPECT_LT(fastestNode(bar), 1e-4);
    const double wanted = kDensity * kGravity * length * length / (2 * kYoung);
    // The fixed end cannot contract, so the result is slightly smaller.
    EXPECT_NEAR(-lowestHeight(bar) - length, wanted, 0.04 * wanted);
}

TEST_P(ElasticForces, LetABodyRestOnTheGround)
{
    btRigidBody& floor = m_world.addFloorBox();
    btSoftBody& cube = addCube(m_world, {0, 0, 0.5});
    addForces(m_world, cube, GetParam());
    m_world.step(300);
    const double weight = massOf(cube) * kGravity;
    EXPECT_LT(fastestNode(cube), 1e-3);
    EXPECT_NEAR(lowestHeight(cube), 0, 1e-3);
    EXPECT_NEAR(m_solver.fem().contactForce(&cube, &floor).z(), weight, 1e-3 * weight);
    const double squeezed = kDensity * kGravity * 0.4 * 0.4 / (2 * kYoung);
    double highest = 0;
    for (int i = 0; i < cube.m_nodes.size(); ++i) highest = std::max(highest, double(cube.m_nodes[i].m_x.z()));
    EXPECT_NEAR(0.4 - highest, squeezed, 0.25 * squeezed);
}

INSTANTIATE_TEST_SUITE_P(Kinds, ElasticForces,
                         ::testing::Values(Elastic::linear, Elastic::corotated, Elastic::neoHookean),
                         [](const auto& kind) { return nameOf(kind.param); });

TEST_F(DeformableWorldTest, ChangedModuliAreObeyed)
{
    btSoftBody& bar = addBox(m_world, {0.25, 0.25, 1}, {2, 2, 8}, {0, 0, -0.5});
    addForces(m_world, bar);
    auto& elastic = static_cast<btDeformableLinearElasticityForce&>(*m_forces.front());
    for (int i = 0; i < bar.m_nodes.size(); ++i)
        if (bar.m_nodes[i].m_x.z() > btScalar(-1e-3)) bar.setMass(i, 0);
    m_world.step(300);
    const double soft = -lowestHeight(bar) - 1;
    elastic.setYoungsModulus(btScalar(2 * kYoung));
    m_world.step(300);
    EXPECT_NEAR(-lowestHeight(bar) - 1, 0.5 * soft, 0.01 * soft);
}

TEST_F(DeformableWorldTest, ABodyFallsOnlyWithAGravityForceAndByItsFactor)
{
    btSoftBody &floats = addCube(m_world, {0, 0, 5}), &falls = addCube(m_world, {2, 0, 5}),
               &half = addCube(m_world, {4, 0, 5});
    addForce(m_world, floats, makeForce(Elastic::corotated, kMu, kLambda));
    for (btSoftBody* body : {&falls, &half}) addForces(m_world, *body, Elastic::corotated);
    half.m_gravityFactor = btScalar(0.5);
    m_world.step(30);
    const double speed = 30 * double(kStep) * kGravity;
    EXPECT_NEAR(velocityOf(floats).z, 0, 1e-6);
    EXPECT_NEAR(velocityOf(falls).z, -speed, 1e-4 * speed);
    EXPECT_NEAR(velocityOf(half).z, -0.5 * speed, 1e-4 * speed);
}

TEST_F(DeformableWorldTest, MousePickingDragsABodyToTheMouse)
{
    btSoftBody& cube = addCube(m_world, {0, 0, 1});
    addForce(m_world, cube, makeForce(Elastic::linear, kMu, kLambda));
    const btVector3 mouse(2, 0, 1);
    btSoftBody::Face& face = cube.m_faces[0];
    auto picking = std::make_unique<btDeformableMousePickingForce>(btScalar(2000), btScalar(300), face, mouse, 100);
    btDeformableLagrangianForce& force = addForce(m_world, cube, std::move(picking));
    btSoftBody& cloth = addCloth(m_world);  // the force also lists the cloth, as in Bullet's worlds with a second one
    m_world.world().addForce(&cloth, &force);
    double fastest = 0;
    for (int k = 0; k < 600; ++k)
    {
        m_world.step();
        fastest = std::max(fastest, norm(velocityOf(cube)));
        ASSERT_TRUE(allFinite(cube));
    }
    EXPECT_GT(fastest, 0.5);
    const btVector3 held = (face.m_n[0]->m_x + face.m_n[1]->m_x + face.m_n[2]->m_x) / 3;
    EXPECT_LT((held - mouse).length(), 0.1);
    ASSERT_EQ(force.m_softBodies.size(), 2);
    EXPECT_TRUE(force.m_softBodies[0] == &cloth || force.m_softBodies[1] == &cloth);
    m_world.world().removeForce(&cube, &force);
    m_world.world().removeForce(&cloth, &force);
    cube.setVelocity(btVector3(0, 0, 0));
    m_world.step(10);
    EXPECT_LT(norm(velocityOf(cube)), 0.05);
}

TEST_F(DeformableWorldTest, MousePickingHoldsWithItsFullStiffness)
{
    btSoftBody& cube = addCube(m_world, {0, 0, 1});
    addForces(m_world, cube);
    cube.m_cfg.drag = btScalar(0.02);  // it swings
    const btSoftBody::Face& face = cube.m_faces[0];
    const auto held = [&] { return (face.m_n[0]->m_x + face.m_n[1]->m_x + face.m_n[2]->m_x) / 3; };
    const btVector3 mouse = held();
    addForce(m_world, cube, std::make_unique<btDeformableMousePickingForce>(4000, 200, face, mouse, btScalar(1e10)));
    m_world.step(600);
    double sag = 0;
    for (int k = 0; k < 300; ++k)
    {
        m_world.step();
        sag += double((mouse - held()).z()) / 300;
    }
    const double wanted = massOf(cube) * kGravity / (3 * 4000);
    EXPECT_NEAR(sag, wanted, 0.02 * wanted);
}

TEST_F(DeformableWorldTest, MousePickingPullsWithItsLargestImpulseAndLetsGo)
{
    btSoftBody& cube = addCube(m_world, {0, 0, 1});
    addForce(m_world, cube, makeForce(Elastic::linear, kMu, kLambda));
    const btVector3 mouse(0, 40, 1);
    btDeformableLagrangianForce& force = addForce(
        m_world, cube, std::make_unique<btDeformableMousePickingForce>(4000, 0, cube.m_faces[0], mouse, btScalar(0.1)));
    m_world.step(60);
    const double impulse = 3 * 0.1 * 60;
    EXPECT_NEAR(motionOf(cube).m_linear.y, impulse, 0.01 * impulse);  // the body rotates slightly
    ASSERT_EQ(m_solver.fem().anchors(&cube).size(), 3);
    for (int k = 0; k < 3; ++k)
    {
        EXPECT_NEAR(m_solver.fem().anchors(&cube)[k].m_impulse.length(), 0.1, 1e-4);
        EXPECT_LT(m_solver.fem().anchors(&cube)[k].m_attachment, 0);
    }
    m_world.world().removeForce(&cube, &force);
    m_world.step();
    EXPECT_EQ(m_solver.fem().anchors(&cube).size(), 0);
}

class ImpossibleModuli : public DeformableWorldTest, public ::testing::WithParamInterface<bool>
{
};

TEST_P(ImpossibleModuli, LeaveABodyToBulletWithAReason)
{
    btSoftBody& cube = addCube(m_world, {0, 0, 1});
    if (GetParam()) makeReadyForBullet(cube);
    addForce(m_world, cube, makeForce(Elastic::linear, 0, 0));
    m_world.addFloorBox(btScalar(0.79));
    m_world.step(2);
    EXPECT_FALSE(m_solver.fem().isFem(&cube));
    EXPECT_TRUE(allFinite(cube));
    EXPECT_NE(std::string(m_solver.rejection(&cube)).find("Young"), std::string::npos);
    static_cast<btDeformableLinearElasticityForce&>(*m_forces.front())
        .setLameParameters(btScalar(kMu), btScalar(kLambda));
    m_world.step(2);
    EXPECT_TRUE(m_solver.fem().isFem(&cube));
    EXPECT_STREQ(m_solver.rejection(&cube), "");
}

INSTANTIATE_TEST_SUITE_P(ReadyForBullet, ImpossibleModuli, ::testing::Bool(),
                         [](const auto& ready) { return ready.param ? "ready" : "standsStill"; });

TEST_F(DeformableWorldTest, AMaterialOfTheUsersOwnReplacesAnImpossibleOne)
{
    btSoftBody& cube = addCube(m_world, {0, 0, 1});
    addForce(m_world, cube, makeForce(Elastic::linear, 0, 0));
    m_world.step(2);
    ASSERT_FALSE(m_solver.fem().isFem(&cube));
    m_solver.fem().setMaterial(&cube, btFemMaterial::foam());
    m_world.step(2);
    EXPECT_TRUE(m_solver.fem().isFem(&cube));
    EXPECT_STREQ(m_solver.rejection(&cube), "");
}

}  // namespace
}  // namespace bullet_fem
