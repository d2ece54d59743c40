// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/soft_world.h"

#include <algorithm>

#include "bullet_fem/btFemSoftBodySolver.h"

namespace bullet_fem
{

SoftWorld::SoftWorld(btSoftBodySolver& solver, const btVector3& gravity)
    : m_world(std::make_unique<btSoftRigidDynamicsWorld>(&m_dispatcher, &m_broadphase, &m_rigidSolver, &m_configuration,
                                                         &solver))
{
    m_world->setGravity(gravity);
    m_world->getWorldInfo().m_gravity = gravity;
}

SoftWorld::SoftWorld(btFemSoftBodySolver& solver, Coupling coupling, const btVector3& gravity)
    : SoftWorld(solver, gravity)
{
    if (coupling == Coupling::swap) return;
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
    m_world->addSoftBody(body);
    m_soft.push_back(body);
    return *body;
}

void SoftWorld::deleteSoft(btSoftBody& body)
{
    m_soft.erase(std::remove(m_soft.begin(), m_soft.end(), &body), m_soft.end());
    m_world->removeSoftBody(&body);
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

btTransform at(btScalar x, btScalar y, btScalar z)
{
    btTransform transform = btTransform::getIdentity();
    transform.setOrigin(btVector3(x, y, z));
    return transform;
}

}  // namespace bullet_fem
