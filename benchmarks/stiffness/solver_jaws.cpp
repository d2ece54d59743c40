// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/stiffness/solver_jaws.h"

#include <cmath>
#include <memory>
#include <utility>

#include "benchmarks/stiffness/jaw_motion.h"
#include "bullet_fem/fem/contact/contact_solver.h"
#include "bullet_fem/fem/step/stepping.h"

namespace bullet_fem
{
namespace
{

double sideOf(int jaw)
{
    return jaw == 0 ? -1 : 1;
}

// The nodes of the faces along z against the jaws, which are the rigid proxies 0 and 1.
void touchFaces(const TetMesh& mesh, double height, ContactProblem& problem)
{
    problem.m_rigidProxies.resize(2);
    for (int i = 0; i < mesh.nodeCount(); ++i)
        for (int jaw = 0; jaw < 2; ++jaw)
        {
            if (std::fabs(mesh.restPositions()[i].z - sideOf(jaw) * height / 2) > 1e-6 * height) continue;
            ContactPoint contact;
            contact.m_soft = {0, {i, i, i}, {1, 0, 0}};
            contact.m_rigidProxy = jaw;
            contact.m_normal = Vec3{0, 0, -sideOf(jaw)};
            problem.m_contacts.push_back(contact);
        }
}

// Gaps at the start of a step, and the jaws' velocities in it.
void moveJaws(const JawMotion& jaws, double time, const Body& cube, ContactProblem& problem)
{
    const double before = jaws.distanceAt(time), after = jaws.distanceAt(time + StiffnessCase::kStep);
    for (int jaw = 0; jaw < 2; ++jaw)
        problem.m_rigidProxies[jaw].m_linearVelocity =
            Vec3{0, 0, sideOf(jaw) * (after - before) / StiffnessCase::kStep};
    for (ContactPoint& contact : problem.m_contacts)
    {
        contact.m_point = cube.m_state.m_x[contact.m_soft.m_nodes[0]];
        contact.m_gap = before - sideOf(contact.m_rigidProxy) * contact.m_point.z;
    }
}

}  // namespace

Body makeFreeBody(const TetMesh& mesh, const StiffnessCase& of)
{
    const auto shape = std::make_shared<const RestShape>(mesh, of.material());
    FactorInput input;
    input.m_mass = shape->m_lumpedMass;
    input.m_step = StiffnessCase::kStep;
    input.m_fixed.assign(static_cast<std::size_t>(mesh.nodeCount()), 0);
    return Body(BodyModel::create(shape, std::move(input)));
}

CubeFigures pressBySolver(const StiffnessCase& of)
{
    const double h = StiffnessCase::kStep;
    const JawMotion jaws{JawMotion::kCells * of.m_edge};
    const TetMesh mesh = jaws.mesh();
    Body cube = makeFreeBody(mesh, of);
    const std::shared_ptr<ComplianceCache> cache = makeComplianceCache(cube.m_model);
    ContactProblem problem;
    problem.m_bodies = {{&cube, cache.get()}};
    touchFaces(mesh, jaws.m_height, problem);
    ContactSettings settings;
    settings.m_step.m_step = h;
    ContactSolver solver;
    CubeFigures figures;
    double impulse = 0;
    int atRest = 0;
    for (int k = 0; k * h < JawMotion::kEnd; ++k)
    {
        solveFreeMotion(cube, settings.m_step);
        moveJaws(jaws, k * h, cube, problem);
        const ContactReport report = solver.solve(problem, settings);
        finishStep(cube, settings.m_step);
        figures.m_rounds.add(report.m_rounds);
        figures.m_sweeps.add(report.m_sweeps);
        figures.m_iterations.add(report.m_iterations);
        for (const Vec3& v : cube.m_state.m_v) figures.m_fastest = std::max(figures.m_fastest, norm(v) / jaws.speed());
        if (k * h < JawMotion::kAtRest) continue;
        ++atRest;
        for (const ContactPoint& contact : problem.m_contacts)
            if (contact.m_rigidProxy == 1) impulse -= contact.m_impulse.z;
    }
    figures.m_force = impulse / (atRest * h * jaws.force(of.m_young));
    Vec3 sum;
    for (const Vec3& x : cube.m_state.m_x) sum += x;
    figures.m_isThrown = !(norm(sum) < mesh.nodeCount() * jaws.m_height / 2);
    return figures;
}

}  // namespace bullet_fem
