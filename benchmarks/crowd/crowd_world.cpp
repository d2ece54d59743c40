// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/crowd/crowd_world.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "benchmarks/figures.h"
#include "bullet_fem/btFemConstraintSolver.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/fem/common/threads.h"
#include "bullet_fem/fem/mesh/generators.h"

namespace bullet_fem
{
namespace
{

const btVector3 kGravity(0, 0, btScalar(-9.81));  // [m/s2]
constexpr btScalar kStep = btScalar(1) / 60;      // [s]
constexpr double kSide = 0.2;                     // of a soft cube, diameter of a soft ball [m]
constexpr double kSpacing = 0.27;                 // of the lattice that they fall from [m]
constexpr double kBallRadius = 0.09;              // [m]
constexpr double kDensity = 1000;                 // of all that moves [kg/m3]
constexpr int kLayers = 5;
constexpr btScalar kSoftFriction = btScalar(0.5);

/// A value in [-1, 1] that differs from body to body, and is the same on every machine and run.
double variation(int index, int kind)
{
    const unsigned mixed = (static_cast<unsigned>(index) * 2654435761u + static_cast<unsigned>(kind) * 40503u) >> 8;
    return static_cast<double>(mixed % 20001u) / 10000 - 1;
}

btFemMaterial materialOf(int index, bool different)
{
    btFemMaterial material;
    material.m_youngModulus = btScalar(2e5 * (different ? std::pow(4.0, variation(index, 0)) : 1.0));
    material.m_poissonRatio = btScalar(0.3);
    material.m_density = btScalar(kDensity);
    material.m_stiffnessDamping = btScalar(0.01);
    return material;
}

/// A cube has 1,080 tets, or 900 to 1,260 of cubes that differ.
TetMesh cubeOf(int index, double size, bool different)
{
    static const std::array<std::array<int, 3>, 4> cells = {{{6, 6, 6}, {7, 6, 6}, {6, 5, 6}, {7, 5, 6}}};
    return makeBox({size, size, size}, cells[different ? index % cells.size() : 0]);
}

/// A ball has 1,080 tets, or 864 to 1,296 as a cylinder, every other one of balls that differ.
TetMesh ballOf(int index, double size, bool different)
{
    if (different && index % 2 == 1) return makeCylinder(0.5 * size, size, 6, 4 + index / 2 % 3);
    return makeSphere(0.5 * size, {6, 6, 5});
}

TetMesh meshOf(int index, const CrowdSettings& settings)
{
    const double size = kSide * (settings.m_different ? 1 + 0.2 * variation(index, 1) : 1.0);
    return (settings.m_cubes ? cubeOf : ballOf)(index, size, settings.m_different);
}

std::unique_ptr<btSequentialImpulseConstraintSolver> makeRigidSolver(btFemSoftBodySolver& fem, bool coupled)
{
    if (coupled) return std::make_unique<btFemConstraintSolver>(&fem);
    return std::make_unique<btSequentialImpulseConstraintSolver>();
}

btFemSolverInfo solverInfo(const CrowdSettings& settings)
{
    btFemSolverInfo info;
    info.m_contactTolerance = static_cast<btScalar>(settings.m_contactTolerance);
    info.m_threads = settings.m_threads;
    return info;
}

void addReport(const btFemStepReport& report, CrowdStep& sum)
{
    sum.m_freeMilliseconds += report.m_freeMotionMs;
    sum.m_contacts += report.m_contacts;
    sum.m_sweeps = std::max(sum.m_sweeps, report.m_contactSweeps);
    sum.m_correctiveIterations = std::max(sum.m_correctiveIterations, report.m_contactIterations);
    sum.m_closingSpeed = std::max(sum.m_closingSpeed, double(report.m_contactViolation));
    sum.m_deepest = std::max(sum.m_deepest, double(report.m_deepestPenetration));
    sum.m_flags |= report.m_flags;
}

}  // namespace

CrowdWorld::CrowdWorld(const CrowdSettings& settings)
    : m_settings(settings),
      m_threadCount(Threads(settings.m_threads).count()),
      m_fem(solverInfo(settings)),
      m_rigidSolver(makeRigidSolver(m_fem, settings.m_coupled)),
      m_world(&m_dispatcher, &m_broadphase, m_rigidSolver.get(), &m_configuration, &m_fem)
{
    m_world.setGravity(kGravity);
    m_world.getWorldInfo().m_gravity = kGravity;
    const int all = settings.m_bodies + settings.m_balls;
    const int columns = std::max(1, static_cast<int>(std::lround(std::sqrt(double(all) / kLayers))));
    addPit(btScalar(0.5 * kSpacing * columns));

    int balls = 0;
    for (int k = 0; k < all; ++k)
    {
        const double middle = 0.5 * (columns - 1), shake = 0.1 * kSpacing;
        const btVector3 center(btScalar(kSpacing * (k % columns - middle) + shake * variation(k, 3)),
                               btScalar(kSpacing * (k / columns % columns - middle) + shake * variation(k, 4)),
                               btScalar(kSpacing * (k / (columns * columns) + 0.6)));
        if ((k + 1) * settings.m_balls / all > balls)
            addBall(center), ++balls;
        else
            addSoft(center, k);
    }
}

CrowdWorld::~CrowdWorld()
{
    for (const auto& body : m_soft) m_world.removeSoftBody(body.get());
    for (const auto& body : m_rigid) m_world.removeRigidBody(body.get());
}

void CrowdWorld::addPit(btScalar halfWidth)
{
    const btScalar thick = btScalar(0.5), high = 100;
    addBox({0, 0, -thick}, {halfWidth + 2 * thick, halfWidth + 2 * thick, thick});
    for (int side : {-1, 1})
    {
        addBox({side * (halfWidth + thick), 0, high}, {thick, halfWidth + 2 * thick, high});
        addBox({0, side * (halfWidth + thick), high}, {halfWidth + 2 * thick, thick, high});
    }
}

void CrowdWorld::addBox(const btVector3& center, const btVector3& halfExtents)
{
    addRigid(std::make_unique<btBoxShape>(halfExtents), center, 0);
}

void CrowdWorld::addBall(const btVector3& center)
{
    const double volume = 4.0 / 3 * std::acos(-1.0) * kBallRadius * kBallRadius * kBallRadius;
    addRigid(std::make_unique<btSphereShape>(btScalar(kBallRadius)), center, btScalar(kDensity * volume));
}

void CrowdWorld::addRigid(std::unique_ptr<btCollisionShape> shape, const btVector3& center, btScalar mass)
{
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape->calculateLocalInertia(mass, inertia);
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape.get(), inertia);
    info.m_startWorldTransform.setIdentity();
    info.m_startWorldTransform.setOrigin(center);
    info.m_friction = 1;
    auto body = std::make_unique<btRigidBody>(info);
    if (mass > 0) body->setActivationState(DISABLE_DEACTIVATION);
    m_world.addRigidBody(body.get());
    m_shapes.push_back(std::move(shape));
    m_rigid.push_back(std::move(body));
}

