// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/step/energy_limit.h"

#include <algorithm>
#include <cmath>

#include "fem/body/step_coefficients.h"
#include "fem/body/step_scratch.h"
#include "fem/elements/patch_frame.h"
#include "fem/solve/drift.h"
#include "fem/step/elastic_energy.h"
#include "fem/step/one_body.h"

namespace bullet_fem
{
namespace
{

// Gain of energy that is accepted, as a share of the energy before the step and the work in it [-]: of bodies that roll
// and swing along chords, and of distorted ones. Without the second, these gain several times their energy within
// seconds (EnergyLimit).
constexpr double kMaxEnergyGain = 1, kMaxGainOfDistorted = 0.01;

// Root mean square stretch from which on an element is distorted [-]; so is one that is inside out. With 3 bodies of
// Neo-Hookean material gain energy (EnergyLimit).
constexpr double kFarStretch = 2;

// Trials of shorter motions. Each takes the fourth root of the gain that is left: strain along chords grows with the
// square of the motion, and its energy with the fourth power.
constexpr int kMaxTrials = 8;

class EnergyLimit
{
public:
    EnergyLimit(Body& body, const StepSettings& settings, double unresolved)
        : m_body(body),
          m_state(body.m_state),
          m_scratch(body.m_workspace.scratch()),
          m_step(settings.m_step),
          m_theta(StepCoefficients(settings, body).theta()),
          m_unresolved(unresolved)
    {
    }

    // True if other work than that of loads, contacts and joints is done on the body.
    bool isDriven() const
    {
        if (m_body.m_actuators.hasPulls()) return true;
        for (std::size_t i = 0; i < m_state.m_fixed.size(); ++i)
            if (m_state.m_fixed[i] && dot(m_body.m_loads.m_targetVelocity[i], m_body.m_loads.m_targetVelocity[i]) > 0)
                return true;
        return false;
    }

    // True if the chords of this step cannot stretch elements enough. The bound is one of Hooke's law, and of others
    // while no element is distorted.
    bool isGentle()
    {
        findLoadEnergy();
        const double given = m_kinetic + m_ofLoads;
        const bool isBounded = !m_body.m_model->shape().m_materials.isNonlinear();
        std::vector<Vec3>& w = elastic();
        w.assign(m_scratch.m_velocity.begin(), m_scratch.m_velocity.end());
        if (isBounded && chordEnergy(w.front()) <= kMaxGainOfDistorted * given) return true;
        removeRigidVelocity(m_body, w);
        const double energy = chordEnergy(Vec3());
        if (isBounded && energy <= kMaxGainOfDistorted * given) return true;
        if (!isDistorted()) return energy <= kMaxEnergyGain * given;
        m_maxGain = kMaxGainOfDistorted;
        return false;
    }

    // True if the step gains more energy than is accepted.
    bool isExceeded()
    {
        m_before = m_kinetic + elasticEnergy(m_body, m_state.m_x);
        return excessOf(1) > 1;
    }

    // Lets the body turn along arcs, and shortens the elastic motion until the gain is accepted.
    void shorten()
    {
        m_scratch.m_isTurned = true;
        double length = 1;
        for (int trial = 0; trial < kMaxTrials; ++trial)
        {
            const double excess = excessOf(length);
            if (!(excess > 1)) break;
            length *= std::pow(excess, -0.25);
        }
        for (std::size_t i = 0; i < m_state.m_fixed.size(); ++i)
            if (!m_state.m_fixed[i]) m_scratch.m_velocity[i] -= (1 - length) * elastic()[i];
    }

private:
    // Scratch of the solves, which are over: elastic velocities [m/s] and positions at the end [m].
    std::vector<Vec3>& elastic() { return m_scratch.m_rightSide; }
    std::vector<Vec3>& positions() { return m_scratch.m_solver.m_p; }

    // Kinetic energy before, and that of the speeds that the loads give in the step.
    void findLoadEnergy()
    {
        m_kinetic = kineticEnergy(m_state, m_state.m_v);
        m_ofLoads = 0;
        const std::vector<Vec3>& force = m_body.m_loads.m_force;
        for (std::size_t i = 0; i < force.size(); ++i)
            if (!m_state.m_fixed[i]) m_ofLoads += 0.5 * m_step * m_step / m_state.m_mass[i] * dot(force[i], force[i]);
    }

