// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "BulletDynamics/Featherstone/btMultiBodyJointMotor.h"
#include "BulletSoftBody/btDeformableMultiBodyConstraintSolver.h"
#include "BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h"
#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "bullet_bridge/bullet_vectors.h"
#include "bullet_fem/btFemDeformableBodySolver.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/fem/generators.h"
#include "plugin/link_world.h"
#include "plugin/scene_measures.h"

namespace bullet_fem
{
namespace
{

using DeformableWorld =
    LinkWorld<btDeformableMultiBodyDynamicsWorld, btDeformableMultiBodyConstraintSolver, btDeformableBodySolver>;

constexpr double kYoung = 2e5, kPoisson = 0.3, kDensity = 1000;
constexpr double kMu = kYoung / (2 * (1 + kPoisson));
constexpr double kLambda = kYoung * kPoisson / ((1 + kPoisson) * (1 - 2 * kPoisson));

enum class Elastic
{
    linear,
    corotated,
    neoHookean
};

const char* nameOf(Elastic elastic)
{
    return elastic == Elastic::linear ? "linear" : elastic == Elastic::corotated ? "corotated" : "neoHookean";
}

std::unique_ptr<btDeformableLagrangianForce> makeForce(Elastic elastic, double mu, double lambda)
{
    const btScalar m = btScalar(mu), l = btScalar(lambda);
    if (elastic == Elastic::linear) return std::make_unique<btDeformableLinearElasticityForce>(m, l, 0, btScalar(0.01));
    if (elastic == Elastic::corotated) return std::make_unique<btDeformableCorotatedForce>(m, l);
    return std::make_unique<btDeformableNeoHookeanForce>(m, l, btScalar(0.01));
}

class DeformableWorldTest : public ::testing::Test
{
protected:
    DeformableWorldTest() : m_world(m_solver) {}

    // A box of kDensity with its lower face at `lowest`, as Bullet's programs have it.
    btSoftBody& addBox(DeformableWorld& world, const Vec3& size, const std::array<int, 3>& cells, const Vec3& center)
    {
        btSoftBody* body = btFemHelpers::createFromTetMesh(world.info(), makeBox(size, cells));
        body->translate(bulletVector(center - 0.5 * size));
        body->m_cfg.collisions = btSoftBody::fCollision::SDF_RD | btSoftBody::fCollision::SDF_RDN;
        body->setTotalMass(btScalar(kDensity * size.x * size.y * size.z));
        return world.addSoft(body);
    }
    btSoftBody& addCube(DeformableWorld& world, const Vec3& center, double edge = 0.4)
    {
        return addBox(world, {edge, edge, edge}, {4, 4, 4}, center);
    }

    void addForces(DeformableWorld& world, btSoftBody& body, Elastic elastic = Elastic::linear)
    {
        addForce(world, body, makeForce(elastic, kMu, kLambda));
        addForce(world, body, std::make_unique<btDeformableGravityForce>(btVector3(0, 0, btScalar(-kGravity))));
    }

    btDeformableLagrangianForce& addForce(DeformableWorld& world, btSoftBody& body,
                                          std::unique_ptr<btDeformableLagrangianForce> force)
    {
        m_forces.push_back(std::move(force));
        world.world().addForce(&body, m_forces.back().get());
        return *m_forces.back();
    }

    // What Bullet's file readers add.
    static void makeReadyForBullet(btSoftBody& body)
    {
        for (int t = 0; t < body.m_tetras.size(); ++t)
            for (int a = 0; a < 4; ++a)
                for (int b = 0; b < a; ++b)
                    body.appendLink(body.m_tetras[t].m_n[a], body.m_tetras[t].m_n[b], nullptr, true);
        body.initializeDmInverse();
        body.m_tetraScratches.resizeNoInitialize(body.m_tetras.size());
        body.m_tetraScratchesTn.resizeNoInitialize(body.m_tetras.size());
    }

    btSoftBody& addCloth(DeformableWorld& world)
    {
        auto* cloth = btSoftBodyHelpers::CreatePatch(world.info(), btVector3(-1, -1, 1), btVector3(1, -1, 1),
                                                     btVector3(-1, 1, 1), btVector3(1, 1, 1), 9, 9, 0, true);
        cloth->getCollisionShape()->setMargin(btScalar(0.05));
        cloth->setTotalMass(1);
        cloth->m_cfg.kDF = btScalar(0.5);
        cloth->m_cfg.collisions = btSoftBody::fCollision::SDF_RD | btSoftBody::fCollision::VF_DD;
        cloth->setCollisionFlags(0);
        world.addSoft(cloth);
        addForce(world, *cloth, std::make_unique<btDeformableMassSpringForce>(btScalar(30), btScalar(1), true));
        addForce(world, *cloth, std::make_unique<btDeformableGravityForce>(btVector3(0, 0, btScalar(-kGravity))));
        return *cloth;
    }

