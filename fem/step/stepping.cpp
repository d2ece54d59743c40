// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/step/stepping.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bullet_fem/fem/common/threads.h"
#include "fem/step/batched_solve.h"
#include "fem/step/increment_solve.h"
#include "fem/step/step_scratch.h"
#include "fem/step/warped_compliance.h"
#include "fem/step/warped_system.h"

namespace bullet_fem
{
namespace
{

// h |f_ext| over the free nodes: what b is measured against where it tends to zero.
double loadImpulseNorm(const Body& body, double h)
{
    double sum = 0;
    for (std::size_t i = 0; i < body.m_loads.m_force.size(); ++i)
        if (!body.m_state.m_fixed[i]) sum += dot(body.m_loads.m_force[i], body.m_loads.m_force[i]);
    return h * std::sqrt(sum);
}

// b = h (f_ext + f_el(x) - alpha M v - (h + beta) K' v), and A and P of this step.
void assembleForVelocity(Body& body, const StepSettings& settings, StepScratch& scratch)
{
    const BodyState& s = body.m_state;
    const double alpha = RigidMomentum::damping(body);
    std::vector<Vec3>& b = scratch.m_rightSide;
    for (std::size_t i = 0; i < b.size(); ++i) b[i] = body.m_loads.m_force[i] - alpha * s.m_mass[i] * s.m_v[i];
    const double frameDamping = body.m_loads.m_frameDamping;
    for (std::size_t i = 0; i < b.size() && frameDamping > 0; ++i)
        b[i] += frameDamping * s.m_mass[i] * (body.m_loads.m_frameVelocity[i] - s.m_v[i]);
    prepareWarpedSystem(body, settings, b);
    for (Vec3& bi : b) bi *= settings.m_step;
}

// T is in A but not in b: it damps the change of velocity in the step, and so must see what was changed from outside
// before it, u = v - v_prior. Else a node that is thrown again and again is held where it is by the tension that should
// pull it back. As impulses on the motion before, A (dv + u) = b(v_prior) + M u; without T that is A dv = b(v).
void assembleRightSide(Body& body, const StepSettings& settings, const WarpedSystem& A, StepScratch& scratch)
{
    BodyState& s = body.m_state;
    std::vector<Vec3>& prior = body.m_loads.m_priorVelocity;
    if (prior.empty()) return assembleForVelocity(body, settings, scratch);
    s.m_v.swap(prior);
    assembleForVelocity(body, settings, scratch);
    s.m_v.swap(prior);
    std::vector<Vec3>&u = scratch.m_increment, &b = scratch.m_rightSide, &Au = scratch.m_solver.m_Ap;
    for (std::size_t i = 0; i < u.size(); ++i) u[i] = s.m_fixed[i] ? Vec3() : s.m_v[i] - prior[i];
    A.applyUnconstrained(u, Au);
    for (std::size_t i = 0; i < b.size(); ++i) b[i] += s.m_mass[i] * u[i] - Au[i];
}

// Fixed nodes: dv_p = v_target - v moves to the right-hand side, b_f -= A_fp dv_p, and b_p = 0.
void eliminateFixedNodes(const Body& body, const WarpedSystem& A, StepScratch& scratch)
{
    const BodyState& s = body.m_state;
    std::vector<Vec3>&dv = scratch.m_increment, &b = scratch.m_rightSide, &Adv = scratch.m_solver.m_Ap;
    bool moving = false;
    for (std::size_t i = 0; i < dv.size(); ++i)
    {
        dv[i] = s.m_fixed[i] ? body.m_loads.m_targetVelocity[i] - s.m_v[i] : Vec3();
        moving = moving || dot(dv[i], dv[i]) > 0;
    }
    if (moving)
    {
        A.applyUnconstrained(dv, Adv);
        for (std::size_t i = 0; i < b.size(); ++i) b[i] -= Adv[i];
    }
    for (std::size_t i = 0; i < b.size(); ++i)
        if (s.m_fixed[i]) b[i] = {};
}

// The increments of the last two steps, continued along a straight line: motion is smooth more often than not.
void continueIncrements(const BodyState& state, std::vector<Vec3>& dv)
{
    const std::vector<Vec3>&last = state.m_lastIncrement[0], &before = state.m_lastIncrement[1];
    for (std::size_t i = 0; i < dv.size(); ++i) dv[i] = state.m_fixed[i] ? Vec3() : 2.0 * last[i] - before[i];
}

// What contact is expected to push, with the loads: nothing changes but the way that the body moves as one. Returns the
// norm of the impulses [N s].
double expectImpulses(Body& body, const std::vector<Vec3>& impulses, double step)
{
    StepScratch& scratch = body.m_workspace.scratch();
    const BodyState& s = body.m_state;
    double sum = 0;
    for (std::size_t i = 0; i < impulses.size(); ++i)
    {
        if (s.m_fixed[i]) continue;
        scratch.m_rightSide[i] += impulses[i];
        sum += dot(impulses[i], impulses[i]);
    }
    scratch.m_momentum.addImpulses(body, impulses, step);
    std::fill(scratch.m_increment.begin(), scratch.m_increment.end(), Vec3());
    return std::sqrt(sum);
}

// What impulses have left undone. After a breakdown that may not be finite.
void keepResidual(Body& body, const SolveReport& report)
{
    StepScratch& scratch = body.m_workspace.scratch();
    scratch.m_hasResidual = report.m_stop != SolveStop::breakdown;
    if (scratch.m_hasResidual) scratch.m_residual = scratch.m_solver.m_r;
}

// Increments with impulses in them say nothing about those without.
void keepFreeMotion(const FreeMotion& motion)
{
    Body& body = *motion.m_body;
    StepScratch& scratch = body.m_workspace.scratch();
    if (motion.m_expected) return keepResidual(body, motion.m_report);
    std::swap(body.m_state.m_lastIncrement[0], body.m_state.m_lastIncrement[1]);
    body.m_state.m_lastIncrement[0] = scratch.m_increment;
    scratch.m_hasResidual = false;
}

void solveAlone(FreeMotion& motion, const StepSettings& settings)
{
    Body& body = *motion.m_body;
    StepScratch& scratch = body.m_workspace.scratch();
    const WarpedSystem A(body, settings.m_threads);

    assembleRightSide(body, settings, A, scratch);
    eliminateFixedNodes(body, A, scratch);
    scratch.m_momentum.prescribe(body, settings.m_step);
    for (std::size_t i = 0; i < scratch.m_velocity.size(); ++i)
        scratch.m_velocity[i] = body.m_state.m_fixed[i] ? body.m_loads.m_targetVelocity[i] : body.m_state.m_v[i];
    IncrementGoal goal = {1e-3 * loadImpulseNorm(body, settings.m_step), motion.m_expected != nullptr};
    if (motion.m_expected)
        goal.m_floor =
            std::max(goal.m_floor, motion.m_expectedFloor * expectImpulses(body, *motion.m_expected, settings.m_step));
    else
        continueIncrements(body.m_state, scratch.m_increment);
    completeIncrement(body);
    motion.m_report = solveIncrement(body, settings, goal);
    scratch.m_momentum.keepHung(body, scratch.m_velocity);
    keepFreeMotion(motion);
}

void solveAlone(ImpulseResponse& response, const StepSettings& settings)
{
    Body& body = *response.m_body;
    StepScratch& scratch = body.m_workspace.scratch();
    const BodyState& s = body.m_state;
    const std::vector<Vec3>& impulses = *response.m_impulses;
    completeWarpedSystem(body, settings);
    std::vector<Vec3>&b = scratch.m_rightSide, &dv = scratch.m_increment;
    for (std::size_t i = 0; i < b.size(); ++i) b[i] = s.m_fixed[i] ? Vec3() : impulses[i];
    scratch.m_momentum.addImpulses(body, b, settings.m_step);
    for (std::size_t i = 0; i < b.size() && scratch.m_hasResidual; ++i) b[i] += scratch.m_residual[i];
    if (response.m_steady)
    {
        for (std::size_t i = 0; i < dv.size(); ++i) dv[i] = s.m_fixed[i] ? Vec3() : s.m_v[i] - scratch.m_velocity[i];
        completeIncrement(body);
    }
    else
        std::fill(dv.begin(), dv.end(), Vec3());
    response.m_report = solveIncrement(body, settings, {response.m_floor, response.m_steady});
    keepResidual(body, response.m_report);
}

// On the threads at hand, or without them where the body is too small.
template <class Job>
void solveAlone(Job& job)
{
    const StepSettings settings = sharedSettings(*job.m_body->m_model, job.m_settings);
    if (settings.m_threads)
        settings.m_threads->gather([&] { solveAlone(job, settings); });
    else
        solveAlone(job, settings);
}

// Runs of jobs on bodies that share their model go side by side as far as they can, the others one by one.
template <class Job>
void solveAll(Job* jobs, int count)
{
    Job* together[kBodyLanes];  // the first `collected`
    for (int first = 0, end = 0; first < count; first = end)
    {
        int collected = 0;
        const auto solveCollected = [&]
        {
            if (!solveSideBySide(together, collected))
                for (int k = 0; k < collected; ++k) solveAlone(*together[k]);
            collected = 0;
        };
        const BodyModel* model = jobs[first].m_body->m_model.get();
        for (; end < count && jobs[end].m_body->m_model.get() == model; ++end)
        {
            if (!canBeSideBySide(jobs[end]))
            {
                solveAlone(jobs[end]);
                continue;
            }
            if (collected == kBodyLanes || (collected > 0 && !areAlike(together[0]->m_settings, jobs[end].m_settings)))
                solveCollected();
            together[collected++] = &jobs[end];
        }
        solveCollected();
    }
}

Vec3 displace(Body& body, const std::vector<Vec3>& impulses, const StepSettings& settings)
{
    StepScratch& scratch = body.m_workspace.scratch();
    WarpedCompliance(body, settings.m_threads).apply(impulses, scratch.m_increment);
    scratch.m_isPushed = true;
    Vec3 angularMomentum;
    for (std::size_t i = 0; i < scratch.m_push.size(); ++i)
    {
        scratch.m_push[i] += scratch.m_increment[i];
        angularMomentum +=
            cross(settings.m_step * scratch.m_increment[i], body.m_state.m_mass[i] * scratch.m_velocity[i]);
    }
    return angularMomentum;
}

void stopPushing(StepScratch& scratch)
{
    std::fill(scratch.m_push.begin(), scratch.m_push.end(), Vec3());
    scratch.m_isPushed = false;
}

}  // namespace

void solveFreeMotions(FreeMotion* motions, int count)
{
    solveAll(motions, count);
}

void applyImpulses(ImpulseResponse* responses, int count)
{
    solveAll(responses, count);
}

SolveReport solveFreeMotion(Body& body, const StepSettings& settings)
{
    FreeMotion motion;
    motion.m_body = &body;
    motion.m_settings = settings;
    solveFreeMotions(&motion, 1);
    return motion.m_report;
}

SolveReport applyImpulses(Body& body, const std::vector<Vec3>& impulses, const StepSettings& settings, double floor)
{
    ImpulseResponse response{&body, &impulses, settings, floor, false, {}};
    applyImpulses(&response, 1);
    return response.m_report;
}

void addVelocity(Body& body, const std::vector<Vec3>& change)
{
    std::vector<Vec3>& v = body.m_workspace.scratch().m_velocity;
    for (std::size_t i = 0; i < v.size(); ++i)
        if (!body.m_state.m_fixed[i]) v[i] += change[i];
}

Vec3 applyPush(Body& body, const std::vector<Vec3>& impulses, const StepSettings& settings)
{
    const StepSettings shared = sharedSettings(*body.m_model, settings);
    Vec3 angularMomentum;
    const auto push = [&] { angularMomentum = displace(body, impulses, shared); };
    if (shared.m_threads)
        shared.m_threads->gather(push);
    else
        push();
    return angularMomentum;
}

void finishStep(Body& body, const StepSettings& settings)
{
    StepScratch& scratch = body.m_workspace.scratch();
    BodyState& s = body.m_state;
    s.m_v = scratch.m_velocity;
    for (std::size_t i = 0; i < s.m_x.size(); ++i) s.m_x[i] += settings.m_step * s.m_v[i];
    if (!scratch.m_isPushed) return;
    for (std::size_t i = 0; i < s.m_x.size(); ++i) s.m_x[i] += settings.m_step * scratch.m_push[i];
    stopPushing(scratch);
}

bool canFinishStep(const Body& body)
{
    constexpr double kFastest = 1e6;
    const StepScratch& scratch = body.m_workspace.scratch();
    int good = 0;  // no early return: the loops are for vectors
    for (const Vec3& v : scratch.m_velocity) good += dot(v, v) < kFastest * kFastest;
    for (std::size_t i = 0; i < scratch.m_push.size() && scratch.m_isPushed; ++i)
    {
        const Vec3 total = scratch.m_velocity[i] + scratch.m_push[i];
        good -= !(dot(total, total) < kFastest * kFastest);
    }
    return good == static_cast<int>(scratch.m_velocity.size());
}

void abandonStep(Body& body)
{
    StepScratch& scratch = body.m_workspace.scratch();
    std::fill(body.m_state.m_v.begin(), body.m_state.m_v.end(), Vec3());
    stopPushing(scratch);
}

SolveReport step(Body& body, const StepSettings& settings)
{
    const SolveReport report = solveFreeMotion(body, settings);
    finishStep(body, settings);
    return report;
}

const std::vector<Vec3>& velocity(const Body& body)
{
    return body.m_workspace.scratch().m_velocity;
}

}  // namespace bullet_fem
