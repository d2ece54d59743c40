// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h"
#include "BulletSoftBody/btSoftRigidDynamicsWorld.h"
#include "bridge/bridge_test_bodies.h"
#include "btBulletDynamicsCommon.h"
#include "bullet_bridge/joints/soft_joints.h"

namespace bullet_fem
{

/// A world that is never stepped, with soft FEM cubes of 1 m, prepared by hand, and rigid bodies.
class JointTestWorld
{
public:
    static constexpr double kStep = 1.0 / 60;

    ~JointTestWorld()
    {
        while (!m_rigid.empty()) deleteRigid(*m_rigid.back());
        for (auto& soft : m_soft) m_world.removeSoftBody(soft.get());
    }

    FemSoftBody& addCube(const Vec3& origin = {})
    {
        m_soft.push_back(makeSoftBody(m_world.getWorldInfo(), makeBox({1, 1, 1}, {2, 2, 2}, origin)));
        btSoftBody& soft = *m_soft.back();
        soft.m_cfg.kAHR = 1;
        m_world.addSoftBody(&soft);
        m_fems.emplace_back(new FemSoftBody(makeFemSoftBody(soft)));
        m_bodies.push_back(m_fems.back().get());
        return *m_fems.back();
    }

    btRigidBody& addRigid(btScalar mass, const btVector3& position = {0, 0, 0})
    {
        btTransform pose = btTransform::getIdentity();
        pose.setOrigin(position);
        auto* body = new btRigidBody(mass, nullptr, &m_box, btVector3(mass, mass, mass));
        body->setWorldTransform(pose);
        body->setInterpolationWorldTransform(pose);
        m_world.addRigidBody(body);
        body->setGravity(btVector3(0, 0, 0));
        m_rigid.push_back(body);
        return *body;
    }

    void deleteRigid(btRigidBody& body)
    {
        m_rigid.erase(std::find(m_rigid.begin(), m_rigid.end(), &body));
        m_world.removeRigidBody(&body);
        delete &body;
    }

    /// Appends the joints of all cubes that are not flagged as outside.
    ContactProblem& append(RigidPhase phase = RigidPhase::moved)
    {
        m_problem.clear();
        m_rigidProxies.clear(phase);
        m_joints.forgetWorld();
        m_joints.append({m_bodies, m_outside, m_rigidProxies, kStep}, m_problem, m_flags);
        return m_problem;
    }

    btSoftRigidDynamicsWorld& world() { return m_world; }

    std::vector<FemSoftBody*> m_bodies, m_outside;
    RigidProxies m_rigidProxies;
    std::vector<JointFlags> m_flags;

private:
    btSoftBodyRigidBodyCollisionConfiguration m_configuration;
    btCollisionDispatcher m_dispatcher{&m_configuration};
    btDbvtBroadphase m_broadphase;
    btSequentialImpulseConstraintSolver m_solver;
    btSoftRigidDynamicsWorld m_world{&m_dispatcher, &m_broadphase, &m_solver, &m_configuration};
    btBoxShape m_box{btVector3(btScalar(0.5), btScalar(0.5), btScalar(0.5))};
    std::vector<std::unique_ptr<btSoftBody>> m_soft;
    std::vector<std::unique_ptr<FemSoftBody>> m_fems;
    std::vector<btRigidBody*> m_rigid;
    SoftJoints m_joints;
    ContactProblem m_problem;
};

inline void expectNear(const Vec3& a, const Vec3& b, double tolerance)
{
    EXPECT_LT(norm(a - b), tolerance) << a.x << ' ' << a.y << ' ' << a.z;
}

/// Gives the only joint between `a` and `b` an impulse [N s]; each body must report its own, with opposite signs.
inline void expectOppositeImpulses(ContactProblem& problem, FemSoftBody& a, FemSoftBody& b, const Vec3& impulse)
{
    ASSERT_EQ(problem.m_joints.size(), 1u);
    problem.m_joints[0].m_impulse = impulse;
    SoftJoints::takeBack(a, problem);
    SoftJoints::takeBack(b, problem);
    ASSERT_EQ(a.m_joints.m_now.size(), 1u);
    ASSERT_EQ(b.m_joints.m_now.size(), 1u);
    expectNear(a.m_joints.m_now[0].m_impulse, impulse, 1e-12);
    expectNear(b.m_joints.m_now[0].m_impulse, -impulse, 1e-12);
}

}  // namespace bullet_fem