    // True if an element is inside out, or stretched far.
    bool isDistorted() const
    {
        const RestShape& shape = m_body.m_model->shape();
        for (int e = 0; e < static_cast<int>(shape.m_elements.size()); ++e)
        {
            const Mat3 F = deformationGradient(shape, e, m_state.m_x);
            if (determinant(F) <= 0 || squaredNorm(F) > 3 * kFarStretch * kFarStretch) return true;
        }
        return false;
    }

    // A displacement gradient s gives an element of stiffness K = (2 mu + lambda) V at most the energy K s^4 / 8.
    // Either s is that of the fastest node everywhere, or that of each node in the elements around it, four per
    // element. Returns that of the body [J].
    double chordEnergy(const Vec3& rigid)
    {
        double mass = 0, most = 0, sum = 0;  // sum of m |v|^4
        for (std::size_t i = 0; i < m_state.m_mass.size(); ++i)
        {
            const Vec3 v = elastic()[i] - rigid;
            const double square = dot(v, v);
            most = std::max(most, square);
            mass += m_state.m_mass[i];
            sum += m_state.m_mass[i] * square * square;
        }
        const double perSpeed = 2 * m_step / m_body.m_model->mesh().shortestHeight();
        const double fourth = std::pow(perSpeed, 4) * std::min(most * most, 4 / mass * sum);
        return m_scratch.m_elasticEnergy.m_stiffness / 8 * fourth;
    }

    // The gain of energy with a share of the elastic motion, over the accepted one.
    double excessOf(double length)
    {
        const std::vector<Vec3>&x = m_state.m_x, &drift = m_scratch.m_drift, &w = elastic();
        double kinetic = 0, work = 0, effort = 0;
        for (std::size_t i = 0; i < x.size(); ++i)
        {
            const bool isFixed = m_state.m_fixed[i];
            const Vec3 v = m_scratch.m_velocity[i] - (isFixed ? 0 : 1 - length) * w[i];
            const Vec3 end = isFixed ? m_body.m_loads.m_targetVelocity[i] : v - m_unresolved * m_scratch.m_increment[i];
            kinetic += 0.5 * m_state.m_mass[i] * dot(end, end);
            const double done = dot(m_step * loadOn(i, v) + m_scratch.m_impulses[i], drift[i] + m_theta * v);
            work += done;
            effort += std::abs(done);
            // Turning the body changes no shape: for bodies that turn exactly, only the elastic displacement counts.
            positions()[i] =
                m_scratch.m_kickPosition[i] + m_theta * m_step * (m_scratch.m_isTurned ? length * w[i] : v);
        }
        const double gain = kinetic + elasticEnergy(m_body, positions()) - m_before - work;
        return gain / (m_maxGain * (std::abs(m_before) + effort + m_ofLoads));
    }

    // Force of the loads and of the frame damping on a node that moves with v [N].
    Vec3 loadOn(std::size_t i, const Vec3& v) const
    {
        const StepLoads& loads = m_body.m_loads;
        if (loads.m_frameDamping == 0) return loads.m_force[i];
        return loads.m_force[i] + loads.m_frameDamping * m_state.m_mass[i] * (loads.m_frameVelocity[i] - v);
    }

    Body& m_body;
    const BodyState& m_state;
    StepScratch& m_scratch;
    const double m_step;   // h [s]
    const double m_theta;  // see StepCoefficients
    const double m_unresolved;
    double m_kinetic = 0, m_ofLoads = 0, m_before = 0;  // [J]
    double m_maxGain = kMaxEnergyGain;                  // [-]
};

// Solves a step of second order again, as implicit Euler step, with all its impulses.
void solveFullyDamped(Body& body, const StepSettings& settings)
{
    if (!(StepCoefficients(settings, body).m_damping < 1)) return;
    StepScratch& scratch = body.m_workspace.scratch();
    scratch.m_leastDamping = 1;
    FreeMotion motion;
    motion.m_body = &body;
    motion.m_settings = settings;
    solveAlone(motion);
    ImpulseResponse response{&body, &scratch.m_impulses, settings, 0, false, {}};
    solveAlone(response);
    scratch.m_momentum.repeatAngularImpulses();
    scratch.m_momentum.restore(body, scratch.m_velocity);
}

}  // namespace

bool limitEnergy(Body& body, const StepSettings& settings, double& unresolved)
{
    EnergyLimit limit(body, settings, unresolved);
    if (limit.isDriven() || limit.isGentle()) return false;
    if (!limit.isExceeded()) return false;
    unresolved = 0;
    solveFullyDamped(body, settings);
    EnergyLimit damped(body, settings, 0);
    if (!damped.isGentle() && damped.isExceeded()) damped.shorten();
    return true;
}

}  // namespace bullet_fem
