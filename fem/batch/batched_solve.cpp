// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/batch/batched_solve.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <optional>

#include "fem/batch/batch_loan.h"
#include "fem/batch/body_batch.h"
#include "fem/elements/model_elements.h"
#include "fem/elements/robust_rotations.h"
#include "fem/solve/drift.h"
#include "fem/solve/smoothing.h"
#include "fem/solve/step_stages.h"
#include "fem/solve/warped_system.h"

namespace bullet_fem
{
namespace
{

class BatchedMotions : public BodyBatch
{
public:
    BatchedMotions(BatchArrays& arrays, Body* const* bodies, int count, FreeMotion* const* motions)
        : BodyBatch(arrays, bodies, count, motions[0]->m_settings), m_motions(motions)
    {
    }

    void readState()
    {
        for (int b = 0; b < m_count; ++b) beginDrift(body(b), m_settings);
        gatherNodes();
        gatherVectors([this](int b) -> const std::vector<Vec3>& { return scratch(b).m_kickVelocity; },
                      m_arrays.m_v.get());
        gatherVectors([this](int b) -> const std::vector<Vec3>& { return body(b).m_loads.m_force; },
                      m_arrays.m_rightSide.get());
        for (int b = 0; b < kBatchWidth; ++b)
        {
            m_alpha[b] = RigidMomentum::damping(body(b));
            m_inertiaFactor[b] = 1 + m_settings.m_step * m_alpha[b];
        }
    }

    // Prescribes the momenta of the loads, as RigidMomentum::prescribe().
    void prescribeMomentum()
    {
        BatchLoads loads = {m_arrays.m_v.get(), m_arrays.m_rightSide.get(), m_alpha, {}};
        sumMasses(m_arrays.masses(), m_momenta);
        for (int b = 0; b < kBatchWidth; ++b)
        {
            const double perMass = 1 / m_momenta.m_mass[b];
            for (PerBatch& component : m_momenta.m_center) component[b] *= perMass;
            loads.m_share[b] = m_settings.m_step / (1 + m_settings.m_step * m_alpha[b]);
        }
        const PerBatch squares = sumPrescribed(m_arrays.masses(), loads, m_momenta);
        for (int b = 0; b < kBatchWidth; ++b)
        {
            m_stops[b] = stopOf(motion(b).m_settings, kLoadFloor * (m_settings.m_step * std::sqrt(squares[b])),
                                motion(b).m_predicted != nullptr);
            Mat3 inertia;
            for (int k = 0; k < 9; ++k) inertia(k / 3, k % 3) = m_momenta.m_inertia[k][b];
            const Vec3 center = {m_momenta.m_center[0][b], m_momenta.m_center[1][b], m_momenta.m_center[2][b]};
            inertia = RigidMomentum::inverseInertia(inertia, m_momenta.m_mass[b], center);
            for (int k = 0; k < 9; ++k) m_momenta.m_inertia[k][b] = inertia(k / 3, k % 3);
        }
        keepMomenta();
        for (int b = 0; b < m_count; ++b) noteArcs(body(b), m_settings);
    }

    // As OneFreeMotion::makeRightSide().
    void passOverElements()
    {
        const double h = m_settings.m_step, beta = m_arrays.model().shape().m_material.m_stiffnessDamping;
        double *w = m_arrays.m_direction.get(), *elastic = m_arrays.m_product.get();
        std::copy_n(m_arrays.m_v.get(), static_cast<std::size_t>(3 * kBatchWidth) * nodes(), elastic);
        removeMotion(m_arrays.masses(), m_momenta, elastic, elastic);
        scaleVectors(m_coefficients.m_damping * h + beta, elastic, w, nodes());
        if (!scratch(0).m_isTurned)
            addInward(m_arrays.masses(), m_momenta, -m_coefficients.chordStrain(body(0), h, beta) * h, w);
        const double tension = m_settings.m_tension ? m_coefficients.stiffness() * h * h : 0;
        BatchElementPass pass = {m_arrays.m_x.get(), w, 1, tension, {}, {}, {}};
        for (int b = 0; b < kBatchWidth; ++b)
        {
            Quaternion* rotation = body(b).m_state.m_elementRotation.data();
            pass.m_rotationBefore[b] = rotation;
            if (b >= m_count) continue;
            pass.m_rotation[b] = rotation;
            ElementWork& work = scratch(b).m_elements;
            if (work.m_stepsReadyForImpulses > 0) pass.m_warped[b] = work.m_single.m_warped.data();
        }
        runElementPass(m_arrays.elements(), pass);
        double* right = m_arrays.m_rightSide.get();
        addForces(m_arrays.inertia(), m_alpha, h, m_arrays.m_v.get(), right);
        if (scratch(0).m_isTurned) addCentrifugal(m_arrays.masses(), m_momenta, h, right);
        for (int b = 0; b < m_count; ++b)  // padding of the last block repeats the last element
        {
            std::vector<Quaternion>& rotation = body(b).m_state.m_elementRotation;
            const auto end = rotation.begin() + m_arrays.elementCount();
            std::fill(end, rotation.end(), *(end - 1));
        }
        dampByTension();
    }

