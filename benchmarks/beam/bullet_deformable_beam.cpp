// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/beam/bullet_deformable_beam.h"

#include <cmath>
#include <memory>

#include "benchmarks/bullet_deformable_world.h"
#include "benchmarks/figures.h"
#include "benchmarks/heap_bytes.h"

namespace bullet_fem
{
namespace
{

using VectorArray = btAlignedObjectArray<btVector3>;

/// Bullet's force with a counter of Bullet's CG iterations: each makes one stiffness product, after one before the
/// first iteration.
struct CountingElasticityForce : btDeformableLinearElasticityForce
{
    int m_products = 0;

    void addScaledElasticForceDifferential(btScalar scale, const VectorArray& dx, VectorArray& df) override
    {
        ++m_products;
        btDeformableLinearElasticityForce::addScaledElasticForceDifferential(scale, dx, df);
    }
};

/// Bullet's solver, which also computes the true residual after each solve and the time of that computation.
struct AuditedDeformableSolver : btDeformableBodySolver
{
    CountingElasticityForce* m_force = nullptr;
    int m_iterations = 0;
    double m_relativeResidual = 0;
    double m_auditSeconds = 0, m_auditCpuSeconds = 0;

    void setTolerance(double tolerance) { m_cg.m_tolerance = btScalar(tolerance); }

    void solveDeformableConstraints(btScalar step) override
    {
        m_force->m_products = 0;
        btDeformableBodySolver::solveDeformableConstraints(step);
        const Stopwatch watch;
        m_iterations = m_force->m_products - 1;
        measureResidual(step);
        m_auditCpuSeconds = watch.cpuSeconds();
        m_auditSeconds = watch.seconds();
    }

private:
    /// |b - A dv| / |b| over the free nodes. b is Bullet's right-hand side of this step: the forces at v_n and at x_n +
    /// h v_n. updateState restores the rotations that were frozen in the solve; then the solution is restored.
    void measureResidual(btScalar step)
    {
        const VectorArray dv = m_dv;
        VectorArray b, product;
        b.resize(m_numNodes, btVector3(0, 0, 0));
        product.resize(m_numNodes, btVector3(0, 0, 0));

        for (int i = 0; i < m_numNodes; ++i) m_dv[i].setZero();
        updateState();
        m_objective->computeResidual(step, b);
        m_objective->multiply(dv, product);
        m_dv = dv;
        updateVelocity();

        double squaredResidual = 0, squaredRightSide = 0;
        for (int i = 0; i < m_numNodes; ++i)
        {
            if (m_objective->m_nodes[i]->m_im == 0) continue;
            squaredResidual += (b[i] - product[i]).length2();
            squaredRightSide += b[i].length2();
        }
        m_relativeResidual = std::sqrt(squaredResidual / squaredRightSide);
    }
};

/// A deformable world that contains one soft body.
class DeformableBeamWorld
{
public:
    explicit DeformableBeamWorld(const BeamCase& beam) : m_world(m_solver, beam.m_gravity)
    {
        const std::vector<double> masses = lumpedNodeMasses(beam);
        m_body = std::make_unique<btSoftBody>(&m_world.world().getWorldInfo(), 0, nullptr, nullptr);
        for (std::size_t i = 0; i < masses.size(); ++i)
            m_body->appendNode(toBullet(beam.m_positions[i]), btScalar(masses[i]));
        for (int i : beam.m_clampedNodes) m_body->setMass(i, 0);
        for (const Tet& tet : beam.m_tets) m_body->appendTetra(tet[0], tet[1], tet[2], tet[3]);

        m_body->getCollisionShape()->setMargin(btScalar(1e-4));
        m_body->m_cfg.collisions = 0;  // excludes collision detection from the measured time
        m_body->setSelfCollision(false);
        m_world.add(*m_body, m_elasticForce, beam.m_material);
        m_solver.m_force = &m_elasticForce;
    }

    ~DeformableBeamWorld() { m_world.world().removeSoftBody(m_body.get()); }

    void step(double h) { m_world.step(h); }

    const btSoftBody& body() const { return *m_body; }
    AuditedDeformableSolver& solver() { return m_solver; }

private:
    AuditedDeformableSolver m_solver;
    CountingElasticityForce m_elasticForce;
    BulletDeformableWorld m_world;
    std::unique_ptr<btSoftBody> m_body;
};

}  // namespace

BeamRun runBulletDeformable(const BeamCase& beam, double tolerance)
{
    BeamRun run;
    run.m_method = "bullet";
    run.m_tolerance = tolerance;
    run.m_tipBound = 6e-3;  // allows for the different point of linearisation

    const std::size_t heapBefore = heapBytes();
    const Stopwatch setUp;
    DeformableBeamWorld world(beam);
    run.m_setupSeconds = setUp.seconds();
    if (tolerance > 0) world.solver().setTolerance(tolerance);
    for (int i = 0; i < world.body().m_nodes.size(); ++i)
        if (world.body().m_nodes[i].m_im > 0) run.m_mass += 1.0 / world.body().m_nodes[i].m_im;

    for (int step = 0; step < beam.m_steps; ++step)
    {
        const Stopwatch watch;
        world.step(beam.m_step);
        run.m_cpuSeconds.push_back(watch.cpuSeconds() - world.solver().m_auditCpuSeconds);
        run.m_stepSeconds.push_back(watch.seconds() - world.solver().m_auditSeconds);
        run.m_iterations.push_back(world.solver().m_iterations);
        run.m_residuals.push_back(world.solver().m_relativeResidual);
        run.m_tipHeights.push_back(world.body().m_nodes[beam.m_tipNode].m_x.z());
    }
    run.m_heapBytes = heapBytes() - heapBefore;
    return run;
}

}  // namespace bullet_fem
