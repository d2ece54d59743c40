// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/step/stepping.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bullet_fem/fem/common/threads.h"
#include "bullet_fem/fem/step/reactions.h"
#include "fem/batch/batched_solve.h"
#include "fem/body/inelastic_strain.h"
#include "fem/body/step_coefficients.h"
#include "fem/body/step_scratch.h"
#include "fem/solve/drift.h"
#include "fem/solve/smoothing.h"
#include "fem/solve/step_variation.h"
#include "fem/solve/strain_increment.h"
#include "fem/solve/warped_compliance.h"
#include "fem/solve/warped_system.h"
#include "fem/step/energy_limit.h"
#include "fem/step/one_body.h"

namespace bullet_fem
{
namespace
{

// Solves jobs on bodies of one model in batches as far as possible, those like the first before the others; the
// remaining ones are solved one by one.
template <class Job>
void solveAll(Job* jobs, int count)
{
    Job* together[kBatchWidth];  // the first `collected`
    for (int first = 0, end = 0; first < count; first = end)
    {
        int collected = 0;
        const auto solveCollected = [&]
        {
            if (!solveBatched(together, collected))
                for (int k = 0; k < collected; ++k) solveAlone(*together[k]);
            collected = 0;
        };
        const BodyModel* model = jobs[first].m_body->m_model.get();
        while (end < count && jobs[end].m_body->m_model.get() == model) ++end;
        for (const bool asFirst : {true, false})
        {
            for (int k = first; k < end; ++k)
            {
                if (areEqual(jobs[first], jobs[k]) != asFirst) continue;
                if (!canBeBatched(jobs[k]))
                {
                    solveAlone(jobs[k]);
                    continue;
                }
                if (collected == kBatchWidth || (collected > 0 && !areEqual(*together[0], jobs[k]))) solveCollected();
                together[collected++] = &jobs[k];
            }
            solveCollected();
        }
    }
}

Vec3 displace(Body& body, const std::vector<Vec3>& impulses, const StepSettings& settings)
{
    StepScratch& scratch = body.m_workspace.scratch();
    // Implicit Euler corrects a fraction of the penetration per step; other steps correct all of it.
    const double scale = StepCoefficients(settings, body).theta() < 1 ? scratch.m_complianceScale : 1;
    WarpedCompliance(body, scale, settings.m_threads).apply(impulses, scratch.m_increment);
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

void beginReactions(Body& body, double step)
{
    const SupportReactions::Step how = {step, RigidMomentum::damping(body), body.m_loads.m_frameDamping};
    body.m_workspace.scratch().m_reactions.begin(*body.m_model, body.m_state, how);
}

void beginImpulses(const FreeMotion& motion)
{
    std::vector<Vec3>& impulses = motion.m_body->m_workspace.scratch().m_impulses;
    motion.m_body->m_workspace.scratch().m_momentum.clearAngularImpulses();
    if (motion.m_predicted)
        impulses.assign(motion.m_predicted->begin(), motion.m_predicted->end());
    else
        std::fill(impulses.begin(), impulses.end(), Vec3());
}

// Reactions of actuators are computed now, because the program may remove these before it reads the reactions.
void noteReactions(Body& body, double share)
{
    StepScratch& scratch = body.m_workspace.scratch();
    SupportReactions& reactions = scratch.m_reactions;
    reactions.noteEnd(scratch.m_velocity, scratch.m_increment, share);
    if (!body.m_actuators.hasPulls()) return;
    std::vector<Vec3>& impulses = reactions.product();
    impulses.assign(scratch.m_velocity.size(), Vec3());
    scratch.m_actuation.addProduct(body.m_actuators, reactions.change(), impulses);
    scratch.m_actuation.addReleased(body.m_actuators, impulses);
    for (Vec3& impulse : impulses) impulse *= -1;
    reactions.add(impulses);
}

void stopPushing(StepScratch& scratch)
{
    std::fill(scratch.m_push.begin(), scratch.m_push.end(), Vec3());
    scratch.m_isPushed = false;
}

}  // namespace

// Positive root of h'^2 + h' beta = c h^2 + h beta.
double factorStep(double step, double numericalDamping, const Material& material)
{
    if (numericalDamping == 1) return step;
    const double half = 0.5 * material.m_stiffnessDamping;
    const double all = step * (StepCoefficients(numericalDamping).stiffness() * step + material.m_stiffnessDamping);
    return all / (half + std::sqrt(half * half + all));
}

void solveFreeMotions(FreeMotion* motions, int count)
{
    for (int k = 0; k < count; ++k)
    {
        noteStep(*motions[k].m_body, motions[k].m_settings.m_step);
        chooseDamping(*motions[k].m_body, motions[k].m_settings);
        chooseTurning(*motions[k].m_body, motions[k].m_settings.m_step);
        beginReactions(*motions[k].m_body, motions[k].m_settings.m_step);
        beginImpulses(motions[k]);
    }
    solveAll(motions, count);
}

void applyImpulses(ImpulseResponse* responses, int count)
{
    for (int k = 0; k < count; ++k)
    {
        std::vector<Vec3>& sum = responses[k].m_body->m_workspace.scratch().m_impulses;
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += (*responses[k].m_impulses)[i];
    }
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
    StepScratch& scratch = body.m_workspace.scratch();
    for (std::size_t i = 0; i < change.size(); ++i)
    {
        scratch.m_velocity[i] += change[i];
        if (body.m_state.m_fixed[i])
            body.m_loads.m_targetVelocity[i] += change[i];
        else
            scratch.m_impulses[i] += body.m_state.m_mass[i] * change[i];
    }
    scratch.m_reactions.changeVelocity(change);
}

Vec3 applyPositionCorrection(Body& body, const std::vector<Vec3>& impulses, const StepSettings& settings)
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
    StepEnd end;
    end.m_body = &body;
    end.m_settings = settings;
    finishSteps(&end, 1);
}

void finishSteps(StepEnd* ends, int count)
{
    for (int k = 0; k < count; ++k)
    {
        ends[k].m_needsSmoothing = findChange(*ends[k].m_body, ends[k].m_settings);
        StepScratch& scratch = ends[k].m_body->m_workspace.scratch();
        if (ends[k].m_needsSmoothing && scratch.m_reactions.isNoting())
            scratch.m_reactions.noteChange(scratch.m_increment);
    }
    solveAll(ends, count);
    for (int k = 0; k < count; ++k)
    {
        Body& body = *ends[k].m_body;
        StepScratch& scratch = body.m_workspace.scratch();
        const double smoothing = StepCoefficients(ends[k].m_settings, body).smoothing();
        double share = ends[k].m_needsSmoothing ? smoothing : 0;
        ends[k].m_isShortened = limitEnergy(body, ends[k].m_settings, share);
        if (scratch.m_reactions.isNoting()) noteReactions(body, ends[k].m_isShortened ? share : smoothing);
        endDrift(body, ends[k].m_settings, share);
        scratch.m_velocity = body.m_state.m_v;
        if (scratch.m_reactions.isNoting()) scratch.m_reactions.finish(body.m_state);
        if (scratch.m_isPushed) stopPushing(scratch);
        advanceInelasticStrain(body, sharedSettings(*body.m_model, ends[k].m_settings));
    }
}

bool canFinishStep(const Body& body)
{
    constexpr double kFastestNode = 1e6;
    const StepScratch& scratch = body.m_workspace.scratch();
    int good = 0;  // no early return, so that the loops vectorize
    for (const Vec3& v : scratch.m_velocity) good += dot(v, v) < kFastestNode * kFastestNode;
    for (std::size_t i = 0; i < scratch.m_push.size() && scratch.m_isPushed; ++i)
    {
        const Vec3 total = scratch.m_velocity[i] + scratch.m_push[i];
        good -= !(dot(total, total) < kFastestNode * kFastestNode);
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

const std::vector<Vec3>& freeMeanVelocity(const Body& body)
{
    return body.m_workspace.scratch().m_meanVelocity;
}

const std::vector<NodeReaction>* reactions(const Body& body)
{
    const StepScratch& scratch = body.m_workspace.scratch();
    SupportReactions& found = scratch.m_reactions;
    if (!found.isKnown(*body.m_model)) return nullptr;
    if (!found.isFound())
    {
        found.product().resize(found.change().size());
        WarpedSystem(body).applyUnconstrained(found.change(), found.product());
        found.find(scratch.m_elements.m_scaledMass, body.m_loads);
    }
    return &found.reactions();
}

}  // namespace bullet_fem
