// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

btSoftBody& addSlab(SoftWorld& world, btFemSoftBodySolver& fem, btScalar lowest, btScalar cell)
{
    btSoftBody* slab = btFemHelpers::createBox(world.info(), btVector3(0, 0, lowest + btScalar(0.25)),
                                               btVector3(btScalar(0.5), btScalar(0.5), btScalar(0.25)), cell);
    btFemMaterial material;
    material.m_youngModulus = btScalar(2e5);
    fem.setMaterial(slab, material);
    slab->m_cfg.kDF = btScalar(0.5);
    return world.addSoft(slab);
}

class RigidDroppedOnSoft : public testing::TestWithParam<double>
{
};

TEST_P(RigidDroppedOnSoft, StaysOnTopAndTheGroundGetsTheWholeMomentum)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem);
    btRigidBody& ground = world.addPlane();
    btSoftBody& slab = addSlab(world, fem, btScalar(0.001), btScalar(0.25));
    RigidSettings settings;
    settings.m_mass = btScalar(GetParam() * massOf(slab));
    settings.m_transform = at(0, 0, btScalar(0.9));
    btRigidBody& stone =
        world.addRigid(new btBoxShape(btVector3(btScalar(0.2), btScalar(0.2), btScalar(0.2))), settings);
    const double mass = massOf(slab) + settings.m_mass;

    double groundImpulse = 0, stoneForce = 0;
    const int steps = 240, last = 60;
    for (int k = 0; k < steps; ++k)
    {
        world.step();
        groundImpulse += impulseOn(fem, slab, &ground).z;
        if (k >= steps - last) stoneForce += fem.contactForce(&slab, &stone).z() / last;
        ASSERT_GT(stone.getCenterOfMassPosition().z(), 0.2);
    }
    const double gained = motionOf(slab).m_linear.z + motionOf(stone).m_linear.z;
    const double given = steps * double(kStep) * mass * kGravity;
    EXPECT_NEAR(gained, groundImpulse - given, 1e-5 * given);
    EXPECT_NEAR(stoneForce, -settings.m_mass * kGravity, 0.01 * settings.m_mass * kGravity);
    EXPECT_GT(stone.getCenterOfMassPosition().z(), 0.55);  // its lower face was at .5, less what the slab yields
    EXPECT_LT(stone.getLinearVelocity().length(), 1e-4);
}

INSTANTIATE_TEST_SUITE_P(MassRatios, RigidDroppedOnSoft, testing::Values(0.01, 0.1, 1.0),
                         [](const auto& scene) { return "percent" + std::to_string(int(100 * scene.param + 0.5)); });

/// A kinematic box with its upper face at z = 0 when it starts.
class KinematicTable
{
public:
    explicit KinematicTable(SoftWorld& world) : m_world(world)
    {
        RigidSettings settings;
        settings.m_transform = at(0, 0, -1);
        m_body = &world.addRigid(new btBoxShape(btVector3(3, 3, 1)), settings);
        m_body->setCollisionFlags(m_body->getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    }

    void moveAndStep(const btVector3& velocity)
    {
        btTransform transform;
        m_body->getMotionState()->getWorldTransform(transform);
        transform.setOrigin(transform.getOrigin() + kStep * velocity);
        m_body->getMotionState()->setWorldTransform(transform);
        m_world.step();
    }
    double top() const { return m_body->getWorldTransform().getOrigin().z() + 1; }
    btRigidBody& body() { return *m_body; }

private:
    SoftWorld& m_world;
    btRigidBody* m_body;
};

TEST(KinematicBox, LiftsASoftBody)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem);
    KinematicTable table(world);
    btSoftBody& slab = addSlab(world, fem, btScalar(0.001), btScalar(0.25));
    for (int k = 0; k < 120; ++k) table.moveAndStep(btVector3(0, 0, 0));
    double force = 0, deepest = 0;
    for (int k = 0; k < 120; ++k)
    {
        table.moveAndStep(btVector3(0, 0, btScalar(0.5)));
        deepest = std::max(deepest, table.top() - lowestHeight(slab));
        if (k >= 60) force += fem.contactForce(&slab, &table.body()).z() / 60;
    }
    EXPECT_LT(deepest, 1e-3);
    EXPECT_NEAR(velocityOf(slab).z, 0.5, 0.005);
    EXPECT_NEAR(force, massOf(slab) * kGravity, 0.01 * massOf(slab) * kGravity);
}

