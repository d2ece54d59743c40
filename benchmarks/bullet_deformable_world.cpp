// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/bullet_deformable_world.h"

namespace bullet_fem
{

BulletDeformableWorld::BulletDeformableWorld(btDeformableBodySolver& solver, const Vec3& gravity)
    : m_gravityForce(toBullet(gravity)),
      m_world(&m_dispatcher, &m_broadphase, &m_rigidSolver, &m_configuration, &solver)
{
    m_rigidSolver.setDeformableSolver(&solver);
    m_world.setImplicit(true);
    m_world.setUseProjection(true);
    m_world.setGravity(toBullet(gravity));
    m_world.getWorldInfo().m_gravity = toBullet(gravity);
}

void BulletDeformableWorld::add(btSoftBody& body, btDeformableLinearElasticityForce& elasticity,
                                const Material& material)
{
    body.m_tetraScratches.resize(body.m_tetras.size());
    body.m_tetraScratchesTn.resize(body.m_tetras.size());
    body.initializeDmInverse();
    body.setActivationState(DISABLE_DEACTIVATION);
    m_world.addSoftBody(&body);

    elasticity.setLameParameters(btScalar(material.lameMu()), btScalar(material.lameLambda()));
    elasticity.setDamping(btScalar(material.m_massDamping), btScalar(material.m_stiffnessDamping));
    m_world.addForce(&body, &elasticity);
    m_world.addForce(&body, &m_gravityForce);
}

}  // namespace bullet_fem