void CrowdWorld::addSoft(const btVector3& center, int index)
{
    const TetMesh mesh = meshOf(index, m_settings);
    std::unique_ptr<btSoftBody> body(btFemHelpers::createFromTetMesh(m_world.getWorldInfo(), mesh));
    btVector3 lowest, highest;
    body->getAabb(lowest, highest);
    body->translate(center - (lowest + highest) / 2);
    body->m_cfg.kDF = kSoftFriction;
    body->setFriction(kSoftFriction);
    body->setActivationState(DISABLE_DEACTIVATION);
    const Stopwatch watch;
    m_fem.setMaterial(body.get(), materialOf(index, m_settings.m_different));
    m_fem.prepare(body.get(), kStep);
    m_setupSeconds += watch.seconds();
    m_world.addSoftBody(body.get());
    m_soft.push_back(std::move(body));
}

// All bodies of a group report its time, so every group is counted once.
CrowdStep CrowdWorld::step()
{
    const Stopwatch watch;
    m_world.stepSimulation(kStep, 0);
    CrowdStep result;
    result.m_milliseconds = 1e3 * watch.seconds();
    m_groupTimes.clear();
    for (const auto& body : m_soft)
    {
        const btFemStepReport& report = m_fem.stepReport(body.get());
        addReport(report, result);
        m_groupTimes.push_back(report.m_contactMs);
        if (!body->isActive()) ++result.m_asleep;
    }
    result.m_freeMilliseconds /= m_threadCount;  // of bodies that were solved at the same time
    std::sort(m_groupTimes.begin(), m_groupTimes.end());
    const auto end = std::unique(m_groupTimes.begin(), m_groupTimes.end());
    result.m_contactMilliseconds = std::accumulate(m_groupTimes.begin(), end, 0.0);
    return result;
}

void CrowdWorld::allowSleep(bool allowed)
{
    const int state = allowed ? ACTIVE_TAG : DISABLE_DEACTIVATION;
    for (const auto& body : m_soft) body->forceActivationState(state);
    for (const auto& body : m_rigid)
        if (!body->isStaticObject()) body->forceActivationState(state);
}

int CrowdWorld::tetCount() const
{
    int count = 0;
    for (const auto& body : m_soft) count += body->m_tetras.size();
    return count;
}

}  // namespace bullet_fem
