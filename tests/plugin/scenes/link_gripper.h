// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "BulletDynamics/Featherstone/btMultiBodyJointMotor.h"
#include "plugin/scenes/multibody_scene.h"

namespace bullet_fem
{

/// A soft cube of 1 kg on a pedestal between the fingers of a gripper: a palm on a vertical slider with two fingers on
/// sliders along x, all motorised. Its fingers reach far below the cube.
template <class World>
class LinkGripper
{
public:
    static constexpr double kSpeed = 0.1;  ///< closing speed of its motors [m/s]

    /// force: maximum force of the fingers' motors [N].
    LinkGripper(World& world, btFemSoftBodySolver& fem, double force) : m_world(world), m_fem(fem)
    {
        RigidSettings settings;
        settings.m_transform = at(0, 0, btScalar(0.15));
        world.addRigid(new btBoxShape(btVector3(btScalar(0.04), btScalar(0.04), btScalar(0.15))), settings);
        SoftBox box;
        box.m_size = {0.1, 0.1, 0.1};
        box.m_center = {0, 0, 0.35};
        box.m_youngModulus = btScalar(1e5);
        m_cube = &world.addSoft(makeSoftBox(world.info(), fem, box));

        const btVector3 palm(btScalar(0.05), btScalar(0.05), btScalar(0.02)), none(0, 0, 0);
        const btVector3 finger(btScalar(0.02), btScalar(0.07), btScalar(0.13));
        m_hand = new btMultiBody(3, 0, none, true, false);
        m_hand->setBasePos(btVector3(0, 0, 1));
        m_hand->setupPrismatic(0, 1, boxInertia(1, palm), -1, kNoTurn, btVector3(0, 0, 1), none, none, false);
        for (const int side : {0, 1})
            m_hand->setupPrismatic(1 + side, 1, boxInertia(1, finger), 0, kNoTurn, btVector3(side ? -1 : 1, 0, 0),
                                   btVector3(btScalar(side ? 0.075 : -0.075), 0, btScalar(-0.65)), none, false);
        world.addMultiBody(m_hand);
        world.addCollider(*m_hand, 0, new btBoxShape(palm));  // Bullet ignores motors of links without a collider
        m_lift = &world.template addConstraint<btMultiBodyJointMotor>(m_hand, 0, btScalar(0), 1000 * kStep);
        for (const int side : {0, 1})
        {
            m_fingers[side] = &world.addCollider(*m_hand, 1 + side, new btBoxShape(finger));
            world.template addConstraint<btMultiBodyJointMotor>(m_hand, 1 + side, btScalar(kSpeed),
                                                                btScalar(force) * kStep);
        }
    }

    void liftAt(double speed) { m_lift->setVelocityTarget(btScalar(speed)); }
    btSoftBody& cube() { return *m_cube; }
    btMultiBody& hand() { return *m_hand; }
    Vec3 forceOf(int side) const { return vec3(m_fem.contactForce(m_cube, m_fingers[side])); }
    double fingerSpeed(int side) const { return m_hand->getJointVel(1 + side); }
    double fingerPlace(int side) const { return m_hand->getJointPos(1 + side); }
    double weight() const { return massOf(*m_cube) * kGravity; }

private:
    World& m_world;
    btFemSoftBodySolver& m_fem;
    btSoftBody* m_cube;
    btMultiBody* m_hand;
    btMultiBodyLinkCollider* m_fingers[2];
    btMultiBodyJointMotor* m_lift;
};

}  // namespace bullet_fem
