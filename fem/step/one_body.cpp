// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/step/one_body.h"

#include <algorithm>
#include <cmath>

#include "fem/body/step_coefficients.h"
#include "fem/body/step_scratch.h"
#include "fem/solve/actuated_solve.h"
#include "fem/solve/drift.h"
#include "fem/solve/quasi_newton.h"
#include "fem/solve/smoothing.h"
#include "fem/solve/step_stages.h"
#include "fem/solve/strain_increment.h"
#include "fem/solve/warped_system.h"

namespace bullet_fem
{
namespace
{

// Minimum size of a body that is shared among threads [nodes], of some 5 tets each: smaller ones are solved in less
// time than sharing takes.
constexpr int kNodesToShare = 1000;

class OneBody
{
public:
    OneBody(Body& body, const StepSettings& settings, SolveOf what)
        : m_body(body),
          m_state(body.m_state),
          m_scratch(body.m_workspace.scratch()),
          m_settings(settings),
          m_coefficients(settings, body),
          m_A(body, settings.m_threads),
          m_solveOf(what)
    {
    }

    void solve()
    {
        m_scratch.m_momentum.removeImpulses(m_body, m_scratch.m_rightSide);
        if (isActuated())
        {
            m_report = solveActuated(m_body, m_settings, m_stop, m_isGuessed, m_solveOf);
            return;
        }
        const WarpedPreconditioner P(m_body, m_settings.m_threads);
        m_report = solveConjugateGradients(
            {m_A, P, m_scratch.m_rightSide, m_scratch.m_increment, m_scratch.m_solver, m_settings.m_threads}, m_stop,
            m_isGuessed);
    }

    void addIncrement()
    {
        std::vector<Vec3>& v = m_scratch.m_velocity;
        for (std::size_t i = 0; i < v.size(); ++i)
            if (!m_state.m_fixed[i]) v[i] += m_scratch.m_increment[i];
        m_scratch.m_momentum.restore(m_body, v);
    }

    // Keeps the residual of the impulse response, except after a breakdown, when it may not be finite.
    void keepResidual()
    {
        m_scratch.m_hasResidual = m_report.m_stop != SolveStop::breakdown;
        if (m_scratch.m_hasResidual) m_scratch.m_residual = m_scratch.m_solver.m_r;
    }

    const SolveReport& report() const { return m_report; }

protected:
    bool isActuated() const { return m_body.m_actuators.hasPulls(); }

    Body& m_body;
    BodyState& m_state;
    StepScratch& m_scratch;
    const StepSettings& m_settings;
    StepCoefficients m_coefficients;
    const WarpedSystem m_A;
    const SolveOf m_solveOf;
    ConjugateGradientStop m_stop;
    bool m_isGuessed = true;  // false: dv is zero
    SolveReport m_report;
};

class OneFreeMotion : public OneBody
{
public:
    OneFreeMotion(const FreeMotion& motion, const StepSettings& settings)
        : OneBody(*motion.m_body, settings, SolveOf::freeMotion), m_motion(motion), m_loads(m_body.m_loads)
    {
    }

    void readState()
    {
        m_stop = stopOf(m_settings, kLoadFloor * loadImpulseNorm(), m_motion.m_predicted != nullptr);
        beginDrift(m_body, m_settings);
        m_scratch.m_reactions.noteKick(m_scratch.m_kickVelocity);
        if (isActuated())
        {
            beginActuation(m_body, m_settings);
            m_stop.m_floor = std::max(m_stop.m_floor, kLoadFloor * actuatorImpulseNorm(m_body));
        }
    }

    void prescribeMomentum()
    {
        m_scratch.m_momentum.prescribe(m_body, m_settings.m_step);
        noteArcs(m_body, m_settings);
    }

    void passOverElements() { makeRightSide(); }

    void averageRotations() { averageNodeRotations(m_body, m_settings); }

    // Eliminates prescribed velocities: dv_p = v_target - v, b_f -= A_fp dv_p, and b_p = 0.
    void eliminateFixedNodes()
    {
        addOutsideChange();
        if (m_scratch.m_reactions.isNoting()) m_scratch.m_reactions.noteRightSide(m_scratch.m_rightSide);
        std::vector<Vec3>&dv = m_scratch.m_increment, &b = m_scratch.m_rightSide, &Adv = m_scratch.m_solver.m_Ap;
        bool moving = false;
        for (std::size_t i = 0; i < dv.size(); ++i)
        {
            dv[i] = m_state.m_fixed[i] ? m_scratch.m_velocity[i] - m_scratch.m_kickVelocity[i] : Vec3();
            moving = moving || dot(dv[i], dv[i]) > 0;
        }
        if (moving)
        {
            m_A.applyUnconstrained(dv, Adv);
            for (std::size_t i = 0; i < b.size(); ++i) b[i] -= Adv[i];
            if (isActuated()) m_scratch.m_actuation.subtractFromRightSide(m_body.m_actuators, dv, b);
        }
        for (std::size_t i = 0; i < b.size(); ++i)
            if (m_state.m_fixed[i]) b[i] = {};
    }

