// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/solve/warped_compliance.h"

#include <algorithm>

#include "fem/body/step_scratch.h"
#include "fem/solve/warped_system.h"

namespace bullet_fem
{
namespace
{

// At 1e-3 some beams of HardPressedBeam are faster than 2 m/s; 1e-6 is finer than single precision.
constexpr double kLowMemoryTolerance = 1e-3, kPresentTolerance = 1e-4;

}  // namespace

void WarpedCompliance::apply(const std::vector<Vec3>& in, std::vector<Vec3>& out) const
{
    applyElastic(in, out);
    m_body.m_workspace.scratch().m_momentum.addResponse(m_body, in, out);
}

void WarpedCompliance::applyElastic(const std::vector<Vec3>& in, std::vector<Vec3>& out) const
{
    const std::vector<Vec3>& elastic = rightSide(in);
    if (m_body.m_model->factorReport().m_path == FactorPath::full)
        WarpedPreconditioner(m_body, m_threads).apply(elastic, out);
    else
        solve(kLowMemoryTolerance, elastic, out);
    for (Vec3& v : out) v *= m_scale;
}

void WarpedCompliance::applyPresent(const std::vector<Vec3>& in, std::vector<Vec3>& out) const
{
    solve(kPresentTolerance, rightSide(in), out);
}

// The impulses on free nodes without their rigid part.
std::vector<Vec3>& WarpedCompliance::rightSide(const std::vector<Vec3>& in) const
{
    std::vector<Vec3>& elastic = m_body.m_workspace.scratch().m_rightSide;
    for (std::size_t i = 0; i < in.size(); ++i) elastic[i] = m_body.m_state.m_fixed[i] ? Vec3() : in[i];
    m_body.m_workspace.scratch().m_momentum.removeImpulses(m_body, elastic);
    return elastic;
}

void WarpedCompliance::solve(double tolerance, const std::vector<Vec3>& in, std::vector<Vec3>& out) const
{
    const WarpedPreconditioner P(m_body, m_threads);
    std::fill(out.begin(), out.end(), Vec3());
    ConjugateGradientStop stop;
    stop.m_tolerance = tolerance;
    const WarpedSystem A(m_body, m_threads);
    solveConjugateGradients({A, P, in, out, m_body.m_workspace.scratch().m_solver, m_threads}, stop);
}

}  // namespace bullet_fem