    std::vector<std::unique_ptr<btDeformableLagrangianForce>> m_forces;
    btFemDeformableBodySolver m_solver;
    DeformableWorld m_world;
};

class ElasticForces : public DeformableWorldTest, public ::testing::WithParamInterface<Elastic>
{
};

TEST_P(ElasticForces, stretchAHangingBarAsTheirModuliSay)
{
    const double length = 1;
    btSoftBody& bar = addBox(m_world, {0.25, 0.25, length}, {3, 3, 12}, {0, 0, -0.5 * length});
    addForces(m_world, bar, GetParam());
    for (int i = 0; i < bar.m_nodes.size(); ++i)
        if (bar.m_nodes[i].m_x.z() > btScalar(-1e-3)) bar.setMass(i, 0);
    m_world.step(400);
    ASSERT_TRUE(m_solver.fem().isFem(&bar));
    EXPECT_LT(fastestNode(bar), 1e-4);
    const double wanted = kDensity * kGravity * length * length / (2 * kYoung);
    // The clamped end cannot contract: a little less.
    EXPECT_NEAR(-lowestHeight(bar) - length, wanted, 0.04 * wanted);
}

TEST_P(ElasticForces, letABodyRestOnTheGround)
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

TEST_F(DeformableWorldTest, changedModuliAreObeyed)
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

TEST_F(DeformableWorldTest, aBodyFallsOnlyWithAGravityForceAndByItsFactor)
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

TEST_F(DeformableWorldTest, mousePickingDragsABodyToTheMouse)
{
    btSoftBody& cube = addCube(m_world, {0, 0, 1});
    addForce(m_world, cube, makeForce(Elastic::linear, kMu, kLambda));
    const btVector3 mouse(2, 0, 1);
    btSoftBody::Face& face = cube.m_faces[0];
    auto picking = std::make_unique<btDeformableMousePickingForce>(btScalar(2000), btScalar(300), face, mouse, 100);
    btDeformableLagrangianForce& force = addForce(m_world, cube, std::move(picking));
    btSoftBody& cloth = addCloth(m_world);  // which the force lists, too, as Bullet's worlds do with a second one
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

TEST_F(DeformableWorldTest, clothBesideFemBodiesKeepsItsBits)
{
    const auto run = [this](btDeformableBodySolver& solver, bool withFem, bool implicit)
    {
        DeformableWorld world(solver);
        world.world().setImplicit(implicit);
        world.world().setUseProjection(implicit);
        world.addFloorBox();
        std::vector<btSoftBody*> cubes;
        if (withFem) cubes.push_back(&addCube(world, {5, 0, 0.5}));
        btSoftBody& cloth = addCloth(world);  // its forces first: Bullet sums forces in their order
        if (withFem) cubes.push_back(&addCube(world, {-5, 0, 0.5}));
        for (btSoftBody* cube : cubes) addForces(world, *cube);
        std::vector<float> bits;
        for (int k = 0; k < 200; ++k)
        {
            world.step();
            const std::vector<float> now = bitsOf(cloth);
            bits.insert(bits.end(), now.begin(), now.end());
        }
        EXPECT_LT(centerOf(cloth).z, 0.2);
        return bits;
    };
    for (const bool implicit : {false, true})
    {
        btDeformableBodySolver bullet;
        btFemDeformableBodySolver ours;
        EXPECT_EQ(run(bullet, false, implicit), run(ours, true, implicit)) << implicit;
    }
}

// Bullet's world makes all soft bodies collide that have VF_DD.
TEST_F(DeformableWorldTest, clothFallsThroughFemBodiesAndLeavesThemAlone)
{
    btSoftBody& cube = addCube(m_world, {0, 0, 0.5});
    addForce(m_world, cube, makeForce(Elastic::linear, kMu, kLambda));
    cube.m_cfg.collisions |= btSoftBody::fCollision::VF_DD;
    const btSoftBody& cloth = addCloth(m_world);
    m_world.step(60);
    EXPECT_LT(centerOf(cloth).z, 0.2);
    EXPECT_LT(fastestNode(cube), 1e-6);
    EXPECT_TRUE(cube.m_cfg.collisions & btSoftBody::fCollision::VF_DD);
}

TEST_F(DeformableWorldTest, bodiesWithoutAnElasticForceStayBullets)
{
    btSoftBody& cube = addCube(m_world, {0, 0, 1});
    makeReadyForBullet(cube);
    addForce(m_world, cube, std::make_unique<btDeformableGravityForce>(btVector3(0, 0, -1)));
    m_world.step(2);
    EXPECT_FALSE(m_solver.fem().isFem(&cube));
    addForce(m_world, cube, makeForce(Elastic::linear, kMu, kLambda));
    m_world.step(2);
    EXPECT_TRUE(m_solver.fem().isFem(&cube));
}

class ImpossibleModuli : public DeformableWorldTest, public ::testing::WithParamInterface<bool>
{
};

TEST_P(ImpossibleModuli, leaveABodyToBulletWithAReason)
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

TEST_F(DeformableWorldTest, bodiesThatBulletCannotMoveAreFemWithoutForces)
{
    btSoftBody& cube = addCube(m_world, {0, 0, 1});
    m_world.step(2);
    EXPECT_TRUE(m_solver.fem().isFem(&cube));
    EXPECT_NEAR(velocityOf(cube).z, 0, 1e-6);
}

TEST_F(DeformableWorldTest, forcesListTheirBodiesBetweenSteps)
{
    btSoftBody& cube = addCube(m_world, {0, 0, 1});
    addForces(m_world, cube);
    m_world.step(3);
    for (const auto& force : m_forces) EXPECT_EQ(force->m_softBodies.size(), 1);
    EXPECT_EQ(m_solver.getLagrangianForceArray()->size(), 2);
}

TEST_F(DeformableWorldTest, bodiesCollideWithEachOtherAndKeepTheirMomentum)
{
    btSoftBody &a = addCube(m_world, {0, 0, 0}), &b = addCube(m_world, {0.6, 0.05, 0.1});
    for (btSoftBody* body : {&a, &b})
    {
        addForce(m_world, *body, makeForce(Elastic::linear, kMu, kLambda));
        body->m_cfg.collisions |= btSoftBody::fCollision::VF_DD;
    }
    a.setVelocity(btVector3(2, 0, 0));
    const double start = motionOf(a).m_linear.x;
    m_world.step(60);
    EXPECT_GT(velocityOf(b).x, 0.5);
    EXPECT_NEAR(motionOf(a).m_linear.x + motionOf(b).m_linear.x, start, 1e-5 * start);
}

TEST_F(DeformableWorldTest, aRigidBoxOnASoftBodyIsCarried)
{
    m_world.addFloorBox();
    btSoftBody& cube = addCube(m_world, {0, 0, 0.2});
    addForces(m_world, cube);
    RigidSettings settings;
    settings.m_mass = 10;
    settings.m_transform = at(0, 0, btScalar(0.52));
    btRigidBody& box =
        m_world.addRigid(new btBoxShape(btVector3(btScalar(0.1), btScalar(0.1), btScalar(0.1))), settings);
    m_world.step(240);
    double force = 0;
    for (int k = 0; k < 60; ++k)
    {
        m_world.step();
        force -= m_solver.fem().contactForce(&cube, &box).z() / 60;
    }
    EXPECT_NEAR(force, 10 * kGravity, 0.01 * 10 * kGravity);
    EXPECT_GT(box.getCenterOfMassPosition().z(), 0.4);
}

TEST_F(DeformableWorldTest, anAnchoredLinkHangsOnASoftBody)
{
    btSoftBody& cube = addCube(m_world, {0, 0, 0.2});
    addForces(m_world, cube);
    for (int i = 0; i < cube.m_nodes.size(); ++i)
        if (cube.m_nodes[i].m_x.z() > btScalar(0.39)) cube.setMass(i, 0);
    const btVector3 half(btScalar(0.1), btScalar(0.1), btScalar(0.1));
    auto* body = new btMultiBody(0, 10, btVector3(btScalar(0.07), btScalar(0.07), btScalar(0.07)), false, false);
    body->setBasePos(btVector3(0, 0, btScalar(-0.1)));
    btMultiBodyLinkCollider& base = m_world.addCollider(m_world.addMultiBody(body), -1, new btBoxShape(half));
    for (int i = 0; i < cube.m_nodes.size(); ++i)
        if (cube.m_nodes[i].m_x.z() < btScalar(0.01)) cube.appendDeformableAnchor(i, &base);
    m_world.step(300);
    Vec3 force;
    for (int k = 0; k < m_solver.fem().anchors(&cube).size(); ++k)
        force += (1 / double(kStep)) * vec3(m_solver.fem().anchors(&cube)[k].m_impulse);
    EXPECT_NEAR(force.z, -10 * kGravity, 1e-3 * 10 * kGravity);
    EXPECT_NEAR(base.getWorldTransform().getOrigin().z(), -0.1, 0.02);
    for (int k = 0; k < m_solver.fem().anchors(&cube).size(); ++k)
        EXPECT_LT(m_solver.fem().anchors(&cube)[k].m_error, 1e-3);  // it would fall by g h^2 = 2.7e-3 m in a step
}

// A platform on a vertical slider that a motor holds: gravity is Bullet's at another time of the step than elsewhere.
TEST_F(DeformableWorldTest, aLinkThatIsHeldCarriesABody)
{
    const btVector3 half(btScalar(0.5), btScalar(0.5), btScalar(0.1));
    auto* body = new btMultiBody(1, 0, btVector3(0, 0, 0), true, false);
    body->setupPrismatic(0, 20, btVector3(1, 1, 1), -1, btQuaternion::getIdentity(), btVector3(0, 0, 1),
                         btVector3(0, 0, btScalar(-0.1)), btVector3(0, 0, 0), false);
    btMultiBodyLinkCollider& link = m_world.addCollider(m_world.addMultiBody(body), 0, new btBoxShape(half));
    m_world.addConstraint<btMultiBodyJointMotor>(body, 0, 0, btScalar(1e4));
    btSoftBody& cube = addCube(m_world, {0, 0, 0.21});
    addForces(m_world, cube);
    m_world.step(300);
    const double weight = massOf(cube) * kGravity;
    EXPECT_NEAR(m_solver.fem().contactForce(&cube, &link).z(), weight, 2e-3 * weight);
    EXPECT_LT(fastestNode(cube), 0.01);
}

TEST_F(DeformableWorldTest, bodiesFallAsleepInTwoSecondsAndWake)
{
    m_world.addFloorBox();
    btSoftBody& cube = addCube(m_world, {0, 0, 0.2});
    addForces(m_world, cube);
    cube.forceActivationState(ACTIVE_TAG);
    int awake = 0;
    while (cube.isActive() && awake < 400) m_world.step(), ++awake;
    EXPECT_GT(awake, 120);
    EXPECT_LT(awake, 240);
    cube.addVelocity(btVector3(0, 0, 1));
    m_world.step(2);
    EXPECT_TRUE(cube.isActive());
    EXPECT_GT(velocityOf(cube).z, 0.5);
}

TEST_F(DeformableWorldTest, bodiesMayBeRemovedWithinAStepAndAfter)
{
    btSoftBody &a = addCube(m_world, {0, 0, 1}), &b = addCube(m_world, {2, 0, 1});
    for (btSoftBody* body : {&a, &b}) addForces(m_world, *body);
    btSoftBody& cloth = addCloth(m_world);
    m_world.step(3);
    m_world.world().removeSoftBody(&a);
    m_world.step(3);
    EXPECT_TRUE(m_solver.fem().isFem(&b));
    m_world.world().setInternalTickCallback(
        [](btDynamicsWorld* of, btScalar)
        {
            auto* soft = static_cast<btSoftBody*>(of->getWorldUserInfo());
            if (soft) static_cast<btDeformableMultiBodyDynamicsWorld*>(of)->removeSoftBody(soft);
            of->setWorldUserInfo(nullptr);
        },
        &b);
    m_world.step(3);
    EXPECT_FALSE(m_solver.fem().isFem(&b));
    EXPECT_TRUE(allFinite(cloth));
    for (const auto& force : m_forces)
        for (int k = 0; k < force->m_softBodies.size(); ++k) EXPECT_EQ(force->m_softBodies[k], &cloth);
    for (btSoftBody* body : {&a, &b}) m_world.world().addSoftBody(body);
    for (btSoftBody* body : {&a, &b}) addForces(m_world, *body);
    m_world.step(3);
    EXPECT_TRUE(m_solver.fem().isFem(&a) && m_solver.fem().isFem(&b));
}

}  // namespace
}  // namespace bullet_fem