    // Adds the predicted impulses to b and to the prescribed momentum.
    void addPredictedImpulses()
    {
        if (!m_motion.m_predicted) return;
        const std::vector<Vec3>& impulses = *m_motion.m_predicted;
        double sum = 0;
        for (std::size_t i = 0; i < impulses.size(); ++i)
        {
            if (m_state.m_fixed[i]) continue;
            m_scratch.m_rightSide[i] += impulses[i];
            if (m_scratch.m_newton.isUsed()) m_scratch.m_newton.m_loads[i] += impulses[i];
            sum += dot(impulses[i], impulses[i]);
        }
        m_scratch.m_momentum.addImpulses(m_body, impulses, m_settings.m_step);
        m_stop.m_floor = std::max(m_stop.m_floor, m_motion.m_predictedFloor * std::sqrt(sum));
    }

    // Warm start: the increments of the last two steps, extrapolated linearly, because most motion is smooth. With
    // predicted impulses: zero.
    void guessIncrement()
    {
        const std::vector<Vec3>&last = m_state.m_lastIncrement[0], &before = m_state.m_lastIncrement[1];
        std::vector<Vec3>& dv = m_scratch.m_increment;
        const bool isSmooth = !m_motion.m_predicted;
        for (std::size_t i = 0; i < dv.size(); ++i)
            dv[i] = isSmooth && !m_state.m_fixed[i] ? 2.0 * last[i] - before[i] : Vec3();
        m_scratch.m_momentum.removeMotion(m_body, dv);
    }

    // Bodies with actuators or external velocity changes keep the linear solution.
    void correctIncrement()
    {
        if (!m_scratch.m_newton.isUsed() || m_settings.m_direct || isActuated() || !m_loads.m_priorVelocity.empty())
            return;
        if (!exceedsStrainIncrement(m_body, m_settings.m_step, m_scratch.m_velocity, &m_scratch.m_increment,
                                    kMaxStrainIncrement, m_settings.m_threads))
            return;
        QuasiNewton(m_body, m_settings, m_A).correct(m_stop, m_report);
    }

    // Increments with predicted impulses are no warm start for steps without.
    void keepIncrement()
    {
        if (m_motion.m_predicted)
            keepResidual();
        else
        {
            std::swap(m_state.m_lastIncrement[0], m_state.m_lastIncrement[1]);
            m_state.m_lastIncrement[0] = m_scratch.m_increment;
            m_scratch.m_hasResidual = false;
        }
        m_scratch.m_reactions.noteSolved(m_scratch.m_velocity);
        driftByOutsideChange(m_body, m_settings);
        noteMeanVelocity(m_body, m_settings);
    }

private:
    // h |f_ext| over the free nodes.
    double loadImpulseNorm() const
    {
        double sum = 0;
        for (std::size_t i = 0; i < m_loads.m_force.size(); ++i)
            if (!m_state.m_fixed[i]) sum += dot(m_loads.m_force[i], m_loads.m_force[i]);
        return m_settings.m_step * std::sqrt(sum);
    }

    // b = h (f_ext + f_el(y) - alpha M v - (s h + beta) K' w) + the centrifugal impulses, and A of this step, with the
    // elastic velocities w; along chords without these, and w less the chords' strain.
    void makeRightSide()
    {
        const double alpha = RigidMomentum::damping(m_body), toFrame = m_loads.m_frameDamping;
        std::vector<Vec3>& b = m_scratch.m_rightSide;
        const std::vector<Vec3>& v = m_scratch.m_kickVelocity;
        for (std::size_t i = 0; i < b.size(); ++i) b[i] = m_loads.m_force[i] - alpha * m_state.m_mass[i] * v[i];
        for (std::size_t i = 0; i < b.size() && toFrame > 0; ++i)
            b[i] += toFrame * m_state.m_mass[i] * (m_loads.m_frameVelocity[i] - v[i]);
        if (isActuated()) m_scratch.m_actuation.addForces(m_body.m_actuators, v, b);
        const std::vector<Vec3>& elastic = findElastic();
        std::vector<Vec3>& loads = m_scratch.m_newton.m_loads;
        for (std::size_t i = 0; i < loads.size(); ++i) loads[i] = m_settings.m_step * b[i];
        if (!loads.empty()) addCentrifugal(loads);
        prepareWarpedSystem(m_body, m_settings, m_scratch.m_kickPosition, m_scratch.m_increment, b);
        for (Vec3& bi : b) bi *= m_settings.m_step;
        addCentrifugal(b);
        dampByTension(elastic);
    }

    void addCentrifugal(std::vector<Vec3>& b) const
    {
        if (m_scratch.m_isTurned) m_scratch.m_momentum.addCentrifugal(m_body, m_settings.m_step, b);
    }

    // b -= r c h^2 T w.
    void dampByTension(const std::vector<Vec3>& elastic)
    {
        const double r = m_scratch.m_stepVariation;
        if (!(r > 0) || !m_settings.m_tension) return;
        std::vector<Vec3>&b = m_scratch.m_rightSide, &Tw = m_scratch.m_increment;
        m_A.applyTension(elastic, Tw);
        for (std::size_t i = 0; i < b.size(); ++i) b[i] -= r * Tw[i];
    }

