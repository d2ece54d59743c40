// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/solve/actuated_solve.h"

#include <cmath>

#include "fem/body/step_coefficients.h"
#include "fem/body/step_scratch.h"
#include "fem/solve/warped_system.h"

namespace bullet_fem
{
namespace
{

class ActuatedSolver
{
public:
    ActuatedSolver(Body& body, const StepSettings& settings)
        : m_body(body),
          m_settings(settings),
          m_scratch(body.m_workspace.scratch()),
          m_actuation(m_scratch.m_actuation),
          m_A(body, settings.m_threads),
          m_P(body, settings.m_threads),
          m_actuated(m_P, m_actuation, body.m_actuators)
    {
    }

    SolveReport solve(const ConjugateGradientStop& stop, bool isGuessed) const
    {
        const LinearOperator& P = m_actuation.isStiff() ? static_cast<const LinearOperator&>(m_actuated) : m_P;
        return solveConjugateGradients(
            {m_A, P, m_scratch.m_rightSide, m_scratch.m_increment, m_scratch.m_solver, m_settings.m_threads}, stop,
            isGuessed);
    }

    // Subtracts the stiff actuators' answer first: their part of b would dominate the tolerance and the single
    // precision of P.
    SolveReport solveLifted(const ConjugateGradientStop& stop, bool isGuessed) const
    {
        if (!m_actuation.isStiff()) return solve(stop, isGuessed);
        std::vector<Vec3>&x = m_scratch.m_increment, &b = m_scratch.m_rightSide, &Ax = m_scratch.m_solver.m_Ap;
        const std::vector<Vec3>& lift = m_actuation.lift();
        m_A.apply(lift, Ax);
        for (std::size_t i = 0; i < b.size(); ++i) b[i] -= Ax[i];
        if (isGuessed)
        {
            for (std::size_t i = 0; i < x.size(); ++i) x[i] -= lift[i];
            m_actuation.correct(m_body.m_actuators, x);
        }
        const SolveReport report = solve(stop, isGuessed);
        for (std::size_t i = 0; i < x.size(); ++i) x[i] += lift[i];
        if (m_body.m_actuators.m_cables.empty()) return report;  // no cable to release
        m_A.apply(lift, Ax);
        for (std::size_t i = 0; i < b.size(); ++i) b[i] += Ax[i];
        return report;
    }

    SolveReport solveFree(const ConjugateGradientStop& stop, bool isGuessed)
    {
        SolveReport report;
        int before = 0;
        do
        {
            if (m_actuation.isStiff()) m_actuation.factor(m_body.m_actuators, m_P);
            report = solveLifted(stop, isGuessed);
            report.m_iterations += before;
            before = report.m_iterations;
        } while (m_actuation.isStiff() && releaseSlack());
        return report;
    }

private:
    bool releaseSlack() const
    {
        return m_actuation.releaseSlack(m_body.m_actuators, m_body.m_state.m_fixed, m_scratch.m_increment,
                                        m_scratch.m_rightSide);
    }

    Body& m_body;
    const StepSettings& m_settings;
    StepScratch& m_scratch;
    Actuation& m_actuation;
    const WarpedSystem m_A;
    const WarpedPreconditioner m_P;
    const ActuatedPreconditioner m_actuated;
};

}  // namespace

void beginActuation(Body& body, const StepSettings& settings)
{
    StepScratch& scratch = body.m_workspace.scratch();
    const StepCoefficients coefficients(settings, body);
    const double h = settings.m_step;
    const PullFactors factors = {h, coefficients.m_damping * h, coefficients.stiffness() * h * h};
    scratch.m_actuation.begin(body.m_actuators, factors, scratch.m_kickPosition, scratch.m_velocity);
}

double actuatorImpulseNorm(const Body& body)
{
    const Actuation& actuation = body.m_workspace.scratch().m_actuation;
    return actuation.step() * std::sqrt(actuation.squaredForces(body.m_actuators));
}

SolveReport solveActuated(Body& body, const StepSettings& settings, const ConjugateGradientStop& stop, bool isGuessed,
                          SolveOf what)
{
    ActuatedSolver solver(body, settings);
    if (what == SolveOf::freeMotion) return solver.solveFree(stop, isGuessed);
    return what == SolveOf::response ? solver.solve(stop, isGuessed) : solver.solveLifted(stop, isGuessed);
}

}  // namespace bullet_fem
