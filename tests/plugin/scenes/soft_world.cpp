// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/scenes/soft_world.h"

#include <algorithm>
#include <utility>

#include "BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h"
#include "BulletSoftBody/btDeformableMultiBodyConstraintSolver.h"
#include "BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h"
#include "BulletSoftBody/btSoftMultiBodyDynamicsWorld.h"
#include "bullet_fem/btFemDeformableBodySolver.h"

namespace bullet_fem
{

namespace
{

struct Made
{
    btDiscreteDynamicsWorld* m_world;
    btSoftBodyWorldInfo* m_info;
    btAlignedObjectArray<btSoftBody*>* m_bodies;
};

template <class World, class... Parts>
Made make(Parts&&... parts)
{
    auto* world = new World(std::forward<Parts>(parts)...);
    return {world, &world->getWorldInfo(), &world->getSoftBodyArray()};
}

btSequentialImpulseConstraintSolver* makeRigidSolver(WorldClass worldClass, btSoftBodySolver& solver)
{
    if (worldClass == WorldClass::softRigid) return new btSequentialImpulseConstraintSolver;
    if (worldClass == WorldClass::softMultiBody) return new btMultiBodyConstraintSolver;
    auto* rigidSolver = new btDeformableMultiBodyConstraintSolver;
    rigidSolver->setDeformableSolver(static_cast<btDeformableBodySolver*>(&solver));
    return rigidSolver;
}

}  // namespace

SoftWorld::SoftWorld(btSoftBodySolver& solver, const btVector3& gravity)
    : SoftWorld(WorldClass::softRigid, solver, gravity)
{
}

SoftWorld::SoftWorld(WorldClass worldClass, btSoftBodySolver& solver, const btVector3& gravity)
    : m_rigidSolver(makeRigidSolver(worldClass, solver)), m_class(worldClass)
{
    Made made;
    if (worldClass == WorldClass::softRigid)
        made = make<btSoftRigidDynamicsWorld>(&m_dispatcher, &m_broadphase, m_rigidSolver.get(), &m_configuration,
                                              &solver);
    else if (worldClass == WorldClass::softMultiBody)
        made = make<btSoftMultiBodyDynamicsWorld>(&m_dispatcher, &m_broadphase,
                                                  static_cast<btMultiBodyConstraintSolver*>(m_rigidSolver.get()),
                                                  &m_configuration, &solver);
    else
    {
        made = make<btDeformableMultiBodyDynamicsWorld>(
            &m_dispatcher, &m_broadphase, static_cast<btDeformableMultiBodyConstraintSolver*>(m_rigidSolver.get()),
            &m_configuration, static_cast<btDeformableBodySolver*>(&solver));
        m_gravityForce = std::make_unique<btDeformableGravityForce>(gravity);
    }
    m_world.reset(made.m_world);
    m_info = made.m_info;
    m_inWorld = made.m_bodies;
    m_world->setGravity(gravity);
    m_info->m_gravity = gravity;
}

SoftWorld::SoftWorld(btFemSoftBodySolver& solver, Coupling coupling, const btVector3& gravity)
    : SoftWorld(solver, gravity)
{
    if (coupling == Coupling::coupled) couple(solver);
}

void SoftWorld::couple(btFemSoftBodySolver& solver)
{
    m_coupledSolver = std::make_unique<btFemConstraintSolver>(&solver);
    m_world->setConstraintSolver(m_coupledSolver.get());
}

SoftWorld::~SoftWorld()
{
    while (!m_soft.empty()) deleteSoft(*m_soft.back());
    while (!m_rigid.empty()) deleteRigid(*m_rigid.back());
}

btRigidBody& SoftWorld::addRigid(btCollisionShape* shape, const RigidSettings& settings)
{
    keep(shape);
    btVector3 inertia(0, 0, 0);
    if (settings.m_mass > 0) shape->calculateLocalInertia(settings.m_mass, inertia);
    auto* body = new btRigidBody(settings.m_mass, new btDefaultMotionState(settings.m_transform), shape, inertia);
    body->setFriction(settings.m_friction);
    body->setLinearVelocity(settings.m_velocity);
    body->setAngularVelocity(settings.m_spin);
    body->setActivationState(DISABLE_DEACTIVATION);
    m_world->addRigidBody(body);
    m_rigid.push_back(body);
    return *body;
}

btCollisionShape* SoftWorld::keep(btCollisionShape* shape)
{
    m_shapes.emplace_back(shape);
    return shape;
}

btRigidBody& SoftWorld::addPlane(btScalar height)
{
    return addRigid(new btStaticPlaneShape(btVector3(0, 0, 1), height));
}

btRigidBody& SoftWorld::addFloorBox(btScalar height)
{
    RigidSettings settings;
    settings.m_transform = at(0, 0, height - 1);
    return addRigid(new btBoxShape(btVector3(50, 50, 1)), settings);
}

btSoftBody& SoftWorld::addSoft(btSoftBody* body)
{
    body->setActivationState(DISABLE_DEACTIVATION);
    put(*body);
    m_soft.push_back(body);
    return *body;
}

void SoftWorld::put(btSoftBody& body, int group, int mask)
{
    if (m_class == WorldClass::softRigid)
        static_cast<btSoftRigidDynamicsWorld&>(*m_world).addSoftBody(&body, group, mask);
    else if (m_class == WorldClass::softMultiBody)
        static_cast<btSoftMultiBodyDynamicsWorld&>(*m_world).addSoftBody(&body, group, mask);
    else
    {
        auto& world = static_cast<btDeformableMultiBodyDynamicsWorld&>(*m_world);
        world.addSoftBody(&body, group, mask);
        world.addForce(&body, m_gravityForce.get());
    }
}

void SoftWorld::take(btSoftBody& body)
{
    m_world->removeCollisionObject(&body);  // each class of world finds its soft bodies
}

void SoftWorld::setSoftGravity(const btVector3& gravity)
{
    m_info->m_gravity = gravity;
    if (m_gravityForce) m_gravityForce->m_gravity = gravity;
}

void SoftWorld::deleteSoft(btSoftBody& body)
{
    m_soft.erase(std::remove(m_soft.begin(), m_soft.end(), &body), m_soft.end());
    take(body);
    delete &body;
}

void SoftWorld::deleteRigid(btRigidBody& body)
{
    m_rigid.erase(std::remove(m_rigid.begin(), m_rigid.end(), &body), m_rigid.end());
    m_world->removeRigidBody(&body);
    delete body.getMotionState();
    delete &body;
}

void SoftWorld::step(int count, btScalar h)
{
    for (int k = 0; k < count; ++k) m_world->stepSimulation(h, 0);
}

FemSolverOf::FemSolverOf(WorldClass worldClass, const btFemSolverInfo& info)
{
    if (worldClass == WorldClass::deformable)
    {
        auto solver = std::make_unique<btFemDeformableBodySolver>(info);
        m_fem = &solver->fem();
        m_solver = std::move(solver);
        return;
    }
    auto solver = std::make_unique<btFemSoftBodySolver>(info);
    m_fem = solver.get();
    m_solver = std::move(solver);
}

FemSolverOf::~FemSolverOf() = default;

FemWorld::FemWorld(WorldClass worldClass, const btVector3& gravity) : FemWorld(worldClass, btFemSolverInfo(), gravity)
{
}

FemWorld::FemWorld(WorldClass worldClass, Coupling coupling, const btVector3& gravity, const btFemSolverInfo& info)
    : FemWorld(worldClass, info, gravity)
{
    if (coupling == Coupling::coupled) couple(*m_fem);
}

FemWorld::FemWorld(WorldClass worldClass, const btFemSolverInfo& info, const btVector3& gravity)
    : FemSolverOf(worldClass, info), SoftWorld(worldClass, *m_solver, gravity)
{
}

btTransform at(btScalar x, btScalar y, btScalar z)
{
    btTransform transform = btTransform::getIdentity();
    transform.setOrigin(btVector3(x, y, z));
    return transform;
}

}  // namespace bullet_fem
