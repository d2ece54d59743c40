// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/crowd/crowd_world.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "benchmarks/figures.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/fem/common/threads.h"
#include "bullet_fem/fem/mesh/generators.h"

namespace bullet_fem
{
namespace
{

const btVector3 kGravity(0, 0, btScalar(-9.81));  // [m/s2]
constexpr btScalar kStep = btScalar(1) / 60;      // [s]
constexpr double kSide = 0.2;                     // edge of a soft cube, diameter of a soft ball [m]
constexpr double kSpacing = 0.27;                 // of the initial lattice [m]
constexpr double kBallRadius = 0.09;              // [m]
constexpr double kDensity = 1000;                 // of all moving bodies [kg/m3]
constexpr int kLayers = 5;
constexpr double kSoftFriction = 0.5;

/// A reproducible value in [-1, 1] that differs from body to body.
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

/// A cube of 1,080 tets; if `different`, of 900 to 1,260 tets.
TetMesh cubeOf(int index, double size, bool different)
{
    static const std::array<std::array<int, 3>, 4> cells = {{{6, 6, 6}, {7, 6, 6}, {6, 5, 6}, {7, 5, 6}}};
    return makeBox({size, size, size}, cells[different ? index % cells.size() : 0]);
}

/// A ball of 1,080 tets; if `different`, every other body is a cylinder of 864 to 1,296 tets.
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

btFemSolverInfo solverInfo(const CrowdSettings& settings)
{
    btFemSolverInfo info;
    info.m_contactTolerance = static_cast<btScalar>(settings.m_contactTolerance);
    info.m_threads = settings.m_threads;
    return info;
}

}  // namespace

CrowdWorld::CrowdWorld(const CrowdSettings& settings)
    : m_settings(settings),
      m_threadCount(Threads(settings.m_threads).count()),
      m_world(solverInfo(settings), settings.m_coupled ? BenchmarkLine::coupled : BenchmarkLine::swap, kGravity)
{
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
    m_world.addRigid(new btBoxShape(halfExtents), 0, center, 1);
}

void CrowdWorld::addBall(const btVector3& center)
{
    const double volume = 4.0 / 3 * std::acos(-1.0) * kBallRadius * kBallRadius * kBallRadius;
    m_world.addRigid(new btSphereShape(btScalar(kBallRadius)), kDensity * volume, center, 1)
        .setActivationState(DISABLE_DEACTIVATION);
}

void CrowdWorld::addSoft(const btVector3& center, int index)
{
    btSoftBody* body = btFemHelpers::createFromTetMesh(m_world.bullet().getWorldInfo(), meshOf(index, m_settings));
    btVector3 lowest, highest;
    body->getAabb(lowest, highest);
    body->translate(center - (lowest + highest) / 2);
    body->setActivationState(DISABLE_DEACTIVATION);
    m_world.addSoft(body, materialOf(index, m_settings.m_different), kSoftFriction, kStep);
}

CrowdStep CrowdWorld::step()
{
    const Stopwatch watch;
    m_world.bullet().stepSimulation(kStep, 0);
    const double seconds = watch.seconds(), cpuSeconds = watch.cpuSeconds();
    CrowdStep result{m_world.report(), 1e3 * seconds, 1e3 * cpuSeconds};
    result.m_freeMilliseconds /= m_threadCount;  // bodies are solved in parallel
    return result;
}

void CrowdWorld::allowSleep(bool allowed)
{
    const int state = allowed ? ACTIVE_TAG : DISABLE_DEACTIVATION;
    for (const auto& body : m_world.soft()) body->forceActivationState(state);
    for (const auto& body : m_world.rigid())
        if (!body->isStaticObject()) body->forceActivationState(state);
}

}  // namespace bullet_fem
