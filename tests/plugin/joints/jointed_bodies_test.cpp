// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Bodies of many of Bullet's joints that carry soft ones, or stand and fall on them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "BulletDynamics/ConstraintSolver/btGeneric6DofSpring2Constraint.h"
#include "plugin/scenes/loaded_rigid_scene.h"

namespace bullet_fem
{
namespace
{

// The last of ten links of 0.2 kg carries 12 kg: a tray with a soft block on it. A tension of more than m L / (3 h^2)
// is unstable in transverse vibration, in Bullet's own world, too: 288 N here.
TEST(Chain, CarriesAHeavySoftBody)
{
    constexpr int kLinks = 10;
    constexpr double kLength = 0.3, kLink = 0.2, kBlock = 10;  // [m], [kg], [kg]
    LoadedRigidScene scene(Coupling::coupled);
    std::vector<btRigidBody*> links;
    const btVector3 top(0, 0, btScalar(kLength / 2));
    for (int k = 0; k < kLinks; ++k)
    {
        links.push_back(&scene.addBox({0.05, 0.05, kLength}, kLink, {0, 0, -(k + 0.5) * kLength}));
        if (k == 0)
            scene.join<btPoint2PointConstraint>(*links[0], top);
        else
            scene.join<btPoint2PointConstraint>(*links[k - 1], *links[k], -top, top);
    }
    const double end = -kLinks * kLength;
    btRigidBody& tray = scene.addBox(LoadedRigidScene::kTray, LoadedRigidScene::kTrayMass, {0, 0, end - 1});
    scene.join<btPoint2PointConstraint>(*links.back(), tray, -top, btVector3(0, 0, 1));
    SoftBox block;
    block.m_size = {0.3, 0.3, 0.3};
    block.m_cells = {2, 2, 2};
    block.m_center = {0, 0, end - 1 + LoadedRigidScene::kTray.z / 2 + 0.15};
    block.m_density = btScalar(kBlock / 0.027);
    btSoftBody& soft = addSoftBox(scene.m_world, scene.m_world.fem(), block);
    double longest = 0;
    for (int k = 0; k < 120; ++k)
    {
        scene.m_world.step(1, btScalar(1) / 120);
        longest = std::max(longest, -double(tray.getCenterOfMassPosition().z()) + end - 1);
    }
    EXPECT_GT(scene.m_world.fem().contacts(&soft).size(), 0);
    EXPECT_LT(std::fabs(longest), 2e-3);
    const double weight = (kLinks * kLink + LoadedRigidScene::kTrayMass + kBlock) * kGravity;
    EXPECT_NEAR(LoadedRigidScene::forceOf(*scene.m_joints[0]).z, weight, 0.02 * weight);
}

// Six capsules with five cone-twist joints fall on a soft mat. No body's kinetic energy exceeds that of the fall, and
// the total energy does not grow.
TEST(Ragdoll, FallsOnASoftMat)
{
    LoadedRigidScene scene(Coupling::coupled);
    scene.m_world.addFloorBox();
    btSoftBody& soft = scene.addMat(8, 1e5);
    struct Limb
    {
        double m_radius, m_length, m_mass;
        Vec3 m_center, m_joint;  // the joint with the trunk [m]
    };
    constexpr double kHigh = 1.2;  // of the trunk [m]
    const std::vector<Limb> limbs = {{0.12, 0.4, 30, {0, 0, 0}, {}},
                                     {0.1, 0.05, 5, {0, 0, 0.45}, {0, 0, 0.32}},
                                     {0.05, 0.4, 4, {0.4, 0, 0.2}, {0.17, 0, 0.2}},
                                     {0.05, 0.4, 4, {-0.4, 0, 0.2}, {-0.17, 0, 0.2}},
                                     {0.07, 0.5, 10, {0.1, 0, -0.68}, {0.1, 0, -0.35}},
                                     {0.07, 0.5, 10, {-0.1, 0, -0.68}, {-0.1, 0, -0.35}}};
    std::vector<btRigidBody*> bodies;
    const btTransform lying(btQuaternion(btVector3(1, 0, 0), btScalar(1.2)), btVector3(0, 0, btScalar(kHigh)));
    for (const Limb& limb : limbs)
    {
        const bool isArm = limb.m_center.x * limb.m_center.x > 0.1;
        btCollisionShape* shape = new btCapsuleShapeZ(btScalar(limb.m_radius), btScalar(limb.m_length));
        if (isArm)
        {
            delete shape;
            shape = new btCapsuleShapeX(btScalar(limb.m_radius), btScalar(limb.m_length));
        }
        RigidSettings settings{btScalar(limb.m_mass)};
        settings.m_transform = lying * btTransform(btQuaternion::getIdentity(), bulletVector(limb.m_center));
        bodies.push_back(&scene.m_world.addRigid(shape, settings));
        if (bodies.size() == 1) continue;
        const btTransform onTrunk(btQuaternion::getIdentity(), bulletVector(limb.m_joint));
        const btTransform onLimb(btQuaternion::getIdentity(), bulletVector(limb.m_joint - limb.m_center));
        scene.join<btConeTwistConstraint>(*bodies[0], *bodies.back(), onTrunk, onLimb)
            .setLimit(btScalar(0.7), btScalar(0.7), btScalar(0.3));
    }
    const auto energy = [&]
    {
        double sum = motionOf(soft).m_energy + massOf(soft) * kGravity * centerOf(soft).z;
        for (const btRigidBody* body : bodies)
            sum += motionOf(*body).m_energy +
                   kGravity * double(body->getCenterOfMassPosition().z()) / double(body->getInvMass());
        return sum;
    };
    const double start = energy(), impact = std::sqrt(2 * kGravity * kHigh);
    int touching = 0;
    for (int k = 0; k < 90; ++k)
    {
        scene.m_world.step();
        touching += scene.m_world.fem().contacts(&soft).size() > 9;
        ASSERT_LT(energy(), 1.01 * start) << k;
        ASSERT_LT(fastestNode(soft), 2 * impact) << k;
        for (const btRigidBody* body : bodies) ASSERT_LT(double(body->getLinearVelocity().length()), 1.5 * impact) << k;
    }
    EXPECT_GT(touching, 40);
    for (const auto& joint : scene.m_joints)
    {
        const auto& cone = static_cast<const btConeTwistConstraint&>(*joint);
        const btVector3 apart = cone.getRigidBodyA().getCenterOfMassTransform() * cone.getAFrame().getOrigin() -
                                cone.getRigidBodyB().getCenterOfMassTransform() * cone.getBFrame().getOrigin();
        EXPECT_LT(apart.length(), 5e-3);
    }
    for (const btRigidBody* body : bodies) EXPECT_GT(body->getCenterOfMassPosition().z(), 0);
}

// A chassis of 200 kg that hangs between two wheels with soft tyres.
TEST(HingedHubs, CarryAHeavyChassis)
{
    constexpr double kChassis = 200, kHub = 5, kHeight = 0.2;  // [kg], [kg], of the axle [m]
    LoadedRigidScene scene(Coupling::coupled);
    scene.m_world.addFloorBox();
    btRigidBody& chassis = scene.addBox({0.3, 0.6, 0.1}, kChassis, {0, 0, kHeight - 0.05});
    const btVector3 axle(0, 1, 0);
    double weight = kChassis;
    for (const double side : {-1.0, 1.0})
    {
        const Vec3 center = {0, 0.45 * side, kHeight};
        btRigidBody& hub = scene.addBox({0.1, 0.1, 0.1}, kHub, center);
        scene.join<btHingeConstraint>(chassis, hub, bulletVector(center + Vec3{0, 0, 0.05 - kHeight}),
                                      btVector3(0, 0, 0), axle, axle);
        SoftBox tyre;
        tyre.m_size = {0.4, 0.1, 0.4};
        tyre.m_cells = {4, 1, 4};
        tyre.m_center = center;
        tyre.m_youngModulus = btScalar(3e6);
        btSoftBody& body = addSoftBox(scene.m_world, scene.m_world.fem(), tyre);
        scene.m_softPayloads.push_back(&body);
        for (int i = 0; i < body.m_nodes.size(); ++i)
        {
            const Vec3 r = vec3(body.m_nodes[i].m_x) - center;
            if (std::max(std::fabs(r.x), std::fabs(r.z)) < 0.11) body.appendAnchor(i, &hub, true);
        }
        weight += kHub + massOf(body);
    }
    double fastest = 0;
    for (int k = 0; k < 90; ++k)
    {
        scene.m_world.step();
        for (const btSoftBody* tyre : scene.m_softPayloads) fastest = std::max(fastest, fastestNode(*tyre));
    }
    EXPECT_LT(fastest, 1);
    double carried = 0;
    for (const btSoftBody* tyre : scene.m_softPayloads)
    {
        carried += impulseOn(scene.m_world.fem(), *tyre).z / double(kStep);
        EXPECT_EQ(scene.m_world.fem().stepReport(tyre).m_flags & BT_FEM_NOT_CONVERGED, 0);
    }
    EXPECT_NEAR(carried, weight * kGravity, 0.01 * weight * kGravity);
    for (const auto& joint : scene.m_joints)
        EXPECT_NEAR(std::fabs(LoadedRigidScene::forceOf(*joint).z), kChassis * kGravity / 2,
                    0.02 * kChassis * kGravity / 2);
    EXPECT_NEAR(double(chassis.getCenterOfMassPosition().z()), kHeight - 0.05, 0.02);
}

// Planks with two joints to each neighbour and to the banks, whose rows along the joints' line are dependent.
TEST(Bridge, SharesItsLoadAmongRedundantJoints)
{
    constexpr int kPlanks = 11;
    constexpr double kPitch = 0.32, kPlank = 5, kEndSlope = 0.4;  // [m], [kg], [rad]
    LoadedRigidScene scene(Coupling::coupled);
    std::vector<btRigidBody*> planks;
    Vec3 end;  // of the planks so far
    for (int k = 0; k < kPlanks; ++k)
    {
        const double slope = kEndSlope * (2.0 * k / (kPlanks - 1) - 1);
        const Vec3 half = 0.5 * kPitch * Vec3{std::cos(slope), 0, std::sin(slope)};
        RigidSettings settings{btScalar(kPlank)};
        settings.m_transform =
            btTransform(btQuaternion(btVector3(0, 1, 0), btScalar(-slope)), bulletVector(end + half));
        planks.push_back(&addRigidBox(scene.m_world, {0.3, 1, 0.04}, settings));
        end += 2 * half;
    }
    for (int k = 0; k <= kPlanks; ++k)
        for (const double side : {-0.4, 0.4})
        {
            const btVector3 left(btScalar(-kPitch / 2), btScalar(side), 0),
                right(btScalar(kPitch / 2), btScalar(side), 0);
            if (k == 0)
                scene.join<btPoint2PointConstraint>(*planks[0], left);
            else if (k == kPlanks)
                scene.join<btPoint2PointConstraint>(*planks.back(), right);
            else
                scene.join<btPoint2PointConstraint>(*planks[k - 1], *planks[k], right, left);
        }
    const Vec3 middle = vec3(planks[kPlanks / 2]->getCenterOfMassPosition());
    scene.addPayload(middle + Vec3{0, 0, 0.022});
    const double corner = (kPlanks * kPlank + LoadedRigidScene::kPayload) * kGravity / 4;  // vertical force [N]
    for (int k = 0; k < 120; ++k)
    {
        scene.m_world.step();
        if (k < 10) continue;
        for (int j : {0, 1, 2 * kPlanks, 2 * kPlanks + 1})
            ASSERT_NEAR(LoadedRigidScene::forceOf(*scene.m_joints[j]).z, corner, 0.05 * corner) << k;
    }
    EXPECT_TRUE(scene.touches());
    EXPECT_LT(norm(vec3(planks[kPlanks / 2]->getCenterOfMassPosition()) - middle), 0.02);
}

// Trees of rigid boxes with joints of tight limits fall on a soft mat: in every step some 30 limits are reached or
// left.
class TightLimits : public testing::TestWithParam<int>
{
};

TEST_P(TightLimits, NeverGiveMoreSpeedThanTheFall)
{
    constexpr int kBoxes = 8;
    std::mt19937 random(static_cast<unsigned>(GetParam()));
    const auto within = [&](double low, double high) { return low + (high - low) * (random() / 4294967296.0); };
    LoadedRigidScene scene(Coupling::coupled);
    scene.m_world.addFloorBox();
    const btSoftBody& soft = scene.addMat(5, 3e5);
    std::vector<btRigidBody*> boxes;
    std::vector<Vec3> centers;
    for (int k = 0; k < kBoxes; ++k)
    {
        centers.push_back({0.35 * (k % 3 - 1), 0.35 * (k / 3 - 1), within(0.4, 0.6)});
        boxes.push_back(&scene.addBox({within(0.1, 0.3), within(0.1, 0.3), within(0.1, 0.3)},
                                      std::pow(10, within(-0.5, 1)), centers[k], 0.7));
        if (k == 0) continue;
        const int parent = static_cast<int>(random() % static_cast<unsigned>(k));
        const Vec3 middle = 0.5 * (centers[k] + centers[parent]);
        const btQuaternion turn(btVector3(0, 1, 0), btScalar(within(0, 3)));
        auto& joint = scene.join<btGeneric6DofSpring2Constraint>(
            *boxes[parent], *boxes[k], btTransform(turn, bulletVector(middle - centers[parent])),
            btTransform(turn, bulletVector(middle - centers[k])));
        for (int axis = 0; axis < 6; ++axis) joint.setLimit(axis, btScalar(-within(0, 0.1)), btScalar(within(0, 0.1)));
    }
    const double fall = std::sqrt(2 * kGravity * 0.6);
    int touching = 0;
    for (int k = 0; k < 60; ++k)
    {
        scene.m_world.step();
        touching += scene.m_world.fem().contacts(&soft).size() > 4;
        for (const btRigidBody* box : boxes) ASSERT_LT(double(box->getLinearVelocity().length()), fall) << k;
    }
    EXPECT_GT(touching, 30);
}

INSTANTIATE_TEST_SUITE_P(Seeds, TightLimits, testing::Range(0, 4));

}  // namespace
}  // namespace bullet_fem
