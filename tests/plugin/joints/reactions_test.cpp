// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Reaction forces and moments of pinned and of prescribed nodes and of anchors, against weights, levers and rigid
// bodies.
#include <algorithm>
#include <cmath>

#include "bullet_fem/btFemHelpers.h"
#include "plugin/scenes/anchor_scene.h"
#include "plugin/scenes/each_world.h"
#include "plugin/scenes/reaction_scene.h"

namespace bullet_fem
{
namespace
{

constexpr double kBeamWeight = 500 * kGravity;  // of shortBeam() [N]

void expectNear(const Vec3& expected, const Vec3& found, double error)
{
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(expected[c], found[c], error) << c;
}

// Runs in each class of Bullet's worlds, with implicit Euler, so that bodies settle.
class ReactionsAtRest : public EachWorld
{
protected:
    ReactionsAtRest() : m_world(GetParam(), implicitEuler()) {}

    btSoftBody& addBeam(btScalar youngModulus, const Vec3& low, const Vec3& high)
    {
        btSoftBody& beam = *makeSoftBox(m_world, m_world.fem(), shortBeam(youngModulus));
        m_mass = nodeMasses(beam);
        pin(beam, nodesWithin(beam, low, high));
        m_world.addSoft(&beam);
        return beam;
    }

    FemWorld m_world;
    std::vector<double> m_mass;
};

TEST_P(ReactionsAtRest, PinsOfAHangingBodyCarryItsWeight)
{
    btSoftBody& beam = addBeam(btScalar(1e6), {-1, -1, 0.25}, {1, 1, 1});
    m_world.step(240);
    const btFemReaction all = m_world.fem().reaction(&beam, {0, 0, 0});
    EXPECT_EQ(27, all.m_count);
    expectNear({0, 0, kBeamWeight}, vec3(all.m_force), 1e-5 * kBeamWeight);
    btAlignedObjectArray<btVector3> perNode;
    ASSERT_TRUE(m_world.fem().getReactionForces(&beam, perNode));
    Vec3 sum;
    for (int i = 0; i < perNode.size(); ++i)
    {
        sum += vec3(perNode[i]);
        EXPECT_EQ(0, perNode[i].distance(m_world.fem().reactionForce(&beam, i)));
        EXPECT_EQ(beam.m_nodes[i].m_im == 0, perNode[i].length() > 0) << i;
    }
    expectNear(vec3(all.m_force), sum, 1e-5 * kBeamWeight);
}

TEST_P(ReactionsAtRest, ClampBearsTheMomentOfTheWeight)
{
    btSoftBody& beam = addBeam(btScalar(1e9), {-1, -1, -1}, {-1, 1, 1});
    m_world.step(240);
    const Vec3 clamp = {-1, 0, 0};
    const btFemReaction all = m_world.fem().reaction(&beam, bulletVector(clamp));
    Vec3 ofWeight;
    for (int i = 0; i < beam.m_nodes.size(); ++i)
        ofWeight += cross(vec3(beam.m_nodes[i].m_x) - clamp, Vec3{0, 0, -m_mass[i] * kGravity});
    expectNear({0, 0, kBeamWeight}, vec3(all.m_force), 1e-5 * kBeamWeight);
    expectNear(-ofWeight, vec3(all.m_moment), 2e-5 * kBeamWeight);
    expectNear({0, -kBeamWeight, 0}, vec3(all.m_moment), 1e-3 * kBeamWeight);  // m g L / 2, L = 2 m, nearly straight
}

TEST_P(ReactionsAtRest, SupportsShareALoadByTheLever)
{
    btSoftBody& bridge = addBeam(btScalar(1e7), {-1, -1, 0}, {-1, 1, 0});
    const std::vector<int> left = nodesWithin(bridge, {-1, -1, 0}, {-1, 1, 0});
    const std::vector<int> right = nodesWithin(bridge, {1, -1, 0}, {1, 1, 0});
    pin(bridge, right);
    const int loaded = nodesWithin(bridge, {-0.5, 0, 0.25}, {-0.5, 0, 0.25}).at(0);
    const double load = 2000;  // a quarter of the way from the left [N]
    for (int k = 0; k < 240; ++k)
    {
        bridge.addForce({0, 0, btScalar(-load)}, loaded);
        m_world.step();
    }
    const auto carries = [&](const std::vector<int>& nodes) {
        return double(m_world.fem().reaction(&bridge, nodes.data(), int(nodes.size()), {0, 0, 0}).m_force.z());
    };
    EXPECT_NEAR(kBeamWeight / 2 + 0.75 * load, carries(left), 2e-3 * kBeamWeight);
    EXPECT_NEAR(kBeamWeight / 2 + 0.25 * load, carries(right), 2e-3 * kBeamWeight);
}

TEST_P(ReactionsAtRest, PinsAndContactCarryTheWeightTogether)
{
    btSoftBody& beam = addBeam(btScalar(1e6), {-1, -1, -1}, {-1, 1, 1});
    RigidSettings under;
    under.m_transform = at(btScalar(0.8), 0, btScalar(-0.36));
    addRigidBox(m_world, {0.2, 2, 0.2}, under);
    ReactionBalance balance(m_world.fem(), beam, m_mass);
    for (int k = 0; k < 240; ++k)
    {
        balance.note();
        m_world.step();
        const ReactionBalance::Error error = balance.error();
        expectNear({}, error.m_force, 2e-4 * kBeamWeight);
    }
    ASSERT_GT(m_world.fem().contacts(&beam).size(), 0);
    EXPECT_GT(double(impulseOn(m_world.fem(), beam).z / double(kStep)), 0.1 * kBeamWeight);
}

TEST_P(ReactionsAtRest, NothingIsKnownOfOtherBodies)
{
    btSoftBody& beam = addBeam(btScalar(1e6), {-1, -1, 0.25}, {1, 1, 1});
    btFemSoftBodySolver& fem = m_world.fem();
    btAlignedObjectArray<btVector3> perNode;
    const auto expectNothing = [&](const btSoftBody* body)
    {
        perNode.resize(2);
        EXPECT_FALSE(fem.getReactionForces(body, perNode));
        EXPECT_EQ(0, perNode.size());
        EXPECT_EQ(0, fem.reactionForce(body, 0).length());
        const btFemReaction all = fem.reaction(body, {1, 2, 3});
        EXPECT_EQ(0, all.m_count);
        EXPECT_EQ(0, all.m_force.length() + all.m_moment.length());
        EXPECT_EQ(0, fem.anchorReaction(body, nullptr, {0, 0, 0}).m_count);
    };
    expectNothing(nullptr);
    expectNothing(&beam);  // not stepped yet
    btSoftBody rope(&m_world.info());
    expectNothing(&rope);
    m_world.step();
    const int pinned = nodesWithin(beam, {-1, -1, 0.25}, {1, 1, 1}).at(0);
    EXPECT_GT(fem.reactionForce(&beam, pinned).length(), 0);
    for (const int node : {-1, beam.m_nodes.size(), 1 << 30}) EXPECT_EQ(0, fem.reactionForce(&beam, node).length());
    const int some[] = {-5, pinned, 1 << 30};
    EXPECT_EQ(1, fem.reaction(&beam, some, 3, {0, 0, 0}).m_count);
    EXPECT_EQ(0, fem.reaction(&beam, nullptr, 3, {0, 0, 0}).m_count);
    beam.setMass(nodesWithin(beam, {-1, -1, -0.1}, {1, 1, 0.1}).at(0), 0);
    fem.refactor(&beam);  // to include the new pin
    expectNothing(&beam);
    m_world.step();
    EXPECT_GT(fem.reactionForce(&beam, pinned).length(), 0);
}

INSTANTIATE_TEST_SUITE_P(Worlds, ReactionsAtRest, eachWorld(), nameOfWorld);

TEST(Reactions, SleepingBodyKeepsItsLastOnes)
{
    btFemSoftBodySolver fem(implicitEuler());
    SoftWorld world(fem);
    btSoftBody& beam = addSoftBox(world, fem, shortBeam());
    pin(beam, nodesWithin(beam, {-1, -1, 0.25}, {1, 1, 1}));
    beam.forceActivationState(ACTIVE_TAG);
    for (int k = 0; k < 1200 && beam.isActive(); ++k) world.step();
    ASSERT_EQ(ISLAND_SLEEPING, beam.getActivationState());
    const btFemReaction before = fem.reaction(&beam, {0, 0, 0});
    EXPECT_NEAR(kBeamWeight, double(before.m_force.z()), 1e-4 * kBeamWeight);
    world.step(10);
    ASSERT_EQ(ISLAND_SLEEPING, beam.getActivationState());
    EXPECT_EQ(0, before.m_force.distance(fem.reaction(&beam, {0, 0, 0}).m_force));
}

TEST(Reactions, AskingChangesNoBitOfTheMotion)
{
    const auto run = [](bool asks)
    {
        btFemSoftBodySolver fem;
        SoftWorld world(fem);
        btSoftBody& beam = addSoftBox(world, fem, shortBeam(btScalar(2e5)));
        pin(beam, nodesWithin(beam, {-1, -1, -1}, {-1, 1, 1}));
        double sum = 0;
        for (int k = 0; k < 60; ++k)
        {
            world.step();
            if (asks) sum += double(fem.reaction(&beam, {0, 0, 0}).m_force.z());
        }
        EXPECT_EQ(asks, sum > 0);
        return bitsOf(beam);
    };
    EXPECT_EQ(run(false), run(true));
}

TEST(Reactions, BodyOnTargetsReactsWithItsInertia)
{
    btFemSoftBodySolver fem(implicitEuler());
    SoftWorld world(fem);
    btSoftBody& beam = addSoftBox(world, fem, shortBeam(btScalar(1e8)));
    fem.prepare(&beam, kStep);
    const std::vector<int> led = nodesWithin(beam, {-1, -1, -1}, {-1, 1, 1});
    std::vector<btVector3> places;
    for (int i : led) places.push_back(beam.m_nodes[i].m_x);
    const double acceleration = 3;  // along x [m/s2]
    for (int k = 1; k <= 180; ++k)
    {
        std::vector<btVector3> now = places;
        for (btVector3& place : now) place.setX(place.x() + btScalar(acceleration * 0.5 * k * k / 3600));
        fem.setNodeTargets(&beam, led.data(), int(led.size()), now.data());
        world.step();
    }
    const btFemReaction all = fem.reaction(&beam, led.data(), int(led.size()), beam.m_nodes[led[0]].m_x);
    EXPECT_EQ(9, all.m_count);
    expectNear({500 * acceleration, 0, kBeamWeight}, vec3(all.m_force), 2e-3 * kBeamWeight);
}

class AnchorReactions : public testing::TestWithParam<Coupling>
{
};

TEST_P(AnchorReactions, EqualTheLoadsOnTheRigidBody)
{
    AnchorScene scene(GetParam());
    btSoftBody& cube = scene.addCube({0, 0, 0});
    btRigidBody& hook = scene.addBox(0, {0, 0, btScalar(0.5)});
    btRigidBody& load = scene.addBox(40, {0, 0, btScalar(-0.5)});
    AnchorScene::anchorAll(cube, AnchorScene::nodesAt(cube, AnchorScene::kHalf), hook);
    AnchorScene::anchorAll(cube, AnchorScene::nodesAt(cube, -AnchorScene::kHalf), load);
    for (int k = 0; k < 120; ++k)
    {
        const Vec3 before = vec3(load.getLinearVelocity());
        scene.m_world.step();
        const btFemReaction onCube = scene.m_fem.anchorReaction(&cube, &load, load.getCenterOfMassPosition());
        const Vec3 gained = (40 / double(kStep)) * (vec3(load.getLinearVelocity()) - before);
        expectNear(gained - Vec3{0, 0, -40 * kGravity}, -vec3(onCube.m_force), 0.5);
        EXPECT_EQ(9, onCube.m_count);
    }
    scene.m_world.step(300);
    const btFemReaction ofHook = scene.m_fem.anchorReaction(&cube, &hook, {1, 0, 0});
    const double weight = AnchorScene::kCubeWeight + 40 * kGravity;
    expectNear({0, 0, weight}, vec3(ofHook.m_force), 1e-2 * weight);
    expectNear({0, weight, 0}, vec3(ofHook.m_moment), 1e-2 * weight);  // at an arm of a metre
    EXPECT_EQ(0, scene.m_fem.anchorReaction(&cube, nullptr, {0, 0, 0}).m_count);
}

INSTANTIATE_TEST_SUITE_P(Couplings, AnchorReactions, testing::Values(Coupling::swap, Coupling::coupled),
                         [](const auto& suite) { return couplingName(suite.param); });

}  // namespace
}  // namespace bullet_fem
