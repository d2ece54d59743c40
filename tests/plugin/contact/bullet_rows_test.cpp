// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Bullet's contacts between rigid bodies in islands with FEM bodies in contact, where they are solved as rows of the
// contact problem.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "plugin/scenes/kinematic_bodies.h"
#include "plugin/scenes/loaded_rigid_scene.h"

namespace bullet_fem
{
namespace
{

using Loaded = LoadedRigidScene;

constexpr Vec3 kTray = Loaded::kTray;
constexpr double kLoad = Loaded::kLoad;
constexpr double kMu = 0.5;  // friction of tray and ground

/// A tray on the ground, and a payload on it.
btRigidBody& addLoadedTray(Loaded& scene, double friction = kMu, const Vec3& velocity = {})
{
    return scene.addLoadedTray({0, 0, kTray.z / 2}, friction, velocity);
}

/// The normal impulses of Bullet's contacts on a body in the last step [N s], and the sum of their magnitudes.
struct NormalImpulse
{
    Vec3 m_sum;
    double m_total = 0;
};

NormalImpulse normalImpulseOn(Loaded& scene, const btRigidBody& body)
{
    btDispatcher& dispatcher = *scene.m_world.bullet().getDispatcher();
    NormalImpulse impulse;
    for (int k = 0; k < dispatcher.getNumManifolds(); ++k)
    {
        const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(k);
        if (manifold.getBody0() != &body && manifold.getBody1() != &body) continue;
        for (int p = 0; p < manifold.getNumContacts(); ++p)
        {
            const btManifoldPoint& point = manifold.getContactPoint(p);
            const double size = double(point.m_appliedImpulse);
            impulse.m_total += size;
            impulse.m_sum += (manifold.getBody0() == &body ? size : -size) * vec3(point.m_normalWorldOnB);
        }
    }
    return impulse;
}

/// Momentum of a tray and its payload [kg m/s].
Vec3 momentumOf(const Loaded& scene, const btRigidBody& tray)
{
    return motionOf(tray).m_linear + motionOf(*scene.m_softPayloads[0]).m_linear;
}

class BulletContacts : public testing::TestWithParam<Coupling>
{
};

TEST_P(BulletContacts, CarryAPayload)
{
    Loaded scene(GetParam());
    scene.m_world.addFloorBox();
    const btRigidBody& tray = addLoadedTray(scene);
    scene.m_world.step(120);
    const double weight = kLoad * kGravity, share = Loaded::kPayload / kLoad;
    EXPECT_NEAR(impulseOn(scene.m_world.fem(), *scene.m_softPayloads[0]).z / kStep, share * weight, 1e-3 * weight);
    EXPECT_NEAR(normalImpulseOn(scene, tray).m_sum.z / kStep, weight, 1e-3 * weight);
    EXPECT_LT(tray.getLinearVelocity().length(), 1e-4);
    EXPECT_LT(tray.getAngularVelocity().length(), 1e-3);
}

struct TrayCase
{
    const char* m_name;
    Vec3 m_direction;
    btVector3 m_anisotropy;
    double m_share;  // of kMu
};

class SlidingTray : public testing::TestWithParam<TrayCase>
{
};

TEST_P(SlidingTray, HasCoulombsFrictionInEveryStep)
{
    btFemSolverInfo info;
    info.m_contactTolerance = btScalar(1e-4);
    Loaded scene(Coupling::coupled, Loaded::Payload::soft, {0, 0, btScalar(-kGravity)}, info);
    scene.m_world.addFloorBox();
    const Vec3 along = GetParam().m_direction, across = {along.y, along.x, 0};
    btRigidBody& tray = addLoadedTray(scene, kMu, 3 * along);
    tray.setAnisotropicFriction(GetParam().m_anisotropy);
    const double rounding = 0.01 * kLoad * kGravity * double(kStep);  // axes of anisotropic friction turn [N s]
    double total = 0;
    for (int k = 0; k < 24; ++k)
    {
        const Vec3 before = momentumOf(scene, tray);
        scene.m_world.step();
        const NormalImpulse normal = normalImpulseOn(scene, tray);
        const Vec3 friction = momentumOf(scene, tray) - before - normal.m_sum;
        EXPECT_NEAR(dot(friction, along), -GetParam().m_share * kMu * normal.m_total, rounding) << k;
        EXPECT_NEAR(dot(vec3(tray.getLinearVelocity()), across), 0, 0.05) << k;
        total += normal.m_total;
    }
    EXPECT_NEAR(total, 24 * kLoad * kGravity * kStep, 0.05 * total);
    EXPECT_TRUE(scene.touches());
}

INSTANTIATE_TEST_SUITE_P(Directions, SlidingTray,
                         testing::Values(TrayCase{"isotropic", {1, 0, 0}, {1, 1, 1}, 1},
                                         TrayCase{"rough", {1, 0, 0}, {1, btScalar(0.1), 1}, 1},
                                         TrayCase{"smooth", {0, 1, 0}, {1, btScalar(0.1), 1}, 0.1},
                                         TrayCase{"frictionless", {0, 1, 0}, {1, 0, 1}, 0}),
                         [](const auto& suite) { return suite.param.m_name; });

/// A ball on a heavy plank on the ground that carries a payload, too.
struct PlankAndBall
{
    static constexpr double kRadius = 0.1, kBallMass = 1;                    // [m], [kg]
    static constexpr Vec3 kPlank = {3, 0.6, 0.05};                           // edges [m]
    static constexpr double kInertia = 0.4 * kBallMass * kRadius * kRadius;  // [kg m2]

