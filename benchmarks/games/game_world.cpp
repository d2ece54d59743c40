// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/games/game_world.h"

#include <algorithm>

#include "benchmarks/figures.h"

namespace bullet_fem
{
namespace
{

constexpr btScalar kFrame = btScalar(1) / 60;  // [s]

btFemSolverInfo infoOf(const GameSettings& settings)
{
    btFemSolverInfo info;
    info.m_contactTolerance = btScalar(settings.m_contactTolerance);
    return info;
}

}  // namespace

void add(const BenchmarkReport& step, GameFrame& frame)
{
    frame.m_freeMilliseconds += step.m_freeMilliseconds;
    frame.m_contactMilliseconds += step.m_contactMilliseconds;
    frame.m_contacts = step.m_contacts;
    frame.m_asleep = step.m_asleep;
    frame.m_sweeps = std::max(frame.m_sweeps, step.m_sweeps);
    frame.m_correctiveIterations = std::max(frame.m_correctiveIterations, step.m_correctiveIterations);
    frame.m_closingSpeed = std::max(frame.m_closingSpeed, step.m_closingSpeed);
    frame.m_deepest = std::max(frame.m_deepest, step.m_deepest);
    frame.m_flags |= step.m_flags;
}

double heldIn(const btFemSoftBodySolver& fem, const std::vector<std::unique_ptr<btSoftBody>>& bodies, double h)
{
    double impulse = 0;
    for (const auto& body : bodies)
    {
        const auto& contacts = fem.contacts(body.get());
        for (int k = 0; k < contacts.size(); ++k)
            if (!btSoftBody::upcast(contacts[k].m_other)) impulse += double(contacts[k].m_impulse.y());
        const auto& anchors = fem.anchors(body.get());
        for (int k = 0; k < anchors.size(); ++k) impulse += double(anchors[k].m_impulse.y());
    }
    return impulse / h;
}

double massOf(const std::vector<std::unique_ptr<btSoftBody>>& bodies)
{
    double mass = 0;
    for (const auto& body : bodies)
        for (int i = 0; i < body->m_nodes.size(); ++i)
            if (body->m_nodes[i].m_im > 0) mass += 1 / double(body->m_nodes[i].m_im);
    return mass;
}

GameWorld::GameWorld(const GameSettings& settings, double gravity)
    : m_settings(settings),
      m_gravity(gravity),
      m_world(infoOf(settings), settings.m_line, btVector3(0, btScalar(-gravity), 0))
{
}

btSoftBody& GameWorld::addSoft(btSoftBody* body, double youngModulus, double density, double friction)
{
    btFemMaterial material;
    material.m_youngModulus = btScalar(youngModulus);
    material.m_density = btScalar(density);
    return m_world.addSoft(body, material, friction, double(kFrame) / m_settings.m_subSteps);
}

btSoftBody& GameWorld::addSoft(btSoftBody* body)
{
    return m_world.addSoft(body, double(kFrame) / m_settings.m_subSteps);
}

GameFrame GameWorld::step()
{
    if (m_drive) m_drive(*this, m_frames * double(kFrame));
    ++m_frames;
    GameFrame frame;
    const btScalar h = kFrame / btScalar(m_settings.m_subSteps);
    for (int k = 0; k < m_settings.m_subSteps; ++k)
    {
        const Stopwatch watch;
        m_world.bullet().stepSimulation(h, 0);
        frame.m_milliseconds += 1e3 * watch.cpuSeconds();
        add(m_world.report(), frame);
        frame.m_held += heldIn(m_world.fem(), m_world.soft(), double(h)) / m_settings.m_subSteps;
    }
    return frame;
}

double GameWorld::softWeight() const
{
    return massOf(m_world.soft()) * m_gravity;
}

}  // namespace bullet_fem
