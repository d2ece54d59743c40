// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "BulletDynamics/Featherstone/btMultiBody.h"
#include "BulletDynamics/Featherstone/btMultiBodyConstraint.h"
#include "BulletDynamics/Featherstone/btMultiBodyLinkCollider.h"
#include "BulletSoftBody/btDefaultSoftBodySolver.h"
#include "BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h"
#include "BulletSoftBody/btSoftMultiBodyDynamicsWorld.h"
#include "BulletSoftBody/btSoftRigidDynamicsWorld.h"
#include "bullet_fem/btFemConstraintSolver.h"
#include "bullet_fem/btFemMultiBodyConstraintSolver.h"
#include "demos/common/demo.h"

namespace bullet_fem
{

/// A Bullet world that owns its objects. Only its two solvers are BulletFEM's.
template <class World, class RigidSolver, class SoftSolver = btFemSoftBodySolver>
class DemoWorldOf
{
public:
    explicit DemoWorldOf(const btFemSolverInfo& info = btFemSolverInfo())
        : m_fem(info),
          m_rigidSolver(&m_fem),
          m_world(&m_dispatcher, &m_broadphase, &m_rigidSolver, &m_configuration, &m_fem)
    {
        m_configuration.setPlaneConvexMultipointIterations();  // otherwise boxes get one contact point with a plane
        m_world.setGravity(at(0, -kGravity, 0));
        m_world.getWorldInfo().m_gravity = m_world.getGravity();
    }

    ~DemoWorldOf()
    {
        for (const auto& joint : m_joints) m_world.removeConstraint(joint.get());
        for (const auto& motor : m_motors) removeMotor(*motor);
        for (const auto& soft : m_soft) m_world.removeSoftBody(soft.get());
        for (const auto& link : m_links) m_world.removeCollisionObject(link.get());
        for (const auto& marker : m_markers) m_world.removeCollisionObject(marker.get());
        for (const auto& body : m_multiBodies) removeMultiBody(*body);
        for (const auto& rigid : m_rigid) m_world.removeRigidBody(rigid.get());
    }
    DemoWorldOf(const DemoWorldOf&) = delete;
    DemoWorldOf& operator=(const DemoWorldOf&) = delete;

    World& bullet() { return m_world; }
    SoftSolver& fem() { return m_fem; }
    btSoftBodyWorldInfo& info() { return m_world.getWorldInfo(); }

    /// Adds a rigid body of that mass [kg], 0 for a static one; takes ownership of the shape.
    btRigidBody& addRigid(btCollisionShape* shape, double mass, const btTransform& pose, double friction = 1)
    {
        m_shapes.emplace_back(shape);
        btVector3 inertia(0, 0, 0);
        if (mass > 0) shape->calculateLocalInertia(btScalar(mass), inertia);
        btRigidBody::btRigidBodyConstructionInfo settings(btScalar(mass), nullptr, shape, inertia);
        settings.m_startWorldTransform = pose;
        settings.m_friction = btScalar(friction);
        m_rigid.push_back(std::make_unique<btRigidBody>(settings));
        m_world.addRigidBody(m_rigid.back().get());
        return *m_rigid.back();
    }
    btRigidBody& addRigid(btCollisionShape* shape, double mass, const btVector3& place, double friction = 1)
    {
        return addRigid(shape, mass, btTransform(btQuaternion::getIdentity(), place), friction);
    }

    /// The ground y = 0.
    btRigidBody& addGround(double friction = 1)
    {
        return addRigid(new btStaticPlaneShape(at(0, 1, 0), 0), 0, at(0, 0, 0), friction);
    }

    /// Takes ownership of a soft body, sets material and friction, and factors it for steps of `h` [s].
    btSoftBody& addSoft(btSoftBody* body, const btFemMaterial& material, double friction = 0.5, double h = kDemoStep)
    {
        m_soft.emplace_back(body);
        body->m_cfg.kDF = btScalar(friction);
        m_fem.setMaterial(body, material);
        m_fem.prepare(body, btScalar(h));
        m_world.addSoftBody(body);
        return *body;
    }
    /// Adds cloth or a rope that Bullet's own soft body solver simulates.
    btSoftBody& addCloth(btSoftBody* cloth)
    {
        m_soft.emplace_back(cloth);
        m_world.addSoftBody(cloth);
        return *cloth;
    }