    PlankAndBall(Coupling coupling, Loaded::Payload payload, double height = 0)
        : m_scene(coupling, payload), m_plank(&addPlank())
    {
        RigidSettings settings;
        settings.m_mass = btScalar(kBallMass);
        settings.m_transform = at(-1, 0, btScalar(kPlank.z + kRadius + height));
        m_ball = &m_scene.m_world.addRigid(new btSphereShape(btScalar(kRadius)), settings);
        m_scene.addPayload({1.3, 0.2, kPlank.z});
    }

    btRigidBody& addPlank()
    {
        m_scene.m_world.addFloorBox();
        return m_scene.addBox(kPlank, 200, {0, 0, kPlank.z / 2});
    }

    // Rolling and spinning friction between ball and plank [m].
    void setTorsionalFriction(double rolling, double spinning) const
    {
        m_ball->setRollingFriction(btScalar(rolling));
        m_ball->setSpinningFriction(btScalar(spinning));
        m_plank->setRollingFriction(1);
        m_plank->setSpinningFriction(1);
    }

    Loaded m_scene;
    btRigidBody *m_plank, *m_ball;
};

// On a slope of 0.9 times the friction angle's tangent.
TEST_P(BulletContacts, StickWithinTheCone)
{
    const double slope = std::atan(0.9 * kMu);
    Loaded scene(GetParam(), Loaded::Payload::soft,
                 {btScalar(kGravity * std::sin(slope)), 0, btScalar(-kGravity * std::cos(slope))});
    scene.m_world.addFloorBox();
    const btRigidBody& tray = addLoadedTray(scene);
    scene.m_world.step(30);
    const double before = double(tray.getCenterOfMassPosition().x());
    scene.m_world.step(60);
    EXPECT_NEAR(double(tray.getCenterOfMassPosition().x()), before, 1e-4);
}

TEST_P(BulletContacts, BrakeARollingBallAsInBulletsWorld)
{
    PlankAndBall ours(GetParam(), Loaded::Payload::soft), twin(Coupling::swap, Loaded::Payload::rigid);
    for (PlankAndBall* scene : {&ours, &twin})
    {
        scene->m_ball->setLinearVelocity({1, 0, 0});
        scene->m_ball->setAngularVelocity({0, btScalar(1 / PlankAndBall::kRadius), 0});
        scene->setTorsionalFriction(0.005, 0.005);
        scene->m_scene.m_world.step(60);
    }
    ASSERT_LT(twin.m_ball->getLinearVelocity().x(), 0.8);
    EXPECT_TRUE(ours.m_scene.touches());
    EXPECT_NEAR(ours.m_ball->getLinearVelocity().x(), twin.m_ball->getLinearVelocity().x(), 0.02);
    EXPECT_NEAR(ours.m_ball->getAngularVelocity().y(), twin.m_ball->getAngularVelocity().y(), 0.2);
}

TEST_P(BulletContacts, BrakeASpinningBallAsInBulletsWorld)
{
    PlankAndBall ours(GetParam(), Loaded::Payload::soft), twin(Coupling::swap, Loaded::Payload::rigid);
    for (PlankAndBall* scene : {&ours, &twin})
    {
        scene->m_ball->setAngularVelocity({0, 0, 10});
        scene->setTorsionalFriction(0.002, 0.001);
        scene->m_scene.m_world.step(60);
    }
    ASSERT_LT(twin.m_ball->getAngularVelocity().z(), 9);
    EXPECT_NEAR(ours.m_ball->getAngularVelocity().z(), twin.m_ball->getAngularVelocity().z(), 0.1);
}

// With the speed of Bullet's position correction in addition.
TEST_P(BulletContacts, ReboundAsInBulletsWorld)
{
    PlankAndBall ours(GetParam(), Loaded::Payload::soft, 0.3), twin(Coupling::swap, Loaded::Payload::rigid, 0.3);
    for (PlankAndBall* scene : {&ours, &twin})
    {
        scene->m_ball->setRestitution(btScalar(0.5));
        scene->m_plank->setRestitution(1);
    }
    double down = 0, up = 0;
    for (int k = 0; k < 30 && !(up > 0); ++k)
    {
        for (PlankAndBall* scene : {&ours, &twin}) scene->m_scene.m_world.step();
        up = double(twin.m_ball->getLinearVelocity().z());
        down = std::max(down, -up);
        EXPECT_NEAR(ours.m_ball->getLinearVelocity().z(), up, 2e-3) << k;
    }
    EXPECT_GT(down, 2);
    EXPECT_GT(up, 0.5 * down);
    EXPECT_LT(ours.m_plank->getLinearVelocity().length(), 5e-3);
}

INSTANTIATE_TEST_SUITE_P(Couplings, BulletContacts, testing::Values(Coupling::swap, Coupling::coupled),
                         [](const auto& suite) { return couplingName(suite.param); });

TEST_P(BulletContacts, SinkByTheirStiffness)
{
    constexpr double kStiffness = 1000, kPoints = 4;  // of each contact point [N/m]
    Loaded scene(GetParam());
    scene.m_world.addFloorBox();
    btRigidBody& tray = addLoadedTray(scene);
    tray.setContactStiffnessAndDamping(btScalar(kStiffness), 20);
    scene.m_world.step(240);
    const double sink = kLoad * kGravity / (kPoints * kStiffness);
    EXPECT_NEAR(kTray.z / 2 - double(tray.getCenterOfMassPosition().z()), sink, 0.02 * sink);
    EXPECT_LT(tray.getLinearVelocity().length(), 1e-3);
}

TEST_P(BulletContacts, AreCarriedByAKinematicBody)
{
    Loaded scene(GetParam());
    constexpr double kSpeed = 0.5;
    btRigidBody& ground = addKinematicBox(scene.m_world, {4, 2, 0.2}, at(0, 0, btScalar(-0.1)));
    const btRigidBody& tray = addLoadedTray(scene, 1, {kSpeed, 0, kSpeed});
    Vec3 start;
    for (int k = 1; k <= 60; ++k)
    {
        if (k == 31) start = vec3(tray.getCenterOfMassPosition());
        const double way = kSpeed * k * double(kStep);
        ground.getMotionState()->setWorldTransform(at(btScalar(way), 0, btScalar(way - 0.1)));
        scene.m_world.step();
    }
    EXPECT_TRUE(scene.touches());
    EXPECT_LT(norm(vec3(tray.getLinearVelocity()) - Vec3{kSpeed, 0, kSpeed}), 5e-3);
    EXPECT_LT(norm(vec3(tray.getCenterOfMassPosition()) - start - 0.5 * Vec3{kSpeed, 0, kSpeed}), 2e-3);
    EXPECT_LT(norm(velocityOf(*scene.m_softPayloads[0]) - Vec3{kSpeed, 0, kSpeed}), 5e-3);
}

// A tower of soft cubes of 1 kg and plates of a fiftieth of it.
TEST_P(BulletContacts, LetATowerWithLightPlatesStandAndSleep)
{
    Loaded scene(GetParam());
    scene.m_world.addFloorBox();
    constexpr double kPlate = 0.02;  // thickness [m], and mass [kg]
    std::vector<btRigidBody*> plates;
    for (int k = 0; k < 5; ++k)
    {
        const double height = k * (kPlate + Loaded::kEdge);
        plates.push_back(&scene.addBox({0.12, 0.12, kPlate}, kPlate, {0, 0, height + kPlate / 2}));
        scene.addPayload({0, 0, height + kPlate});
        plates.back()->forceActivationState(ACTIVE_TAG);
        scene.m_softPayloads.back()->forceActivationState(ACTIVE_TAG);
    }
    scene.m_world.step(300);
    for (const btRigidBody* plate : plates) EXPECT_EQ(plate->getActivationState(), ISLAND_SLEEPING);
    const Vec3 top = centerOf(*scene.m_softPayloads.back());
    EXPECT_LT(std::hypot(top.x, top.y), 1e-3);
    EXPECT_NEAR(top.z, 5 * (kPlate + Loaded::kEdge) - Loaded::kEdge / 2, 0.02);
}

// The most dissipative friction within the ellipse: it is nearly that of the rough direction.
TEST_P(BulletContacts, BrakeADiagonalSlideMostAlongTheRoughDirection)
{
    Loaded scene(GetParam());
    scene.m_world.addFloorBox();
    btRigidBody& tray = addLoadedTray(scene, kMu, {2, 2, 0});
    tray.setAnisotropicFriction({1, btScalar(0.1), 1});
    const Vec3 before = momentumOf(scene, tray);
    scene.m_world.step();
    const Vec3 friction = momentumOf(scene, tray) - before;
    const double most = kMu * normalImpulseOn(scene, tray).m_total, length = std::hypot(1, 0.1);
    EXPECT_NEAR(friction.x, -most / length, 0.01 * most);
    EXPECT_NEAR(friction.y, -0.01 * most / length, 0.01 * most);
}

// A pyramid of ten rigid boxes, with a soft cube on top. Single boxes tremble at up to 40 mm/s; when depends on
// rounding.
TEST_P(BulletContacts, LetAPyramidStand)
{
    Loaded scene(GetParam());
    scene.m_world.addFloorBox();
    constexpr double kEdge = 0.2;  // of the boxes [m]
    std::vector<btRigidBody*> boxes;
    for (int row = 0; row < 4; ++row)
        for (int k = 0; k < 4 - row; ++k)
            boxes.push_back(
                &scene.addBox({kEdge, kEdge, kEdge}, 1, {1.05 * kEdge * (k + 0.5 * row), 0, kEdge * (row + 0.5)}, 0.6));
    const Vec3 top = vec3(boxes.back()->getCenterOfMassPosition());
    scene.addPayload(top + Vec3{0, 0, kEdge / 2});
    scene.m_world.step(180);
    EXPECT_TRUE(scene.touches());
    EXPECT_LT(norm(vec3(boxes.back()->getCenterOfMassPosition()) - top), 5e-3);
    for (const btRigidBody* box : boxes) EXPECT_LT(box->getLinearVelocity().length(), 0.05);
}

// Bullet's friction acts at points that are apart by the gap, so that it conserves no angular momentum.
class FlyingBoxes : public testing::TestWithParam<double>
{
};

// Rigid boxes fly at each other, one with a payload on it.
TEST_P(FlyingBoxes, KeepTheirMomenta)
{
    Loaded scene(Coupling::coupled, Loaded::Payload::soft, {0, 0, 0});
    const Vec3 cube = {0.2, 0.2, 0.2}, up = {0, 0, 1};
    const double friction = GetParam();
    const std::vector<btRigidBody*> boxes = {&scene.addBox(cube, 1, {0, 0, -0.1}, friction),
                                             &scene.addBox(cube, 3, {0.08, 0.03, 0.31}, friction),
                                             &scene.addBox(cube, 2, {0.21, 0.06, -0.05}, friction)};
    boxes[0]->setLinearVelocity(bulletVector(up));
    boxes[1]->setLinearVelocity(bulletVector(-1 * up));
    boxes[2]->setLinearVelocity({btScalar(-0.5), 0, 0});
    scene.addPayload({0, 0, 0.002}, up);
    const auto sum = [&]
    {
        Motion all = motionOf(*scene.m_softPayloads[0]);
        for (const btRigidBody* body : boxes) all += motionOf(*body);
        return all;
    };
    const Motion start = sum();
    int touching = 0;
    for (int k = 0; k < 60; ++k)
    {
        scene.m_world.step();
        const Motion now = sum();
        ASSERT_LT(norm(now.m_linear - start.m_linear), 1e-6 * norm(start.m_linear)) << k;
        ASSERT_LT(norm(now.m_angular - start.m_angular), (friction > 0 ? 5e-3 : 1e-5) * norm(start.m_angular)) << k;
        ASSERT_LT(now.m_energy, 1.001 * start.m_energy) << k;
        touching += scene.touches() && normalImpulseOn(scene, *boxes[2]).m_total > 0;
    }
    EXPECT_GT(touching, 0);
    EXPECT_GT(boxes[2]->getAngularVelocity().length(), 0.1);
}

INSTANTIATE_TEST_SUITE_P(Friction, FlyingBoxes, testing::Values(0, 0.5),
                         [](const auto& suite) { return suite.param > 0 ? "rough" : "smooth"; });

}  // namespace
}  // namespace bullet_fem
