// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/solve/drift.h"

#include <algorithm>

#include "fem/body/step_coefficients.h"
#include "fem/body/step_scratch.h"
#include "fem/solve/warped_compliance.h"

namespace bullet_fem
{

namespace
{

// Turn in a step from which on held bodies turn along arcs [rad]. Chords would stretch them by more than a tenth, and
// give them the energy of that (SpinningBodies, AnchoredBlade). From .25 on balls roll too slowly (Rolling).
constexpr double kFarTurn = 0.5;

// Splits an external change of velocities, which acts as impulses: its rigid part is in `velocity` at once, and the
// rest in m_strained.
void takeOutsideChange(Body& body, double step, std::vector<Vec3>& velocity)
{
    const BodyState& s = body.m_state;
    StepScratch& scratch = body.m_workspace.scratch();
    const std::vector<Vec3>& prior = body.m_loads.m_priorVelocity;
    std::vector<Vec3>& change = scratch.m_strained;
    for (std::size_t i = 0; i < change.size(); ++i) change[i] = s.m_fixed[i] ? Vec3() : s.m_v[i] - prior[i];
    scratch.m_momentum.removeMomentum(body, step, s.m_x, change);
    for (std::size_t i = 0; i < change.size(); ++i) velocity[i] -= change[i];
}

// Gives fixed nodes the velocities of free ones that move with them: targets are mean velocities, to which a step with
// theta < 1 adds 1 - theta times their change at its ends. They move to y with m_drift, and on to the targets.
void leadFixedNodes(Body& body, double first)
{
    const BodyState& s = body.m_state;
    StepScratch& scratch = body.m_workspace.scratch();
    const std::vector<int>& componentOf = body.m_model->mesh().nodeComponent();
    for (std::size_t i = 0; i < s.m_fixed.size(); ++i)
    {
        if (!s.m_fixed[i] || scratch.m_momentum.isMovable(componentOf[i])) continue;
        const Vec3 change = body.m_loads.m_targetVelocity[i] - s.m_v[i];
        scratch.m_kickVelocity[i] += first * change;
        scratch.m_velocity[i] += first * change;
        scratch.m_drift[i] -= (1 - first) * change;
    }
}

// Positions along chords.
void moveOn(double time, const std::vector<Vec3>& x, const std::vector<Vec3>& v, std::vector<Vec3>& end)
{
    for (std::size_t i = 0; i < x.size(); ++i) end[i] = x[i] + time * v[i];
}

}  // namespace

// The spin of a body whose nodes are about as fast as the first one needs no measure.
void chooseTurning(Body& body, double step)
{
    StepScratch& scratch = body.m_workspace.scratch();
    scratch.m_isTurned = !body.m_loads.m_isHeld;
    const std::vector<Vec3>& v = body.m_state.m_v;
    const double slow = kFarTurn * body.m_model->mesh().shortestHeight() / step;
    const auto isSlow = [&](const Vec3& vi) { return norm(vi - v.front()) < slow; };
    if (scratch.m_isTurned || std::all_of(v.begin(), v.end(), isSlow)) return;
    scratch.m_momentum.measure(body, step, body.m_state.m_x, body.m_state.m_v);
    scratch.m_isTurned = step * scratch.m_momentum.fastestSpin() > kFarTurn;
}

void beginDrift(Body& body, const StepSettings& settings)
{
    StepScratch& scratch = body.m_workspace.scratch();
    const BodyState& s = body.m_state;
    const double first = 1 - StepCoefficients(settings, body).theta();
    std::vector<Vec3>&y = scratch.m_kickPosition, &v = scratch.m_kickVelocity, &moving = scratch.m_drift;
    v = s.m_v;
    scratch.m_isStrained = !body.m_loads.m_priorVelocity.empty();
    if (scratch.m_isStrained) takeOutsideChange(body, settings.m_step, v);
    scratch.m_isJoined = false;
    scratch.m_led.find(body.m_model->mesh(), s, body.m_loads, settings.m_step);
    std::vector<Vec3>& end = scratch.m_velocity;
    for (std::size_t i = 0; i < v.size(); ++i) end[i] = s.m_fixed[i] ? body.m_loads.m_targetVelocity[i] : v[i];
    if (!(first > 0))
    {
        y = s.m_x;
        return;
    }
    moving = end;
    scratch.m_momentum.measure(body, settings.m_step, s.m_x, moving);
    leadFixedNodes(body, first);
    if (!scratch.m_isTurned)
        moveOn(first * settings.m_step, s.m_x, moving, y);
    else
    {
        scratch.m_momentum.advance(body, first * settings.m_step, {s.m_x, moving, v}, y, &v);
        if (scratch.m_isStrained) scratch.m_momentum.turnElastic(body, scratch.m_strained);
    }
    for (std::size_t i = 0; i < v.size(); ++i)
        if (!s.m_fixed[i]) end[i] = v[i];
}

void removeRigidVelocity(const Body& body, std::vector<Vec3>& velocity)
{
    const StepScratch& scratch = body.m_workspace.scratch();
    scratch.m_momentum.removeRigidVelocity(body, velocity);
    if (!scratch.m_led.turns()) return;
    const std::vector<int>& componentOf = body.m_model->mesh().nodeComponent();
    for (std::size_t i = 0; i < velocity.size(); ++i)
        velocity[i] -= scratch.m_led.velocityAt(componentOf[i], scratch.m_kickPosition[i]);
}

void addInward(const Body& body, double factor, std::vector<Vec3>& change)
{
    const StepScratch& scratch = body.m_workspace.scratch();
    if (!scratch.m_isTurned) scratch.m_momentum.addInward(body, factor, change);
    if (!scratch.m_led.turns()) return;
    const std::vector<int>& componentOf = body.m_model->mesh().nodeComponent();
    for (std::size_t i = 0; i < change.size(); ++i)
        change[i] += factor * scratch.m_led.inwardAt(componentOf[i], scratch.m_kickPosition[i]);
}

void driftByOutsideChange(Body& body, const StepSettings& settings)
{
    StepScratch& scratch = body.m_workspace.scratch();
    const double first = 1 - StepCoefficients(settings, body).theta();
    if (!scratch.m_isStrained || !(first > 0)) return;
    std::vector<Vec3>& impulses = scratch.m_strained;
    for (std::size_t i = 0; i < impulses.size(); ++i) impulses[i] *= first * body.m_state.m_mass[i];
    WarpedCompliance(body, scratch.m_complianceScale, settings.m_threads).apply(impulses, scratch.m_increment);
    for (std::size_t i = 0; i < impulses.size(); ++i)
    {
        scratch.m_push[i] = scratch.m_increment[i];
        scratch.m_drift[i] += scratch.m_push[i];
    }
    scratch.m_isPushed = true;
}

void noteArcs(Body& body, const StepSettings& settings)
{
    StepScratch& scratch = body.m_workspace.scratch();
    const double theta = StepCoefficients(settings, body).theta(), perStep = 1 / settings.m_step;
    const std::vector<Vec3>& v = scratch.m_kickVelocity;
    std::vector<Vec3>& drift = scratch.m_drift;
    if (scratch.m_isTurned)
        scratch.m_momentum.advance(body, theta * settings.m_step, {scratch.m_kickPosition, v, v}, drift, nullptr);
    else
        moveOn(theta * settings.m_step, scratch.m_kickPosition, v, drift);
    for (std::size_t i = 0; i < drift.size(); ++i) drift[i] = perStep * (drift[i] - body.m_state.m_x[i]) - theta * v[i];
}

void noteMeanVelocity(Body& body, const StepSettings& settings)
{
    StepScratch& scratch = body.m_workspace.scratch();
    const double theta = StepCoefficients(settings, body).theta();
    for (std::size_t i = 0; i < scratch.m_drift.size(); ++i)
        scratch.m_meanVelocity[i] = scratch.m_drift[i] + theta * scratch.m_velocity[i];
}

void endDrift(Body& body, const StepSettings& settings, double share)
{
    StepScratch& scratch = body.m_workspace.scratch();
    const double h = settings.m_step, second = h * StepCoefficients(settings, body).theta();
    std::vector<Vec3>&x = body.m_state.m_x, &end = scratch.m_drift, &unresolved = scratch.m_increment;
    const auto push = [&]
    {
        for (std::size_t i = 0; i < x.size() && scratch.m_isPushed; ++i) x[i] += h * scratch.m_push[i];
    };
    if (!scratch.m_isTurned)
    {
        moveOn(second, scratch.m_kickPosition, scratch.m_velocity, x);
        push();  // before, as the position correction pays back the angular momentum of its displacement times v*
        if (share > 0) scratch.m_momentum.removeMomentum(body, h, x, unresolved);
    }
    end = scratch.m_velocity;
    for (std::size_t i = 0; i < end.size() && share > 0; ++i) end[i] -= share * unresolved[i];
    for (std::size_t i = 0; i < end.size(); ++i)
        if (body.m_state.m_fixed[i]) end[i] = body.m_loads.m_targetVelocity[i];
    if (!scratch.m_isTurned)
    {
        body.m_state.m_v = end;
        return;
    }
    scratch.m_momentum.advance(body, second, {scratch.m_kickPosition, scratch.m_velocity, end}, x, &body.m_state.m_v);
    push();
}

}  // namespace bullet_fem
