// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include "BulletDynamics/Featherstone/btMultiBody.h"
#include "BulletDynamics/Featherstone/btMultiBodyConstraint.h"
#include "BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h"
#include "BulletDynamics/Featherstone/btMultiBodyLinkCollider.h"
#include "BulletSoftBody/btDeformableMultiBodyConstraintSolver.h"
#include "BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h"
#include "BulletSoftBody/btSoftMultiBodyDynamicsWorld.h"
#include "bullet_fem/btFemDeformableBodySolver.h"
#include "bullet_fem/btFemDeformableConstraintSolver.h"
#include "bullet_fem/btFemMultiBodyConstraintSolver.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{

/// A world of multibodies, rigid and soft bodies, which it owns. Gravity is along -z; bodies do not sleep unless their
/// activation state is set. Bodies are kept in the order of addition.
template <class World, class RigidSolver, class SoftSolver>
class LinkWorld
{
public:
    /// The solver must outlive the world.
    explicit LinkWorld(SoftSolver& solver, const btVector3& gravity = {0, 0, btScalar(-kGravity)})
    {
        if constexpr (std::is_constructible_v<RigidSolver, SoftSolver*>)
            m_rigidSolver = std::make_unique<RigidSolver>(&solver);
        else
            m_rigidSolver = std::make_unique<RigidSolver>();
        if constexpr (std::is_same_v<RigidSolver, btDeformableMultiBodyConstraintSolver>)
            m_rigidSolver->setDeformableSolver(&solver);
        m_world = std::make_unique<World>(&m_dispatcher, &m_broadphase, m_rigidSolver.get(), &m_configuration, &solver);
        m_world->setGravity(gravity);
        m_world->getWorldInfo().m_gravity = gravity;
    }

    ~LinkWorld()
    {
        for (const auto& constraint : m_constraints) m_world->removeMultiBodyConstraint(constraint.get());
        for (const auto& soft : m_soft) m_world->removeSoftBody(soft.get());
        for (const auto& collider : m_colliders) m_world->removeCollisionObject(collider.get());
        for (const auto& body : m_multiBodies) m_world->removeMultiBody(body.get());
        for (const auto& rigid : m_rigid) m_world->removeRigidBody(rigid.get());
    }
    LinkWorld(const LinkWorld&) = delete;
    LinkWorld& operator=(const LinkWorld&) = delete;

    btRigidBody& addRigid(btCollisionShape* shape, const RigidSettings& settings = {})
    {
        m_shapes.emplace_back(shape);
        btVector3 inertia(0, 0, 0);
        if (settings.m_mass > 0) shape->calculateLocalInertia(settings.m_mass, inertia);
        m_rigid.push_back(std::make_unique<btRigidBody>(settings.m_mass, nullptr, shape, inertia));
        btRigidBody& body = *m_rigid.back();
        body.setWorldTransform(settings.m_transform);
        body.setInterpolationWorldTransform(settings.m_transform);
        body.setFriction(settings.m_friction);
        body.setLinearVelocity(settings.m_velocity);
        body.setAngularVelocity(settings.m_spin);
        body.setActivationState(DISABLE_DEACTIVATION);
        m_world->addRigidBody(&body);
        return body;
    }

    /// A static box of 100 x 100 x 2 m with its upper face at z = height [m].
    btRigidBody& addFloorBox(btScalar height = 0)
    {
        RigidSettings settings;
        settings.m_transform = at(0, 0, height - 1);
        return addRigid(new btBoxShape(btVector3(50, 50, 1)), settings);
    }

    btSoftBody& addSoft(btSoftBody* body)
    {
        m_soft.emplace_back(body);
        body->setActivationState(DISABLE_DEACTIVATION);
        m_world->addSoftBody(body);
        return *body;
    }

    /// Takes ownership of a multibody with links, and sets its damping to zero.
    btMultiBody& addMultiBody(btMultiBody* body)
    {
        m_multiBodies.emplace_back(body);
        body->finalizeMultiDof();
        body->setLinearDamping(0);
        body->setAngularDamping(0);
        m_world->addMultiBody(body);
        return *body;
    }

    /// Sets the shape of a link, or of the base (-1).
    btMultiBodyLinkCollider& addCollider(btMultiBody& body, int link, btCollisionShape* shape)
    {
        m_shapes.emplace_back(shape);
        m_colliders.push_back(std::make_unique<btMultiBodyLinkCollider>(&body, link));
        btMultiBodyLinkCollider& collider = *m_colliders.back();
        collider.setCollisionShape(shape);
        collider.setFriction(1);
        collider.setActivationState(DISABLE_DEACTIVATION);
        if (link < 0)
            body.setBaseCollider(&collider);
        else
            body.getLink(link).m_collider = &collider;
        btAlignedObjectArray<btQuaternion> turns;
        btAlignedObjectArray<btVector3> places;
        body.forwardKinematics(turns, places);
        body.updateCollisionObjectWorldTransforms(turns, places);
        m_world->addCollisionObject(&collider);
        return collider;
    }

    template <class Constraint, class... Values>
    Constraint& addConstraint(Values&&... values)
    {
        m_constraints.push_back(std::make_unique<Constraint>(std::forward<Values>(values)...));
        m_constraints.back()->finalizeMultiDof();
        m_world->addMultiBodyConstraint(m_constraints.back().get());
        return static_cast<Constraint&>(*m_constraints.back());
    }

    void step(int count = 1, btScalar h = kStep)
    {
        for (int k = 0; k < count; ++k) m_world->stepSimulation(h, 0);
    }

    World& world() { return *m_world; }
    btRigidBody& rigid(int k) { return *m_rigid[k]; }
    btSoftBodyWorldInfo& info() { return m_world->getWorldInfo(); }

private:
    btSoftBodyRigidBodyCollisionConfiguration m_configuration;
    btCollisionDispatcher m_dispatcher{&m_configuration};
    btDbvtBroadphase m_broadphase;
    std::unique_ptr<RigidSolver> m_rigidSolver;
    std::unique_ptr<World> m_world;
    std::vector<std::unique_ptr<btCollisionShape>> m_shapes;
    std::vector<std::unique_ptr<btRigidBody>> m_rigid;
    std::vector<std::unique_ptr<btSoftBody>> m_soft;
    std::vector<std::unique_ptr<btMultiBody>> m_multiBodies;
    std::vector<std::unique_ptr<btMultiBodyLinkCollider>> m_colliders;
    std::vector<std::unique_ptr<btMultiBodyConstraint>> m_constraints;
};

using MultiBodyWorld = LinkWorld<btSoftMultiBodyDynamicsWorld, btMultiBodyConstraintSolver, btSoftBodySolver>;
using CoupledDeformableWorld =
    LinkWorld<btDeformableMultiBodyDynamicsWorld, btFemDeformableConstraintSolver, btFemDeformableBodySolver>;
using CoupledLinkWorld = LinkWorld<btSoftMultiBodyDynamicsWorld, btFemMultiBodyConstraintSolver, btFemSoftBodySolver>;

}  // namespace bullet_fem
