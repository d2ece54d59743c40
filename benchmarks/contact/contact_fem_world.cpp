// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/contact/contact_fem_world.h"

#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>

#include <algorithm>

#include "benchmarks/figures.h"
#include "bullet_fem/btFemConstraintSolver.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"

namespace bullet_fem
{
namespace
{

btFemMaterial publicMaterial(const Material& material)
{
    btFemMaterial result;
    result.m_youngModulus = btScalar(material.m_youngModulus);
    result.m_poissonRatio = btScalar(material.m_poissonRatio);
    result.m_density = 0;  // node masses are set explicitly
    result.m_massDamping = btScalar(material.m_massDamping);
    result.m_stiffnessDamping = btScalar(material.m_stiffnessDamping);
    return result;
}

btFemSolverInfo solverInfo(bool lowMemory)
{
    btFemSolverInfo info;
    if (lowMemory) info.m_factorChoice = btFemFactorChoice::lowMemory;
    return info;
}

class FemContactWorld : public ContactWorld
{
public:
    FemContactWorld(const ContactScene& scene, bool coupled, bool lowMemory)
        : m_step(btScalar(scene.m_step)),
          m_coupled(coupled),
          m_lowMemory(lowMemory),
          m_fem(solverInfo(lowMemory)),
          m_rigidSolver(makeRigidSolver()),
          m_world(&m_dispatcher, &m_broadphase, m_rigidSolver.get(), &m_configuration, &m_fem)
    {
        m_world.setGravity(bulletVector(scene.m_gravity));
        m_world.getWorldInfo().m_gravity = bulletVector(scene.m_gravity);
        makeBodies(scene, m_world.getWorldInfo());
        for (const auto& body : m_rigid) m_world.addRigidBody(body.get());
        for (const auto& body : m_soft)
        {
            m_fem.setMaterial(body.get(), publicMaterial(scene.m_material));
            m_fem.prepare(body.get(), m_step);
            m_world.addSoftBody(body.get());
        }
    }

    ~FemContactWorld() override
    {
        for (const auto& body : m_soft) m_world.removeSoftBody(body.get());
        for (const auto& body : m_rigid) m_world.removeRigidBody(body.get());
    }

    std::string name() const override
    {
        return std::string(m_coupled ? "coupled" : "fem") + (m_lowMemory ? " low" : "");
    }

    ContactStep step() override
    {
        const Stopwatch watch;
        m_world.stepSimulation(m_step, 0);
        ContactStep result;
        result.m_milliseconds = 1e3 * watch.seconds();
        result.m_cpuMilliseconds = 1e3 * watch.cpuSeconds();
        for (const auto& body : m_soft) add(m_fem.stepReport(body.get()), result);
        return result;
    }

private:
    std::unique_ptr<btSequentialImpulseConstraintSolver> makeRigidSolver()
    {
        if (m_coupled) return std::make_unique<btFemConstraintSolver>(&m_fem);
        return std::make_unique<btSequentialImpulseConstraintSolver>();
    }

    /// The contact time covers all bodies; the counts are those of the body's group.
    static void add(const btFemStepReport& report, ContactStep& sum)
    {
        sum.m_freeMilliseconds += report.m_freeMotionMs;
        sum.m_contactMilliseconds = std::max(sum.m_contactMilliseconds, double(report.m_contactMs));
        sum.m_contacts += report.m_contacts;
        sum.m_sweeps = std::max(sum.m_sweeps, report.m_contactSweeps);
        sum.m_correctiveIterations = std::max(sum.m_correctiveIterations, report.m_contactIterations);
        sum.m_closingSpeed = std::max(sum.m_closingSpeed, double(report.m_contactViolation));
        sum.m_flags |= report.m_flags;
    }

    btScalar m_step;
    bool m_coupled, m_lowMemory;
    btFemSoftBodySolver m_fem;
    btSoftBodyRigidBodyCollisionConfiguration m_configuration;
    btCollisionDispatcher m_dispatcher{&m_configuration};
    btDbvtBroadphase m_broadphase;
    std::unique_ptr<btSequentialImpulseConstraintSolver> m_rigidSolver;
    btSoftRigidDynamicsWorld m_world;
};

}  // namespace

std::unique_ptr<ContactWorld> makeFemContactWorld(const ContactScene& scene, bool coupled, bool lowMemory)
{
    return std::make_unique<FemContactWorld>(scene, coupled, lowMemory);
}

}  // namespace bullet_fem