TEST(KinematicBox, DragsASoftBodyByFriction)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem);
    KinematicTable table(world);
    btSoftBody& slab = addSlab(world, fem, btScalar(0.001), btScalar(0.25));
    for (int k = 0; k < 120; ++k) table.moveAndStep(btVector3(0, 0, 0));
    // After a sudden start the table slides under the body, which accelerates by mu g and then moves with the table.
    for (int k = 0; k < 12; ++k) table.moveAndStep(btVector3(2, 0, 0));
    EXPECT_NEAR(velocityOf(slab).x, 0.5 * kGravity * 12 * kStep, 0.02 * 0.5 * kGravity * 12 * kStep);
    for (int k = 0; k < 90; ++k) table.moveAndStep(btVector3(2, 0, 0));
    EXPECT_NEAR(velocityOf(slab).x, 2, 0.01 * 2);
    EXPECT_NEAR(centerOf(slab).y, 0, 1e-3);
}

/// A slab with cells of half a metre and a fixed lower face, without gravity; and a triangle of its upper face.
class CoarseSlab
{
public:
    CoarseSlab() : m_world(m_fem, btVector3(0, 0, 0))
    {
        m_slab = &addSlab(m_world, m_fem, 0, btScalar(0.5));
        clampBelow(*m_slab, 0.01);
        for (int f = 0; f < m_slab->m_faces.size(); ++f)
            if (middleOf(f).z() > btScalar(0.49)) m_face = f;
    }

    btVector3 middle() const { return middleOf(m_face); }

    // Height of a point above the triangle's plane.
    double heightOf(const btVector3& point) const
    {
        const btSoftBody::Face& face = m_slab->m_faces[m_face];
        const btVector3 &a = face.m_n[0]->m_x, &b = face.m_n[1]->m_x, &c = face.m_n[2]->m_x;
        const btVector3 normal = (b - a).cross(c - a).normalized();
        return std::fabs(normal.dot(point - a)) * (normal.dot(point - a) * normal.z() < 0 ? -1 : 1);
    }

    btFemSoftBodySolver m_fem;
    SoftWorld m_world;
    btSoftBody* m_slab;

private:
    btVector3 middleOf(int f) const
    {
        const btSoftBody::Face& face = m_slab->m_faces[f];
        return (face.m_n[0]->m_x + face.m_n[1]->m_x + face.m_n[2]->m_x) / 3;
    }
    int m_face = -1;
};

class HitBetweenNodes : public testing::TestWithParam<double>
{
};

TEST_P(HitBetweenNodes, SmallSphereDoesNotPass)
{
    CoarseSlab scene;
    const btScalar radius = btScalar(0.5 / 3), speed = btScalar(GetParam());
    RigidSettings settings;
    settings.m_mass = 20;
    settings.m_velocity = btVector3(0, 0, -speed);
    settings.m_transform.setOrigin(scene.middle() + btVector3(0, 0, radius + btScalar(0.3)));
    btRigidBody& sphere = scene.m_world.addRigid(new btSphereShape(radius), settings);
    int insideTriangle = 0;
    for (int k = 0; k < 60; ++k)
    {
        scene.m_world.step();
        const auto& contacts = scene.m_fem.contacts(scene.m_slab);
        for (int c = 0; c < contacts.size(); ++c)
            insideTriangle += *std::min_element(contacts[c].m_weights, contacts[c].m_weights + 3) > 0.2;
        ASSERT_GT(scene.heightOf(sphere.getCenterOfMassPosition()), 0.6 * radius) << "step " << k;
    }
    EXPECT_GT(insideTriangle, 0);
    EXPECT_GT(sphere.getLinearVelocity().z(), 0);
}

TEST_P(HitBetweenNodes, BoxCornerDoesNotPass)
{
    CoarseSlab scene;
    const btScalar half = btScalar(0.1), speed = btScalar(GetParam());
    RigidSettings settings;
    settings.m_mass = 20;
    settings.m_velocity = btVector3(0, 0, -speed);
    // One corner points down.
    settings.m_transform.setRotation(shortestArcQuat(btVector3(-1, -1, -1).normalized(), btVector3(0, 0, -1)));
    const btScalar reach = half * btSqrt(3);
    settings.m_transform.setOrigin(scene.middle() + btVector3(0, 0, reach + btScalar(0.3)));
    btRigidBody& box = scene.m_world.addRigid(new btBoxShape(btVector3(half, half, half)), settings);
    const btVector3 corner(-half, -half, -half);
    double lowest = 1;
    for (int k = 0; k < 60; ++k)
    {
        scene.m_world.step();
        lowest = std::min(lowest, scene.heightOf(box.getWorldTransform() * corner));
        ASSERT_GT(scene.heightOf(box.getCenterOfMassPosition()), 0.5 * half) << "step " << k;
    }
    EXPECT_LT(lowest, 0.02);   // there was contact
    EXPECT_GT(lowest, -half);  // and it was stopped
    EXPECT_GT(box.getLinearVelocity().z(), 0);
}

INSTANTIATE_TEST_SUITE_P(Speeds, HitBetweenNodes, testing::Values(1.0, 5.0, 20.0),
                         [](const auto& scene) { return std::to_string(int(scene.param)) + "mps"; });

}  // namespace
}  // namespace bullet_fem
