// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Anchors of FEM bodies to rigid ones, in staggered and in monolithic coupling.
#include <gtest/gtest.h>

#include "plugin/scenes/anchor_scene.h"
#include "plugin/scenes/each_world.h"

namespace bullet_fem
{
namespace
{

class AnchorsTest : public AnchorScene, public EachWorldWith<Coupling>
{
protected:
    AnchorsTest() : AnchorScene(value(), {0, 0, btScalar(-kGravity)}, worldClass()) {}
};

/// Tests of a minute of simulated time.
class MinuteOfAnchorsTest : public AnchorsTest
{
};

class FloatingAnchorsTest : public AnchorScene, public EachWorldWith<Coupling>
{
protected:
    FloatingAnchorsTest() : AnchorScene(value(), btVector3(0, 0, 0), worldClass()) {}
};

TEST_P(AnchorsTest, AStaticCeilingCarriesTheWeight)
{
    btSoftBody& cube = addCube({0, 0, 0});
    btRigidBody& ceiling = addBox(0, {0, 0, btScalar(2 * kHalf)});
    anchorAll(cube, nodesAt(cube, kHalf), ceiling);
    m_world.step(300);
    EXPECT_LT(worstForce(60, cube, ceiling, {0, 0, kCubeWeight}), 1e-3);
    EXPECT_EQ(m_fem.anchors(&cube).size(), 9);
    EXPECT_LT(largestError(cube), 1e-5 * kHalf);
}

TEST_P(AnchorsTest, AKinematicBodyCarriesTheBodyUpWithoutLag)
{
    btSoftBody& cube = addCube({0, 0, 0});
    btRigidBody& lift = addBox(0, {0, 0, btScalar(2 * kHalf)});
    lift.setCollisionFlags(lift.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    lift.setActivationState(DISABLE_DEACTIVATION);
    anchorAll(cube, nodesAt(cube, kHalf), lift);
    const double acceleration = 3;
    double worst = 0, farthest = 0;
    for (int k = 1; k <= 240; ++k)
    {
        const double t = k * double(kStep), height = 2 * kHalf + 0.5 * acceleration * t * t;
        lift.getMotionState()->setWorldTransform(at(0, 0, btScalar(height)));
        m_world.step();
        for (int a = 0; a < cube.m_anchors.size(); ++a)
        {
            const btVector3 pivot = lift.getWorldTransform() * cube.m_anchors[a].m_local;
            farthest = std::max(farthest, double(pivot.distance(cube.m_anchors[a].m_node->m_x)));
        }
        const Vec3 force = (1 / double(kStep)) * impulseOf(cube, lift);
        if (k > 180) worst = std::max(worst, std::fabs(force.z / (125 * (kGravity + acceleration)) - 1));
    }
    EXPECT_LT(worst, 1e-3);
    EXPECT_LT(farthest, 1e-3 * kHalf);
}

TEST_P(AnchorsTest, DynamicBodyHangsOnAHangingSoftOne)
{
    btSoftBody& cube = addCube({0, 0, 0});
    btRigidBody &ceiling = addBox(0, {0, 0, btScalar(2 * kHalf)}), &weight = addBox(50, {0, 0, btScalar(-2 * kHalf)});
    anchorAll(cube, nodesAt(cube, kHalf), ceiling);
    anchorAll(cube, nodesAt(cube, -kHalf), weight);
    m_world.step(600);
    const double load = 50 * kGravity;
    EXPECT_LT(worstForce(60, cube, weight, {0, 0, -load}), 1e-3);
    EXPECT_LT(worstForce(60, cube, ceiling, {0, 0, load + kCubeWeight}), 1e-3);
    EXPECT_LT(largestError(cube), 1e-3 * kHalf);
}

// Strain of 7 % under the load, so that deformation is part of the scene.
TEST_P(MinuteOfAnchorsTest, AThousandTimesHeavierBodyHangsStillForAMinute)
{
    const double density = 8, mass = 1000, load = mass * kGravity;
    btSoftBody& cube = addCube({0, 0, 0}, load / (4 * kHalf * kHalf) / 0.07, density);
    btRigidBody& ceiling = addBox(0, {0, 0, btScalar(2 * kHalf)});
    btRigidBody& weight = addBox(btScalar(mass), {0, 0, btScalar(-2 * kHalf)});
    anchorAll(cube, nodesAt(cube, kHalf), ceiling);
    anchorAll(cube, nodesAt(cube, -kHalf), weight);
    m_world.step(3000);
    const double height = weight.getCenterOfMassPosition().z();
    EXPECT_LT(worstForce(600, cube, ceiling, {0, 0, load + kGravity}), 1e-3);
    EXPECT_LT(std::fabs(weight.getCenterOfMassPosition().z() - height), 1e-4);
    const double strain = (-2 * kHalf - weight.getCenterOfMassPosition().z()) / (2 * kHalf);
    EXPECT_GT(strain, 0.05);
    EXPECT_LT(strain, 0.1);
}

TEST_P(MinuteOfAnchorsTest, AThousandTimesLighterBodyHangsStillForAMinute)
{
    btSoftBody& cube = addCube({0, 0, 0});
    btRigidBody& ceiling = addBox(0, {0, 0, btScalar(2 * kHalf)});
    btRigidBody& weight = addBox(btScalar(0.125), {0, 0, btScalar(-2 * kHalf)});
    anchorAll(cube, nodesAt(cube, kHalf), ceiling);
    anchorAll(cube, nodesAt(cube, -kHalf), weight);
    m_world.step(3000);
    EXPECT_LT(worstForce(600, cube, weight, {0, 0, -0.125 * kGravity}), 1e-3);
    EXPECT_LT(worstForce(60, cube, ceiling, {0, 0, kCubeWeight + 0.125 * kGravity}), 1e-3);
    EXPECT_LT(norm(vec3(weight.getLinearVelocity())), kGravity * double(kStep) + 1e-3);
}

TEST_P(AnchorsTest, AFarPivotDrawsItsNodeInWithoutAnExplosion)
{
    btSoftBody& cube = addCube({0, 0, 0});
    btRigidBody& ceiling = addBox(0, {0, 0, 3});
    for (int i : nodesAt(cube, kHalf)) cube.appendAnchor(i, &ceiling, btVector3(0, 0, 0), true);
    double fastest = 0;
    for (int k = 0; k < 600; ++k)
    {
        m_world.step();
        fastest = std::max(fastest, fastestNode(cube));
    }
    EXPECT_TRUE(allFinite(cube));
    EXPECT_LT(fastest, 30);
    EXPECT_LT(largestError(cube), 0.1);
}

// At 15 mean edges a second; a quarter of an edge per step would be 250 in steps of 1/1000 s.
TEST_P(FloatingAnchorsTest, AFarPivotDrawsItsNodeInNoFasterInShortSteps)
{
    btSoftBody& cube = addCube({0, 0, 0});
    btRigidBody& ceiling = addBox(0, {0, 0, 3});
    for (int i : nodesAt(cube, kHalf))
        cube.appendAnchor(i, &ceiling, btVector3(cube.m_nodes[i].m_x.x(), cube.m_nodes[i].m_x.y(), 0), true);
    const double fastestPull = 15 * kHalf * std::sqrt(3.0), height = centerOf(cube).z;  // no edge is longer
    double fastest = 0;
    for (int k = 0; k < 500; ++k)
    {
        m_world.bullet().stepSimulation(btScalar(1e-3), 0);
        fastest = std::max(fastest, fastestNode(cube));
    }
    EXPECT_LT(fastest, 2 * fastestPull);  // the body overshoots elastically
    EXPECT_GT(centerOf(cube).z - height, 0.2);
}

TEST_P(AnchorsTest, AnchoredNodesMayBeInsideTheirObject)
{
    btSoftBody& cube = addCube({0, 0, 0});
    btRigidBody& ceiling = addBox(0, {0, 0, btScalar(1.8 * kHalf)});
    for (int i : nodesAt(cube, kHalf)) cube.appendAnchor(i, &ceiling, false);
    m_world.step(300);
    EXPECT_LT(worstForce(60, cube, ceiling, {0, 0, kCubeWeight}), 1e-3);
    EXPECT_EQ(m_fem.contacts(&cube).size(), 0);
}

TEST_P(AnchorsTest, InfluenceLetsTheNodeHangLower)
{
    btSoftBody &firm = addCube({0, 0, 0}), &loose = addCube({3, 0, 0});
    btRigidBody& ceiling = addBox(0, {0, 0, btScalar(2 * kHalf)});
    for (int i : nodesAt(firm, kHalf)) firm.appendAnchor(i, &ceiling, true);
    for (int i : nodesAt(loose, kHalf)) loose.appendAnchor(i, &ceiling, true, btScalar(0.1));
    m_world.step(300);
    EXPECT_LT(largestError(firm), 1e-5);
    EXPECT_GT(largestError(loose), 100 * largestError(firm));
    EXPECT_LT(largestError(loose), 0.2 * kHalf);
    EXPECT_LT(worstForce(60, loose, ceiling, {0, 0, kCubeWeight}), 1e-3);
}

TEST_P(FloatingAnchorsTest, ASleepingBodyWakesWhenItIsPulled)
{
    btSoftBody& cube = addCube({0, 0, 0});
    btRigidBody& box = addBox(10, {0, 0, btScalar(2 * kHalf + 0.01)});
    anchorAll(cube, nodesAt(cube, kHalf), box);
    box.forceActivationState(ISLAND_SLEEPING);
    cube.addVelocity(btVector3(0, 0, -1));
    double fastest = 0;
    for (int k = 0; k < 300; ++k)
    {
        m_world.step();
        fastest = std::max({fastest, fastestNode(cube), double(box.getLinearVelocity().length())});
    }
    EXPECT_TRUE(box.isActive());
    EXPECT_LT(fastest, 3);
    EXPECT_NEAR(box.getLinearVelocity().z(), -125.0 / 135, 1e-3);
    EXPECT_LT(largestError(cube), 1e-3);
}

TEST(AnchorMomentumTest, IsConservedWithoutGravityAtAnyMassRatio)
{
    for (const Coupling coupling : {Coupling::swap, Coupling::coupled})
        for (const btScalar mass : {btScalar(0.125), btScalar(300), btScalar(125000)})
        {
            SCOPED_TRACE(mass);
            btFemSoftBodySolver fem;
            SoftWorld world(fem, coupling, btVector3(0, 0, 0));
            const btScalar half(AnchorScene::kHalf);
            btSoftBody& cube = world.addSoft(
                btFemHelpers::createBox(world.info(), btVector3(0, 0, 0), btVector3(half, half, half), half));
            RigidSettings settings;
            settings.m_mass = mass;
            settings.m_transform = at(btScalar(2.5) * half, 0, 0);
            settings.m_velocity = btVector3(0, 1, btScalar(0.5));
            btRigidBody& ball = world.addRigid(new btSphereShape(half), settings);
            for (int i = 0; i < cube.m_nodes.size(); ++i)
                if (cube.m_nodes[i].m_x.x() > half - btScalar(1e-4)) cube.appendAnchor(i, &ball, true);
            const Motion ofBall = motionOf(ball), ofCube = motionOf(cube);
            world.step(300);
            Motion after = motionOf(cube);
            after += motionOf(ball);
            const double momentum = norm(ofBall.m_linear);
            EXPECT_LT(norm(after.m_linear - ofBall.m_linear - ofCube.m_linear), 1e-6 * momentum);
            EXPECT_LT(norm(after.m_angular - ofBall.m_angular - ofCube.m_angular), 1e-5 * norm(ofBall.m_angular));
            const double share = 125.0 / (125 + double(mass));  // of a rigid cube
            EXPECT_GT(norm(motionOf(cube).m_linear), 0.2 * share * momentum);
        }
}

// A stiff bar on a hinge of two anchored nodes: the period is T = 2 pi sqrt(I / (m g d)), times 1 + a^2 / 16 at
// amplitude a.
TEST_P(AnchorsTest, AStiffBarSwingsAsAPendulum)
{
    const btScalar length(1), thickness(0.1);
    btSoftBody& bar = m_world.addSoft(btFemHelpers::createBox(m_world.info(), btVector3(length / 2, 0, 0),
                                                              btVector3(length, thickness, thickness) / 2, thickness));
    btFemMaterial material;
    material.m_youngModulus = btScalar(1e9);
    material.m_stiffnessDamping = btScalar(1e-5);
    m_fem.setMaterial(&bar, material);
    btRigidBody& axle = addBox(0, {0, 0, 0});
    for (int i = 0; i < bar.m_nodes.size(); ++i)
        if (bar.m_nodes[i].m_x.x() < btScalar(1e-4) && bar.m_nodes[i].m_x.z() > btScalar(0.04))
            bar.appendAnchor(i, &axle, true);
    ASSERT_EQ(bar.m_anchors.size(), 2);

    // Rotated about the hinge by 0.1 rad from the vertical.
    const btVector3 hinge(0, 0, thickness / 2);
    const Vec3 center = centerOf(bar) - vec3(hinge);
    const double amplitude = 0.1, turn = SIMD_HALF_PI - amplitude - std::atan2(-center.z, center.x);
    bar.translate(-hinge);
    bar.rotate(btQuaternion(btVector3(0, 1, 0), btScalar(turn)));
    bar.translate(hinge);
    double inertia = 0;
    for (int i = 0; i < bar.m_nodes.size(); ++i)
    {
        const btVector3 r = bar.m_nodes[i].m_x - hinge;
        inertia += (r.x() * r.x() + r.z() * r.z()) / double(bar.m_nodes[i].m_im);
    }
    const double expected =
        2 * SIMD_PI * std::sqrt(inertia / (massOf(bar) * kGravity * norm(center))) * (1 + amplitude * amplitude / 16);

    const btScalar h = btScalar(1) / 240;
    std::vector<double> crossings;
    double before = centerOf(bar).x;
    for (int k = 1; k <= 2400; ++k)
    {
        m_world.step(1, h);
        const double now = centerOf(bar).x;
        if (before > 0 && now <= 0) crossings.push_back((k - now / (now - before)) * double(h));
        before = now;
    }
    ASSERT_GE(crossings.size(), 4u);
    const double period = (crossings.back() - crossings.front()) / double(crossings.size() - 1);
    EXPECT_NEAR(period / expected, 1, 0.02);
}

// Monolithic coupling only: with the swap the weight has a velocity of g h.
TEST(CoupledAnchorsTest, AHangingWeightIsStill)
{
    struct Scene : AnchorScene
    {
        Scene() : AnchorScene(Coupling::coupled) {}
        double speedOfWeight()
        {
            btSoftBody& cube = addCube({0, 0, 0});
            btRigidBody& ceiling = addBox(0, {0, 0, btScalar(2 * kHalf)});
            btRigidBody& weight = addBox(50, {0, 0, btScalar(-2 * kHalf)});
            anchorAll(cube, nodesAt(cube, kHalf), ceiling);
            anchorAll(cube, nodesAt(cube, -kHalf), weight);
            m_world.step(600);
            return weight.getLinearVelocity().length();
        }
    } scene;
    EXPECT_LT(scene.speedOfWeight(), 1e-4);
}

const auto swapEverywhere = ::testing::Combine(eachWorld(), ::testing::Values(Coupling::swap));
const auto coupled = ::testing::Combine(::testing::Values(WorldClass::softRigid), ::testing::Values(Coupling::coupled));

INSTANTIATE_TEST_SUITE_P(Swap, AnchorsTest, swapEverywhere, nameOfWorldWith(couplingName));
INSTANTIATE_TEST_SUITE_P(Both, MinuteOfAnchorsTest,
                         ::testing::Combine(::testing::Values(WorldClass::softRigid),
                                            ::testing::Values(Coupling::swap, Coupling::coupled)),
                         nameOfWorldWith(couplingName));
INSTANTIATE_TEST_SUITE_P(Swap, FloatingAnchorsTest, swapEverywhere, nameOfWorldWith(couplingName));
INSTANTIATE_TEST_SUITE_P(Coupled, AnchorsTest, coupled, nameOfWorldWith(couplingName));
INSTANTIATE_TEST_SUITE_P(Coupled, FloatingAnchorsTest, coupled, nameOfWorldWith(couplingName));

}  // namespace
}  // namespace bullet_fem
