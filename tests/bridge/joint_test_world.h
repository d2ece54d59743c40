// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <vector>

#include "BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h"
#include "BulletSoftBody/btSoftRigidDynamicsWorld.h"
#include "bridge/bridge_test_bodies.h"
#include "btBulletDynamicsCommon.h"
#include "bullet_bridge/joints/soft_joints.h"

namespace bullet_fem
{

/// A world that holds objects and is never stepped: soft cubes of 1 m, made FEM by hand, and rigid bodies.
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
        const TetMesh mesh = makeBox({1, 1, 1}, {2, 2, 2}, origin);
        btAlignedObjectArray<btVector3> positions;
        for (const Vec3& X : mesh.restPositions()) positions.push_back(bulletVector(X));
        m_soft.push_back(
            std::make_unique<btSoftBody>(&m_world.getWorldInfo(), positions.size(), &positions[0], nullptr));
        btSoftBody& soft = *m_soft.back();
        for (const Tet& t : mesh.tets()) soft.appendTetra(t[0], t[1], t[2], t[3]);
        soft.m_cfg.kAHR = 1;
        m_world.addSoftBody(&soft);
        const auto shape = std::make_shared<const RestShape>(tetMeshOf(soft), unsetMaterialOf(soft));
        const auto model = BodyModel::create(shape, factorInputOf(soft));
        m_fems.push_back(std::make_unique<FemSoftBody>(soft, model, makeComplianceCache(model)));
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

    /// Joints of all cubes that are not outside.
    ContactProblem& append(RigidPhase phase = RigidPhase::moved)
    {
        m_problem.clear();
        m_obstacles.clear(phase);
        m_joints.forgetWorld();
        m_joints.append({m_bodies, m_outside, m_obstacles, kStep, phase}, m_problem, m_flags);
        return m_problem;
    }

    btSoftRigidDynamicsWorld& world() { return m_world; }

    std::vector<FemSoftBody*> m_bodies, m_outside;
    RigidObstacles m_obstacles;
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

}  // namespace bullet_fem