    // The elastic velocities w, and (s h + beta) w in the increment.
    const std::vector<Vec3>& findElastic()
    {
        const double beta = m_body.m_model->shape().m_material.m_stiffnessDamping;
        const double share = m_coefficients.m_damping * m_settings.m_step + beta;
        std::vector<Vec3>&elastic = m_scratch.m_solver.m_Ap, &viscous = m_scratch.m_increment;
        elastic = m_scratch.m_kickVelocity;
        removeRigidVelocity(m_body, elastic);
        for (std::size_t i = 0; i < elastic.size(); ++i) viscous[i] = share * elastic[i];
        const double chord = m_coefficients.chordStrain(m_body, m_settings.m_step, beta) * m_settings.m_step;
        addInward(m_body, -chord, viscous);
        return elastic;
    }

    // The strain of an external change of velocity acts as impulses, so that the tension T in A resists it. Otherwise
    // the tension that should pull back a repeatedly accelerated node would hold it in place.
    void addOutsideChange()
    {
        if (!m_scratch.m_isStrained) return;
        std::vector<Vec3>& b = m_scratch.m_rightSide;
        for (std::size_t i = 0; i < b.size(); ++i) b[i] += m_state.m_mass[i] * m_scratch.m_strained[i];
    }

    const FreeMotion& m_motion;
    StepLoads& m_loads;
};

class OneResponse : public OneBody
{
public:
    OneResponse(const ImpulseResponse& response, const StepSettings& settings)
        : OneBody(*response.m_body, settings, SolveOf::response), m_response(response)
    {
        m_stop = stopOf(settings, response.m_floor, response.m_steady);
    }

    void readImpulses()
    {
        std::vector<Vec3>& b = m_scratch.m_rightSide;
        for (std::size_t i = 0; i < b.size(); ++i) b[i] = m_state.m_fixed[i] ? Vec3() : (*m_response.m_impulses)[i];
    }

    void completeSystem() { completeWarpedSystem(m_body, m_settings); }

    void addMomentum() { m_scratch.m_momentum.addImpulses(m_body, m_scratch.m_rightSide, m_settings.m_step); }

    void addResidual()
    {
        std::vector<Vec3>& b = m_scratch.m_rightSide;
        for (std::size_t i = 0; i < b.size() && m_scratch.m_hasResidual; ++i) b[i] += m_scratch.m_residual[i];
    }

    void guessResponse()
    {
        std::vector<Vec3>& dv = m_scratch.m_increment;
        if (!m_response.m_steady) return std::fill(dv.begin(), dv.end(), Vec3());
        for (std::size_t i = 0; i < dv.size(); ++i)
            dv[i] = m_state.m_fixed[i] ? Vec3() : m_scratch.m_kickVelocity[i] - m_scratch.m_velocity[i];
        m_scratch.m_momentum.removeMotion(m_body, dv);
    }

private:
    const ImpulseResponse& m_response;
};

class OneSmoothing : public OneBody
{
public:
    OneSmoothing(const StepEnd& end, const StepSettings& settings) : OneBody(*end.m_body, settings, SolveOf::change) {}

    void readChange() { m_stop = smoothingStop(m_body, m_settings); }
    void completeSystem() { completeWarpedSystem(m_body, m_settings); }
    void applyStiffness()
    {
        m_A.applyStiffness(m_scratch.m_increment, m_scratch.m_rightSide);
        if (isActuated()) m_scratch.m_actuation.setRightSide(m_body.m_actuators, m_scratch.m_increment);
        std::fill(m_scratch.m_increment.begin(), m_scratch.m_increment.end(), Vec3());
        m_isGuessed = false;
    }
    void keepUnresolved() {}
};

// Calls solve(one) on the settings' threads, or without them if the body is too small to share.
template <class One, class Job, class Solve>
SolveReport solveWith(const Job& job, const Solve& solve)
{
    const StepSettings settings = sharedSettings(*job.m_body->m_model, job.m_settings);
    One one(job, settings);
    if (settings.m_threads)
        settings.m_threads->gather([&] { solve(one); });
    else
        solve(one);
    return one.report();
}

}  // namespace

StepSettings sharedSettings(const BodyModel& model, StepSettings settings)
{
    if (model.nodeCount() < kNodesToShare) settings.m_threads = nullptr;
    return settings;
}

void solveAlone(FreeMotion& motion)
{
    motion.m_report = solveWith<OneFreeMotion>(motion, [](OneFreeMotion& one) { solveFreeMotion(one); });
}

void solveAlone(ImpulseResponse& response)
{
    response.m_report = solveWith<OneResponse>(response, [](OneResponse& one) { respondToImpulses(one); });
}

void solveAlone(StepEnd& end)
{
    if (end.m_needsSmoothing) solveWith<OneSmoothing>(end, [](OneSmoothing& one) { findUnresolved(one); });
}

}  // namespace bullet_fem