    // As OneFreeMotion::dampByTension(); areEqual() ensures equal step variation.
    void dampByTension()
    {
        const double r = scratch(0).m_stepVariation;
        if (!(r > 0) || !m_settings.m_tension) return;
        runElementProduct(m_arrays.elements(), 0, m_arrays.m_product.get());
        subtractSums(m_arrays.inertia(), r, m_arrays.m_rightSide.get());
    }

    void averageRotations()
    {
        bullet_fem::averageRotations(m_arrays.nodeRotations());
        for (int i = 0; i < nodes(); ++i)
            for (int b = 0; m_arrays.m_needsFallback[i] >> b != 0; ++b)
                if (b < m_count && (m_arrays.m_needsFallback[i] >> b & 1) != 0) rotateRobustly(i, b);
        tellSystems();
    }

    void eliminateFixedNodes() {}  // there are none

    // Warm start: zero increments for bodies with predicted impulses; for others the increments of the last two steps,
    // extrapolated linearly.
    void guessIncrement()
    {
        double *last = m_arrays.m_direction.get(), *before = m_arrays.m_product.get();
        const auto lastIncrement = [this](int b, int k) -> const std::vector<Vec3>&
        { return motion(b).m_predicted ? m_arrays.m_zeros : body(b).m_state.m_lastIncrement[k]; };
        gatherVectors([&](int b) -> const std::vector<Vec3>& { return lastIncrement(b, 0); }, last);
        gatherVectors([&](int b) -> const std::vector<Vec3>& { return lastIncrement(b, 1); }, before);
        double* dv = m_arrays.m_increment.get();
        extrapolate(last, before, dv, nodes());
        removeMotion(m_arrays.masses(), m_momenta, dv, dv);
    }

    void addPredictedImpulses()
    {
        if (!anyExpected()) return;
        double* impulses = m_arrays.m_direction.get();
        gatherVectors([this](int b) -> const std::vector<Vec3>&
                      { return motion(b).m_predicted ? *motion(b).m_predicted : m_arrays.m_zeros; },
                      impulses);
        addVectors(impulses, m_arrays.m_rightSide.get(), nodes());
        PerBatch share;
        for (int b = 0; b < kBatchWidth; ++b) share[b] = 1 / (1 + m_settings.m_step * m_alpha[b]);
        const PerBatch squares = addImpulses(m_arrays.masses(), impulses, share, m_momenta);
        for (int b = 0; b < kBatchWidth; ++b)
            if (motion(b).m_predicted)
                m_stops[b].m_floor = std::max(m_stops[b].m_floor, motion(b).m_predictedFloor * std::sqrt(squares[b]));
    }

    void correctIncrement() {}  // Hooke's law alone: canBeBatched()
    void keepIncrement()
    {
        keepMomenta();
        for (int b = 0; b < m_count; ++b) noteMeanVelocity(body(b), m_settings);
        std::array<bool, kBatchWidth> expected{};
        for (int b = 0; b < m_count; ++b)
        {
            expected[b] = m_motions[b]->m_predicted != nullptr;
            m_motions[b]->m_report = m_reports[b];
            std::array<std::vector<Vec3>, 2>& last = body(b).m_state.m_lastIncrement;
            if (!expected[b]) last[0].swap(last[1]);
        }
        scatterVectors([&](int b) { return expected[b] ? nullptr : &body(b).m_state.m_lastIncrement[0]; },
                       m_arrays.m_increment.get());
        keepResiduals(expected);
    }

private:
    const FreeMotion& motion(int b) const { return *m_motions[std::min(b, m_count - 1)]; }

    bool anyExpected() const
    {
        return std::any_of(m_motions, m_motions + m_count,
                           [](const FreeMotion* m) { return m->m_predicted != nullptr; });
    }

    // Updates the data of A and P of every body that passOverElements() has not written.
    void tellSystems()
    {
        for (int b = 0; b < m_count; ++b)
        {
            ElementWork& work = scratch(b).m_elements;
            work.m_isDouble = false;
            work.m_isComplete = work.m_stepsReadyForImpulses > 0;
            if (!work.m_isComplete) continue;
            --work.m_stepsReadyForImpulses;
            scaleWarpedSystem(body(b), m_settings);
        }
        scatter([this](int b) { return scratch(b).m_elements.m_nodeRotation.front().m; }, m_arrays.m_nodeRotation.get(),
                {9 * nodes()});
    }

    void rotateRobustly(int node, int b)
    {
        const NodeRotations rotations = {&m_arrays.model().elements().m_nodes, body(b).m_state.m_elementRotation.data(),
                                         nullptr};
        const NodeRotation R = robustAverage(rotations, node);
        for (int k = 0; k < 9; ++k)
            m_arrays.m_nodeRotation[(static_cast<std::size_t>(node) * 9 + k) * kBatchWidth + b] = R.m[k];
    }

