// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "examples/energy_book.h"

#include <algorithm>

#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "examples/example_bodies.h"
#include "plugin/scenes/scene_measures.h"

namespace bullet_fem
{

EnergyBook::EnergyBook(const btFemSoftBodySolver& fem, const Vec3& gravity) : m_fem(&fem), m_gravity(gravity) {}

void EnergyBook::addSoft(const btSoftBody& body, double young, double poisson, btFemElasticLaw law)
{
    m_soft.push_back({&body, young, poisson, law});
}

void EnergyBook::addRigid(const btRigidBody& body)
{
    m_rigid.push_back(&body);
}

void EnergyBook::addLed(const btCollisionObject& object)
{
    m_led.push_back({&object, object.getWorldTransform()});
}

double EnergyBook::kinetic() const
{
    double sum = 0;
    for (const Soft& soft : m_soft) sum += motionOf(*soft.m_body).m_energy;
    for (const btRigidBody* rigid : m_rigid) sum += motionOf(*rigid).m_energy;
    return sum;
}

double EnergyBook::potential() const
{
    double sum = 0;
    for (const Soft& soft : m_soft) sum -= massOf(*soft.m_body) * dot(m_gravity, centerOf(*soft.m_body));
    for (const btRigidBody* rigid : m_rigid)
        sum -= dot(m_gravity, vec3(rigid->getCenterOfMassPosition())) / double(rigid->getInvMass());
    return sum;
}

double EnergyBook::elastic() const
{
    double sum = 0;
    for (const Soft& soft : m_soft) sum += elasticEnergy(*soft.m_body, soft.m_young, soft.m_poisson, soft.m_law);
    return sum;
}

void EnergyBook::open()
{
    m_start = kinetic() + potential() + elastic();
    m_work = m_min = m_made = 0;
    for (Led& led : m_led) led.m_before = led.m_object->getWorldTransform();
}

void EnergyBook::noteStep(double step)
{
    for (Led& led : m_led)
    {
        const btTransform& now = led.m_object->getWorldTransform();
        const btTransform moved = now * led.m_before.inverse();
        for (const Soft& soft : m_soft)
        {
            const btAlignedObjectArray<btFemContact>& contacts = m_fem->contacts(soft.m_body);
            for (int k = 0; k < contacts.size(); ++k)
                if (contacts[k].m_other == led.m_object)
                    m_work +=
                        dot(vec3(contacts[k].m_impulse), vec3(moved(contacts[k].m_point) - contacts[k].m_point)) / step;
        }
        led.m_before = now;
    }
}

void EnergyBook::audit()
{
    const double now = surplus();
    m_made = std::max(m_made, now - m_min);
    m_min = std::min(m_min, now);
}

double EnergyBook::surplus() const
{
    return kinetic() + potential() + elastic() - m_start - m_work;
}

}  // namespace bullet_fem
