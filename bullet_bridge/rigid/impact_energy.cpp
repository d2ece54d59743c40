// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/rigid/impact_energy.h"

#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "bullet_fem/bullet_bridge/vectors.h"
#include "bullet_fem/fem/step/stepping.h"

namespace bullet_fem
{
namespace
{

double energyOfRigid(const btRigidBody& body)
{
    const Vec3 v = vec3(body.getLinearVelocity());
    const btVector3 spin = body.getAngularVelocity() * body.getWorldTransform().getBasis();
    double turning = 0;
    for (int i = 0; i < 3; ++i)
        if (body.getInvInertiaDiagLocal()[i] > 0)
            turning += double(spin[i]) * spin[i] / body.getInvInertiaDiagLocal()[i];
    return (0.5 * dot(v, v) - dot(vec3(body.getGravity()), vec3(body.getCenterOfMassPosition()))) / body.getInvMass() +
           0.5 * turning;
}

}  // namespace

double energyIn(const MovingFrame& frame, const FemSoftBody& fem)
{
    const BodyState& s = fem.m_body.m_state;
    Vec3 momentum, moment;
    for (std::size_t i = 0; i < s.m_x.size(); ++i)
    {
        momentum += s.m_mass[i] * s.m_v[i];
        moment += s.m_mass[i] * (s.m_x[i] - frame.m_time * frame.m_velocity);
    }
    return mechanicalEnergy(fem.m_body) - dot(momentum, frame.m_velocity) - dot(moment, fem.gravity());
}

double rigidEnergyIn(const MovingFrame& frame, const FemSoftBody& fem, const RigidProxy& whole)
{
    const double mass = 1 / whole.m_inverseMass.x;
    const Vec3 &v = whole.m_linearVelocity, &spin = whole.m_angularVelocity;
    const Vec3 way = whole.m_center - frame.m_time * frame.m_velocity;
    const double turning = 0.5 * dot(spin, inverse(whole.m_inverseInertia) * spin);
    return mass * (0.5 * dot(v, v) - dot(v, frame.m_velocity) - dot(way, fem.gravity())) + turning;
}

double energyOf(const btCollisionObject& object)
{
    const btRigidBody* body = btRigidBody::upcast(&object);
    return body && !body->isStaticOrKinematicObject() && body->getInvMass() > 0 ? energyOfRigid(*body) : 0;
}

}  // namespace bullet_fem
