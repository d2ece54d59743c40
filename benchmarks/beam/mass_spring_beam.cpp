// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/beam/mass_spring_beam.h"

#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <memory>
#include <set>
#include <utility>

#include "benchmarks/bullet_deformable_world.h"
#include "benchmarks/figures.h"
#include "benchmarks/heap_bytes.h"

namespace bullet_fem
{
namespace
{

/// Each edge once, as (lower node, higher node).
std::set<std::pair<int, int>> edgesOf(const std::vector<Tet>& tets)
{
    std::set<std::pair<int, int>> edges;
    for (const Tet& tet : tets)
        for (int a = 0; a < 4; ++a)
            for (int b = a + 1; b < 4; ++b) edges.insert(std::minmax(tet[a], tet[b]));
    return edges;
}

/// Bullet's default soft body world with one mass-spring soft body.
class MassSpringWorld
{
public:
    MassSpringWorld(const BeamCase& beam, int iterations)
        : m_world(&m_dispatcher, &m_broadphase, &m_rigidSolver, &m_configuration)
    {
        m_world.setGravity(toBullet(beam.m_gravity));
        m_world.getWorldInfo().m_gravity = toBullet(beam.m_gravity);
        m_body = std::make_unique<btSoftBody>(&m_world.getWorldInfo(), 0, nullptr, nullptr);
        const std::vector<double> masses = lumpedNodeMasses(beam);
        for (std::size_t i = 0; i < masses.size(); ++i)
            m_body->appendNode(toBullet(beam.m_positions[i]), btScalar(masses[i]));
        for (int i : beam.m_clampedNodes) m_body->setMass(i, 0);
        for (const auto& edge : edgesOf(beam.m_tets)) m_body->appendLink(edge.first, edge.second);
        m_body->m_cfg.piterations = iterations;
        m_body->m_cfg.collisions = 0;
        m_body->setActivationState(DISABLE_DEACTIVATION);
        m_world.addSoftBody(m_body.get());
    }

    ~MassSpringWorld() { m_world.removeSoftBody(m_body.get()); }

    void step(double h) { m_world.stepSimulation(btScalar(h), 0); }

    const btSoftBody& body() const { return *m_body; }

private:
    btSoftBodyRigidBodyCollisionConfiguration m_configuration;
    btCollisionDispatcher m_dispatcher{&m_configuration};
    btDbvtBroadphase m_broadphase;
    btSequentialImpulseConstraintSolver m_rigidSolver;
    btSoftRigidDynamicsWorld m_world;
    std::unique_ptr<btSoftBody> m_body;
};

}  // namespace

BeamRun runMassSpring(const BeamCase& beam, int iterations)
{
    BeamRun run;
    run.m_method = "mass-spring";
    run.m_sameModel = false;

    const std::size_t heapBefore = heapBytes();
    const Stopwatch setUp;
    MassSpringWorld world(beam, iterations);
    run.m_setupSeconds = setUp.seconds();
    for (int i = 0; i < world.body().m_nodes.size(); ++i)
        if (world.body().m_nodes[i].m_im > 0) run.m_mass += 1.0 / world.body().m_nodes[i].m_im;

    for (int step = 0; step < beam.m_steps; ++step)
    {
        const Stopwatch watch;
        world.step(beam.m_step);
        run.m_cpuSeconds.push_back(watch.cpuSeconds());
        run.m_stepSeconds.push_back(watch.seconds());
        run.m_iterations.push_back(iterations);
        run.m_tipHeights.push_back(world.body().m_nodes[beam.m_tipNode].m_x.z());
    }
    run.m_heapBytes = heapBytes() - heapBefore;
    return run;
}

}  // namespace bullet_fem