    /// Adds a visible object without contact; takes ownership of the shape.
    btCollisionObject& addMarker(btCollisionShape* shape, const btVector3& place)
    {
        m_shapes.emplace_back(shape);
        m_markers.push_back(std::make_unique<btCollisionObject>());
        m_markers.back()->setCollisionShape(shape);
        m_markers.back()->setWorldTransform(btTransform(btQuaternion::getIdentity(), place));
        m_world.addCollisionObject(m_markers.back().get(), 0, 0);
        return *m_markers.back();
    }

    template <class Joint, class... Values>
    Joint& addJoint(Values&&... values)
    {
        auto joint = std::make_unique<Joint>(std::forward<Values>(values)...);
        Joint& added = *joint;
        m_joints.push_back(std::move(joint));
        m_world.addConstraint(&added, true);
        return added;
    }

    /// Takes ownership of a multibody whose links are set up.
    btMultiBody& addMultiBody(btMultiBody* body)
    {
        m_multiBodies.emplace_back(body);
        body->finalizeMultiDof();
        m_world.addMultiBody(body);
        return *body;
    }
    /// Gives a link its collision shape.
    btMultiBodyLinkCollider& addLink(btMultiBody& body, int link, btCollisionShape* shape, double friction = 1)
    {
        m_shapes.emplace_back(shape);
        m_links.push_back(std::make_unique<btMultiBodyLinkCollider>(&body, link));
        btMultiBodyLinkCollider& collider = *m_links.back();
        collider.setCollisionShape(shape);
        collider.setFriction(btScalar(friction));
        body.getLink(link).m_collider = &collider;
        btAlignedObjectArray<btQuaternion> turns;
        btAlignedObjectArray<btVector3> places;
        body.forwardKinematics(turns, places);
        body.updateCollisionObjectWorldTransforms(turns, places);
        m_world.addCollisionObject(&collider);
        return collider;
    }
    template <class Motor, class... Values>
    Motor& addMotor(Values&&... values)
    {
        auto motor = std::make_unique<Motor>(std::forward<Values>(values)...);
        Motor& added = *motor;
        m_motors.push_back(std::move(motor));
        added.finalizeMultiDof();
        m_world.addMultiBodyConstraint(&added);
        return added;
    }

private:
    // Only worlds with multibodies have motors.
    void removeMotor(btMultiBodyConstraint& motor)
    {
        if constexpr (kHasLinks) m_world.removeMultiBodyConstraint(&motor);
    }
    void removeMultiBody(btMultiBody& body)
    {
        if constexpr (kHasLinks) m_world.removeMultiBody(&body);
    }
    static constexpr bool kHasLinks = std::is_base_of_v<btMultiBodyDynamicsWorld, World>;

    btSoftBodyRigidBodyCollisionConfiguration m_configuration;
    btCollisionDispatcher m_dispatcher{&m_configuration};
    btDbvtBroadphase m_broadphase;
    SoftSolver m_fem;
    RigidSolver m_rigidSolver;
    World m_world;
    std::vector<std::unique_ptr<btCollisionShape>> m_shapes;
    std::vector<std::unique_ptr<btRigidBody>> m_rigid;
    std::vector<std::unique_ptr<btSoftBody>> m_soft;
    std::vector<std::unique_ptr<btCollisionObject>> m_markers;
    std::vector<std::unique_ptr<btTypedConstraint>> m_joints;
    std::vector<std::unique_ptr<btMultiBody>> m_multiBodies;
    std::vector<std::unique_ptr<btMultiBodyLinkCollider>> m_links;
    std::vector<std::unique_ptr<btMultiBodyConstraint>> m_motors;
};

/// Bullet's rigid solver; with the soft body solver alone, the coupling is staggered.
struct DemoRigidSolver : btSequentialImpulseConstraintSolver
{
    explicit DemoRigidSolver(btSoftBodySolver*) {}
};
/// Bullet's own soft body solver, for comparison.
struct DemoSpringSolver : btDefaultSoftBodySolver
{
    explicit DemoSpringSolver(const btFemSolverInfo&) {}
};

using DemoSwapWorld = DemoWorldOf<btSoftRigidDynamicsWorld, DemoRigidSolver>;
using DemoBulletWorld = DemoWorldOf<btSoftRigidDynamicsWorld, DemoRigidSolver, DemoSpringSolver>;
using DemoWorld = DemoWorldOf<btSoftRigidDynamicsWorld, btFemConstraintSolver>;
using DemoLinkWorld = DemoWorldOf<btSoftMultiBodyDynamicsWorld, btFemMultiBodyConstraintSolver>;

}  // namespace bullet_fem
