// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Heavy bodies on light soft links, and light ones on heavy links: anchors hold, and the energy never grows.
#include "plugin/motion/hanging_scene.h"

namespace bullet_fem
{
namespace
{

TEST_P(Hanging, HoldsItsLoad)
{
    hang(6);
}

const auto couplings = testing::Values(Coupling::swap, Coupling::coupled);
const auto loadings = testing::Values(Loading::slow, Loading::dropped);

INSTANTIATE_TEST_SUITE_P(
    MassRatios, Hanging,
    testing::Combine(couplings, loadings,
                     testing::Values(Chain{1e-3, 1e-3, 1, 60}, Chain{1e-3, 0.1, 1, 60}, Chain{1, 1e-2, 1, 60},
                                     Chain{30, 0.1, 1, 60}, Chain{300, 1e-3, 1, 60}, Chain{1000, 1e-3, 1, 60},
                                     Chain{1000, 1e-2, 1, 60}, Chain{1000, 0.1, 1, 60}, Chain{1000, 1e-3, 1, 240},
                                     Chain{1000, 0.1, 1, 240}, Chain{1000, 1e-2, 4, 60})),
    nameOf);
// Far beyond the range of the small-strain law anchors still hold.
class OverloadedLink : public testing::TestWithParam<Coupling>
{
};

TEST_P(OverloadedLink, IsStretchedToTwiceItsLengthAndHolds)
{
    HangingScene scene(GetParam(), {1000, 1, 1, 60});
    const double start = scene.energy();
    for (int k = 0; k < 600; ++k)
    {
        scene.step();
        ASSERT_LT(scene.energy() - start, 1e-6 * scene.m_mass * kGravity * kLength);
    }
    EXPECT_LT(scene.m_farthest, 0.01 * kLength);
    EXPECT_NEAR(scene.reaction() / (scene.m_mass * kGravity), 1, 0.02);
    EXPECT_NEAR(-scene.m_parts[0]->getCenterOfMassPosition().z(), 2 * kLength + 0.2, 0.1 * kLength);
}

INSTANTIATE_TEST_SUITE_P(Couplings, OverloadedLink, couplings,
                         [](const auto& suite) { return couplingName(suite.param); });

/// A soft block and a free cylinder anchored to each other in free space, until the program moves the block away.
class FarAnchors : public testing::TestWithParam<std::tuple<Coupling, int>>
{
};

TEST_P(FarAnchors, AreDrawnInWithoutGainingEnergy)
{
    const auto [coupling, seed] = GetParam();
    constexpr double kMass = 4.7, kAway = 2.6;  // [kg], [m]
    AnchorScene scene(coupling, btVector3(0, 0, 0));
    btSoftBody& block = scene.m_world.addSoft(
        btFemHelpers::createBox(scene.m_world.info(), btVector3(0, 0, 0),
                                btVector3(btScalar(0.06), btScalar(0.05), btScalar(0.15)), btScalar(0.05)));
    btFemMaterial material;
    material.m_youngModulus = btScalar(1e6);
    material.m_density = 1000;
    scene.m_fem.setMaterial(&block, material);
    btRigidBody& cylinder =
        scene.m_world.addRigid(new btCylinderShapeZ(btVector3(btScalar(0.1), btScalar(0.1), btScalar(0.15))),
                               {btScalar(kMass), at(0, 0, btScalar(0.3))});
    cylinder.setActivationState(DISABLE_DEACTIVATION);
    AnchorScene::anchorAll(block, AnchorScene::nodesAt(block, 0.15), cylinder);
    scene.m_world.step(10);
    const double turn = 2 * seed;  // unrelated directions
    block.translate(btScalar(kAway) * btVector3(btScalar(std::cos(turn)), btScalar(std::sin(turn)), 0));
    block.addVelocity(btVector3(btScalar(0.4 * std::sin(turn)), btScalar(0.3), btScalar(-0.3)));
    cylinder.setLinearVelocity(btVector3(btScalar(-0.3), btScalar(0.4), btScalar(0.2 * std::cos(turn))));
    cylinder.setAngularVelocity(btVector3(3, btScalar(2 * std::cos(turn)), -1));
    const auto energy = [&] { return motionOf(block).m_energy + motionOf(cylinder).m_energy; };
    const auto momentum = [&] { return motionOf(block).m_linear + motionOf(cylinder).m_linear; };
    const double start = energy(), together = 1 / (1 / massOf(block) + 1 / kMass);
    const Vec3 before = momentum();
    // The anchor closes the gap at a quarter of an edge per step, so that bodies reach that speed, and acts on rotating
    // bodies.
    const double pull = 0.25 * 0.1 / double(kStep), allowed = start + together * pull * pull;
    for (int k = 0; k < 300; ++k)
    {
        scene.m_world.step();
        ASSERT_LT(energy(), allowed) << k;
    }
    EXPECT_LT(scene.largestError(block), 1e-4);
    EXPECT_LT(norm(momentum() - before), 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Directions, FarAnchors, testing::Combine(couplings, testing::Values(0, 1, 2)),
                         [](const auto& suite) {
                             return couplingName(std::get<0>(suite.param)) + std::string("_") +
                                    std::to_string(std::get<1>(suite.param));
                         });

// Bullet's islands ignore anchors, and leave out bodies without contact response.
TEST(AnchorIslands, AreUnitedByAnchorsAlone)
{
    AnchorScene scene(Coupling::coupled);
    btSoftBody& cube = scene.addCube({0, 0, 0});
    btRigidBody& ceiling = scene.addBox(0, {0, 0, btScalar(2 * AnchorScene::kHalf)});
    btRigidBody& weight = scene.addBox(50, {0, 0, btScalar(-2 * AnchorScene::kHalf)});
    weight.setCollisionFlags(weight.getCollisionFlags() | btCollisionObject::CF_NO_CONTACT_RESPONSE);
    weight.setActivationState(DISABLE_DEACTIVATION);
    cube.setActivationState(DISABLE_DEACTIVATION);
    AnchorScene::anchorAll(cube, AnchorScene::nodesAt(cube, AnchorScene::kHalf), ceiling);
    AnchorScene::anchorAll(cube, AnchorScene::nodesAt(cube, -AnchorScene::kHalf), weight);
    for (int k = 0; k < 60; ++k)
    {
        scene.m_world.step();
        EXPECT_EQ(scene.m_fem.stepReport(&cube).m_flags & BT_FEM_SOLVED_AFTER, 0) << k;
    }
    EXPECT_NE(cube.getIslandTag(), weight.getIslandTag());
}

}  // namespace
}  // namespace bullet_fem
