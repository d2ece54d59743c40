// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/benchmark_world.h"

#include <algorithm>
#include <numeric>

#include "benchmarks/figures.h"
#include "bullet_fem/btFemConstraintSolver.h"

namespace bullet_fem
{
namespace
{

std::unique_ptr<btSequentialImpulseConstraintSolver> makeRigidSolver(btFemSoftBodySolver& fem, BenchmarkLine line)
{
    if (line == BenchmarkLine::coupled) return std::make_unique<btFemConstraintSolver>(&fem);
    return std::make_unique<btSequentialImpulseConstraintSolver>();
}

}  // namespace

BenchmarkWorld::BenchmarkWorld(const btFemSolverInfo& info, BenchmarkLine line, const btVector3& gravity)
    : m_line(line),
      m_fem(info),
      m_rigidSolver(makeRigidSolver(m_fem, line)),
      m_world(&m_dispatcher, &m_broadphase, m_rigidSolver.get(), &m_configuration,
              line == BenchmarkLine::bullet ? nullptr : &m_fem)
{
    m_world.setGravity(gravity);
    m_world.getWorldInfo().m_gravity = gravity;
}

BenchmarkWorld::~BenchmarkWorld()
{
    for (const auto& joint : m_joints) m_world.removeConstraint(joint.get());
    for (const auto& body : m_soft) m_world.removeSoftBody(body.get());
    for (const auto& body : m_rigid) m_world.removeRigidBody(body.get());
}

btRigidBody& BenchmarkWorld::addRigid(btCollisionShape* shape, double mass, const btVector3& position, double friction)
{
    m_shapes.emplace_back(shape);
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape->calculateLocalInertia(btScalar(mass), inertia);
    btRigidBody::btRigidBodyConstructionInfo info(btScalar(mass), nullptr, shape, inertia);
    info.m_startWorldTransform.setIdentity();
    info.m_startWorldTransform.setOrigin(position);
    info.m_friction = btScalar(friction);
    m_rigid.push_back(std::make_unique<btRigidBody>(info));
    m_world.addRigidBody(m_rigid.back().get());
    return *m_rigid.back();
}

btSoftBody& BenchmarkWorld::addSoft(btSoftBody* body, const btFemMaterial& material, double friction, double step)
{
    m_soft.emplace_back(body);
    body->m_cfg.kDF = btScalar(friction);
    body->setFriction(btScalar(friction));
    m_fem.setMaterial(body, material);
    prepare(*body, step);
    return *body;
}

btSoftBody& BenchmarkWorld::addSoft(btSoftBody* body, double step)
{
    m_soft.emplace_back(body);
    prepare(*body, step);
    return *body;
}

void BenchmarkWorld::prepare(btSoftBody& body, double step)
{
    const Stopwatch watch;
    if (m_line != BenchmarkLine::bullet) m_fem.prepare(&body, btScalar(step));
    m_setupSeconds += watch.seconds();
    m_world.addSoftBody(&body);
}

void BenchmarkWorld::addJoint(btTypedConstraint* joint)
{
    m_joints.emplace_back(joint);
    m_world.addConstraint(joint, true);
}

// Each body reports the time of its whole group, so each group is counted once.
BenchmarkReport sumReports(const btFemSoftBodySolver& fem, const std::vector<std::unique_ptr<btSoftBody>>& bodies)
{
    BenchmarkReport sum;
    std::vector<double> groups;
    for (const auto& body : bodies)
    {
        const btFemStepReport& report = fem.stepReport(body.get());
        sum.m_freeMilliseconds += double(report.m_freeMotionMs);
        sum.m_contacts += report.m_contacts;
        sum.m_sweeps = std::max(sum.m_sweeps, report.m_contactSweeps);
        sum.m_correctiveIterations = std::max(sum.m_correctiveIterations, report.m_contactIterations);
        sum.m_closingSpeed = std::max(sum.m_closingSpeed, double(report.m_contactViolation));
        sum.m_deepest = std::max(sum.m_deepest, double(report.m_deepestPenetration));
        sum.m_flags |= report.m_flags;
        sum.m_asleep += !body->isActive();
        groups.push_back(double(report.m_contactMs));
    }
    std::sort(groups.begin(), groups.end());
    sum.m_contactMilliseconds = std::accumulate(groups.begin(), std::unique(groups.begin(), groups.end()), 0.0);
    return sum;
}

int BenchmarkWorld::tetCount() const
{
    int count = 0;
    for (const auto& body : m_soft) count += body->m_tetras.size();
    return count;
}

}  // namespace bullet_fem