    FreeMotion* const* m_motions;
    PerBatch m_alpha;
};

class BatchedResponses : public BodyBatch
{
public:
    BatchedResponses(BatchArrays& arrays, Body* const* bodies, int count, ImpulseResponse* const* responses)
        : BodyBatch(arrays, bodies, count, responses[0]->m_settings), m_responses(responses)
    {
    }

    void readImpulses()
    {
        gatherNodes();
        gatherMomenta();
        gatherVectors([this](int b) -> const std::vector<Vec3>& { return scratch(b).m_velocity; }, m_arrays.m_v.get());
        gatherVectors([this](int b) -> const std::vector<Vec3>& { return *response(b).m_impulses; },
                      m_arrays.m_rightSide.get());
        for (int b = 0; b < kBatchWidth; ++b)
            m_stops[b] = stopOf(response(b).m_settings, response(b).m_floor, response(b).m_steady);
    }

    void addMomentum()
    {
        PerBatch share;
        for (int b = 0; b < kBatchWidth; ++b) share[b] = 1 / m_inertiaFactor[b];
        addImpulses(m_arrays.masses(), m_arrays.m_rightSide.get(), share, m_momenta);
    }

    void addResidual()
    {
        gatherVectors([this](int b) -> const std::vector<Vec3>&
                      { return scratch(b).m_hasResidual ? scratch(b).m_residual : m_arrays.m_zeros; },
                      m_arrays.m_residual.get());
        addVectors(m_arrays.m_residual.get(), m_arrays.m_rightSide.get(), nodes());
    }

    // Initial guess: the return to the velocities at the start of the step, or zero.
    void guessResponse()
    {
        double* dv = m_arrays.m_increment.get();
        m_isGuessed =
            std::any_of(m_responses, m_responses + m_count, [](const ImpulseResponse* r) { return r->m_steady; });
        if (!m_isGuessed)
        {
            std::fill_n(dv, static_cast<std::size_t>(3 * kBatchWidth) * nodes(), 0.0);
            return;
        }
        gatherVectors([this](int b) -> const std::vector<Vec3>& { return scratch(b).m_kickVelocity; }, dv);
        subtract(dv, m_arrays.m_v.get(), dv, nodes());
        removeMotion(m_arrays.masses(), m_momenta, dv, dv);
        PerBatch keeps;
        for (int b = 0; b < kBatchWidth; ++b) keeps[b] = response(b).m_steady;
        clearOthers(keeps, dv, nodes());
    }

    void keepResidual()
    {
        keepMomenta();
        std::array<bool, kBatchWidth> all;
        all.fill(true);
        keepResiduals(all);
        for (int k = 0; k < m_count; ++k) m_responses[k]->m_report = m_reports[k];
    }

private:
    const ImpulseResponse& response(int b) const { return *m_responses[std::min(b, m_count - 1)]; }

    ImpulseResponse* const* m_responses;
};

class BatchedSmoothing : public BodyBatch
{
public:
    BatchedSmoothing(BatchArrays& arrays, Body* const* bodies, int count, StepEnd* const* ends)
        : BodyBatch(arrays, bodies, count, ends[0]->m_settings)
    {
        for (int b = 0; b < kBatchWidth; ++b)
            m_stops[b] = smoothingStop(body(b), ends[std::min(b, count - 1)]->m_settings);
    }

    void readChange()
    {
        gatherNodes();
        gatherMomenta();
        gatherVectors([this](int b) -> const std::vector<Vec3>& { return scratch(b).m_increment; },
                      m_arrays.m_increment.get());
    }

    void applyStiffness()
    {
        stiffnessOf(m_arrays.m_increment.get());
        m_isGuessed = false;
    }

    void keepUnresolved()
    {
        scatterVectors([this](int b) { return &scratch(b).m_increment; }, m_arrays.m_increment.get());
    }
};

// Calls solve(batch) with borrowed arrays.
template <class Batch, class Job, class Solve>
bool solveInArrays(Job* const* jobs, int count, const Solve& solve)
{
    if (count < kSmallestBatch) return false;
    std::optional<BatchLoan> loan;
    try
    {
        loan.emplace(*jobs[0]->m_settings.m_batchMemory, jobs[0]->m_body->m_model);
    }
    catch (const std::bad_alloc&)
    {
        return false;
    }
    Body* bodies[kBatchWidth];
    for (int k = 0; k < count; ++k) bodies[k] = jobs[k]->m_body;
    Batch batch(loan->arrays(), bodies, count, jobs);
    solve(batch);
    return true;
}

}  // namespace

bool solveBatched(FreeMotion* const* motions, int count)
{
    return solveInArrays<BatchedMotions>(motions, count, [](BatchedMotions& batch) { solveFreeMotion(batch); });
}

bool solveBatched(ImpulseResponse* const* responses, int count)
{
    return solveInArrays<BatchedResponses>(responses, count, [](BatchedResponses& batch) { respondToImpulses(batch); });
}

bool solveBatched(StepEnd* const* ends, int count)
{
    return solveInArrays<BatchedSmoothing>(ends, count, [](BatchedSmoothing& batch) { findUnresolved(batch); });
}

}  // namespace bullet_fem
