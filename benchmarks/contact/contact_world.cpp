// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/contact/contact_world.h"

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemVectors.h"

namespace bullet_fem
{
namespace
{

constexpr double kHelpersDensity = 1000;  // density of bodies made by btFemHelpers [kg/m3]

std::unique_ptr<btSoftBody> makeSoft(const ContactScene& scene, const SoftPart& part, btSoftBodyWorldInfo& info)
{
    std::unique_ptr<btSoftBody> body(btFemHelpers::createFromTetMesh(info, part.m_mesh));
    const double scale = scene.m_material.m_density / kHelpersDensity;
    for (int i = 0; i < body->m_nodes.size(); ++i) body->setMass(i, body->getMass(i) * btScalar(scale));
    for (int i : part.m_pinned) body->setMass(i, 0);
    body->setVelocity(bulletVector(part.m_velocity));
    body->m_cfg.kDF = btScalar(scene.m_friction);
    body->setFriction(btScalar(scene.m_friction));
    body->setActivationState(DISABLE_DEACTIVATION);
    return body;
}

std::unique_ptr<btRigidBody> makeRigid(const BoxPart& part, btCollisionShape& shape)
{
    btVector3 inertia(0, 0, 0);
    if (part.m_mass > 0) shape.calculateLocalInertia(btScalar(part.m_mass), inertia);
    btRigidBody::btRigidBodyConstructionInfo info(btScalar(part.m_mass), nullptr, &shape, inertia);
    info.m_startWorldTransform.setIdentity();
    info.m_startWorldTransform.setOrigin(bulletVector(part.m_center));
    info.m_friction = 1;
    auto body = std::make_unique<btRigidBody>(info);
    body->setLinearVelocity(bulletVector(part.m_velocity));
    body->setActivationState(DISABLE_DEACTIVATION);
    return body;
}

}  // namespace

void ContactWorld::makeBodies(const ContactScene& scene, btSoftBodyWorldInfo& info)
{
    for (const BoxPart& part : scene.m_boxes)
    {
        m_shapes.push_back(std::make_unique<btBoxShape>(bulletVector(part.m_halfExtents)));
        m_rigid.push_back(makeRigid(part, *m_shapes.back()));
    }
    for (const SoftPart& part : scene.m_soft) m_soft.push_back(makeSoft(scene, part, info));
}

}  // namespace bullet_fem
