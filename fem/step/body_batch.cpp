// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/step/body_batch.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>
#include <optional>

#include "fem/elements/careful_average.h"
#include "fem/elements/model_elements.h"
#include "fem/factor/rest_factor.h"
#include "fem/step/batch_exchange.h"
#include "fem/step/batch_loan.h"
#include "fem/step/conjugate_gradients.h"
#include "fem/step/step_scratch.h"
#include "fem/step/step_stages.h"
#include "fem/step/warped_system.h"

namespace bullet_fem
{
namespace
{

bool isPlain(const Body& body, const StepSettings& settings)
{
    const std::vector<unsigned char>& fixed = body.m_state.m_fixed;
    return settings.m_batchMemory && settings.m_warp == Warp::nodal && isSinglePrecision(settings) &&
           !(body.m_loads.m_frameDamping > 0) && !std::memchr(fixed.data(), 1, fixed.size()) &&
           canBeBatched(*body.m_model);
}

/// Bodies in their columns of the arrays; the columns behind the last one have its values, too, and nothing comes of
/// them.
class BodyBatch
{
public:
    BodyBatch(BatchArrays& arrays, Body* const* bodies, int count, const StepSettings& settings)
        : m_arrays(arrays), m_count(count), m_settings(settings)
    {
        for (int b = 0; b < kBatchWidth; ++b) m_bodies[b] = bodies[std::min(b, count - 1)];
    }

    // Stages.
    void solve() { solveConjugateGradients(*this, m_stops, m_isGuessed, m_reports.data()); }
    void addIncrement();

    // The system of conjugate gradients.
    static constexpr int kBodies = kBatchWidth;
    int count() const { return m_count; }
    PerBatch rightSideSquares() const { return m_bSquares; }
    void startFromZero();
    GuessMeasure<kBatchWidth> measureGuess();
    GuessProducts<kBatchWidth> guessProducts() const { return m_guessProducts; }
    PerBatch scaleGuess(const PerBatch& scale, const PerBatch& isScaled);
    PerBatch trueResidual(const PerBatch& active);
    PerBatch precondition(bool isFirst);
    void turnDirection(const PerBatch& beta, const PerBatch& active);
    PerBatch applyToDirection() { return applyA(m_arrays.m_direction.get(), m_arrays.m_product.get()); }
    PerBatch advance(const PerBatch& step, const PerBatch& active);

protected:
    Body& body(int b) const { return *m_bodies[b]; }
    StepScratch& scratch(int b) const { return m_bodies[b]->m_workspace.scratch(); }
    int nodes() const { return m_arrays.nodeCount(); }

    /// Calls of(b), which tells an array of Real, for all lanes, and takes them to [value][body].
    template <class Real, class Of>
    void gather(const Of& of, Real* to, const BatchLayout& layout) const
    {
        Real* arrays[kBatchWidth];
        for (int b = 0; b < kBatchWidth; ++b) arrays[b] = const_cast<Real*>(of(b));
        gatherBatch(arrays, to, layout);
    }

    /// The way back; where of(b) is null, nothing goes.
    template <class Real, class Of>
    void scatter(const Of& of, const Real* from, const BatchLayout& layout) const
    {
        Real* arrays[kBatchWidth] = {};
        for (int b = 0; b < m_count; ++b) arrays[b] = of(b);
        if (std::any_of(arrays, arrays + m_count, [](const Real* array) { return array != nullptr; }))
            scatterBatch(arrays, from, layout);
    }

    BatchLayout warped() const { return {m_arrays.elementCount(), kWarpedRows}; }

    /// The same for vectors of all nodes: of(b) tells a std::vector<Vec3>.
    template <class Of>
    void gatherVectors(const Of& of, BodyVectors to) const
    {
        gather([&](int b) { return &of(b).front().x; }, to, {3 * nodes()});
    }
    template <class Of>
    void scatterVectors(const Of& of, BodyVectors from) const
    {
        scatter(
            [&](int b)
            {
                std::vector<Vec3>* vectors = of(b);
                return vectors ? &vectors->front().x : nullptr;
            },
            from, {3 * nodes()});
    }

    void gatherNodes();
    void gatherMomenta();
    void keepMomenta() const;
    void gatherWarped();
    void completeGuess();
    void keepResiduals(const std::array<bool, kBatchWidth>& wanted) const;

    BatchArrays& m_arrays;
    Body* m_bodies[kBatchWidth];
    int m_count;
    StepSettings m_settings;
    BatchMomenta m_momenta;
    PerBatch m_inertiaFactor;  // 1 + h alpha
    PerBatch m_bSquares;       // |b|^2
    bool m_isGuessed = true;   // false: dv is zero
    ConjugateGradientStop m_stops[kBatchWidth];
    std::array<SolveReport, kBatchWidth> m_reports;

private:
    void addStiffness(ConstBodyVectors p) const;
    PerBatch applyA(ConstBodyVectors p, BodyVectors Ap) const;
    BatchRecurrence recurrence(const PerBatch& active) const;

    GuessProducts<kBatchWidth> m_guessProducts;
    BodyVectors m_z = nullptr;
};

void BodyBatch::gatherNodes()
{
    gatherVectors([this](int b) -> const std::vector<Vec3>& { return body(b).m_state.m_x; }, m_arrays.m_x.get());
    gather([this](int b) { return body(b).m_state.m_mass.data(); }, m_arrays.m_mass.get(), {nodes()});
}

void BodyBatch::gatherMomenta()
{
    for (int b = 0; b < kBatchWidth; ++b)
    {
        const RigidMomentum::FreePiece piece = scratch(b).m_momentum.onlyPiece();
        m_momenta.m_mass[b] = piece.m_mass;
        for (int c = 0; c < 3; ++c)
        {
            m_momenta.m_center[c][b] = piece.m_center[c];
            m_momenta.m_linear[c][b] = piece.m_linear[c];
            m_momenta.m_angular[c][b] = piece.m_angular[c];
        }
        for (int k = 0; k < 9; ++k) m_momenta.m_inertia[k][b] = piece.m_inverseInertia(k / 3, k % 3);
    }
}

void BodyBatch::keepMomenta() const
{
    for (int b = 0; b < m_count; ++b)
    {
        RigidMomentum::FreePiece piece;
        piece.m_mass = m_momenta.m_mass[b];
        for (int c = 0; c < 3; ++c)
        {
            piece.m_center[c] = m_momenta.m_center[c][b];
            piece.m_linear[c] = m_momenta.m_linear[c][b];
            piece.m_angular[c] = m_momenta.m_angular[c][b];
        }
        for (int k = 0; k < 9; ++k) piece.m_inverseInertia(k / 3, k % 3) = m_momenta.m_inertia[k][b];
        scratch(b).m_momentum.setOnlyPiece(piece);
    }
}

void BodyBatch::gatherWarped()
{
    for (int b = 0; b < m_count; ++b) completeWarpedSystem(body(b), m_settings);
    gather([this](int b) { return scratch(b).m_elements.m_single.m_warped.front().rows(); }, m_arrays.m_warped.get(),
           warped());
    gather([this](int b) { return scratch(b).m_elements.m_nodeRotation.front().m; }, m_arrays.m_nodeRotation.get(),
           {9 * nodes()});
}

// Adds to the guess of dv the rigid motion that gives bodies the momentum prescribed.
void BodyBatch::completeGuess()
{
    completeIncrements(m_arrays.masses(), m_momenta, m_arrays.m_v.get(), m_arrays.m_increment.get());
}

// Of A p what elements add to the sums.
void BodyBatch::addStiffness(ConstBodyVectors p) const
{
    const double h = m_settings.m_step, beta = m_arrays.model().shape().m_material.m_stiffnessDamping;
    runElementProduct(m_arrays.elements(), h * h + h * beta, p);
}

// Returns p . A p.
PerBatch BodyBatch::applyA(ConstBodyVectors p, BodyVectors Ap) const
{
    addStiffness(p);
    return addInertia(m_arrays.inertia(), m_inertiaFactor, p, Ap);
}

BatchRecurrence BodyBatch::recurrence(const PerBatch& active) const
{
    return {nodes(),
            m_arrays.m_increment.get(),
            m_arrays.m_residual.get(),
            m_arrays.m_direction.get(),
            m_arrays.m_rightSide.get(),
            m_arrays.m_product.get(),
            active};
}

void BodyBatch::startFromZero()
{
    std::copy_n(m_arrays.m_rightSide.get(), static_cast<std::size_t>(3 * kBatchWidth) * nodes(),
                m_arrays.m_residual.get());
}

// Of bodies whose guess is zero, too.
GuessMeasure<kBatchWidth> BodyBatch::measureGuess()
{
    const double* x = m_arrays.m_increment.get();
    addStiffness(x);
    const BatchGuessMeasure measured = bullet_fem::measureGuess(
        m_arrays.inertia(), m_inertiaFactor, {x, m_arrays.m_rightSide.get(), m_arrays.m_product.get()});
    m_guessProducts = {measured.m_bx, measured.m_xAx};
    return {measured.m_xx, measured.m_residual};
}

// The residual is not there yet: of all bodies.
PerBatch BodyBatch::scaleGuess(const PerBatch& scale, const PerBatch&)
{
    PerBatch all;
    std::fill(std::begin(all.m), std::end(all.m), 1.0);
    return bullet_fem::scaleGuess(recurrence(all), scale);
}

PerBatch BodyBatch::trueResidual(const PerBatch& active)
{
    applyA(m_arrays.m_increment.get(), m_arrays.m_product.get());
    return subtractProduct(recurrence(active));
}

PerBatch BodyBatch::precondition(bool isFirst)
{
    const double* r = m_arrays.m_residual.get();
    const PerBatch scale = rotateIn(m_arrays.warp(), r);
    m_arrays.model().factor().lower().solveBatch(m_arrays.m_factorVector.get(), m_arrays.m_factorScratch.get());
    m_z = isFirst ? m_arrays.m_direction.get()  // later directions are made of z before A p takes its place
                  : m_arrays.m_product.get();
    return rotateOut(m_arrays.warp(), scale, r, m_z);
}

void BodyBatch::turnDirection(const PerBatch& beta, const PerBatch& active)
{
    bullet_fem::turnDirection(recurrence(active), m_z, beta);
}

PerBatch BodyBatch::advance(const PerBatch& step, const PerBatch& active)
{
    return advanceAlong(recurrence(active), step);
}

void BodyBatch::addIncrement()
{
    double *dv = m_arrays.m_increment.get(), *v = m_arrays.m_v.get();
    if (m_settings.m_momentumCorrection)
        addWithMomentum(m_arrays.masses(), m_momenta, dv, v);
    else
        addAndMeasure(dv, v, nodes());
    scatterVectors([this](int b) { return &scratch(b).m_velocity; }, v);
}

// What impulses have left undone; nothing after a breakdown.
void BodyBatch::keepResiduals(const std::array<bool, kBatchWidth>& wanted) const
{
    const auto keeps = [&](int b) { return wanted[b] && m_reports[b].m_stop != SolveStop::breakdown; };
    scatterVectors([&](int b) { return keeps(b) ? &scratch(b).m_residual : nullptr; }, m_arrays.m_residual.get());
    for (int b = 0; b < m_count; ++b) scratch(b).m_hasResidual = keeps(b);
}

class BatchedMotions : public BodyBatch
{
public:
    BatchedMotions(BatchArrays& arrays, Body* const* bodies, int count, FreeMotion* const* motions)
        : BodyBatch(arrays, bodies, count, motions[0]->m_settings), m_motions(motions)
    {
    }

    void readState()
    {
        gatherNodes();
        gatherVectors([this](int b) -> const std::vector<Vec3>& { return body(b).m_state.m_v; }, m_arrays.m_v.get());
        gatherVectors([this](int b) -> const std::vector<Vec3>& { return body(b).m_loads.m_force; },
                      m_arrays.m_rightSide.get());
        for (int b = 0; b < kBatchWidth; ++b)
        {
            m_alpha[b] = RigidMomentum::damping(body(b));
            m_inertiaFactor[b] = 1 + m_settings.m_step * m_alpha[b];
        }
    }

    // See RigidMomentum::prescribe().
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
                                motion(b).m_expected != nullptr);
            Mat3 inertia;
            for (int k = 0; k < 9; ++k) inertia(k / 3, k % 3) = m_momenta.m_inertia[k][b];
            const Vec3 center = {m_momenta.m_center[0][b], m_momenta.m_center[1][b], m_momenta.m_center[2][b]};
            inertia = RigidMomentum::inverseInertia(inertia, m_momenta.m_mass[b], center);
            for (int k = 0; k < 9; ++k) m_momenta.m_inertia[k][b] = inertia(k / 3, k % 3);
        }
    }

    // b = h (f_ext + f_el(x) - alpha M v - (h + beta) K' v), and A of this step.
    void passOverElements()
    {
        const double h = m_settings.m_step, beta = m_arrays.model().shape().m_material.m_stiffnessDamping;
        BatchElementPass pass = {
            m_arrays.m_x.get(), m_arrays.m_v.get(), h + beta, m_settings.m_tension ? h * h : 0, {}, {}, {}};
        for (int b = 0; b < kBatchWidth; ++b)
        {
            Quaternion* rotation = body(b).m_state.m_elementRotation.data();
            pass.m_rotationBefore[b] = rotation;
            if (b >= m_count) continue;
            pass.m_rotation[b] = rotation;
            ElementWork& work = scratch(b).m_elements;
            if (work.m_likelySteps > 0) pass.m_warped[b] = work.m_single.m_warped.data();
        }
        runElementPass(m_arrays.elements(), pass);
        m_bSquares = addForces(m_arrays.inertia(), m_alpha, h, m_arrays.m_v.get(), m_arrays.m_rightSide.get());
        for (int b = 0; b < m_count; ++b)  // what fills the last block is the last element again
        {
            std::vector<Quaternion>& rotation = body(b).m_state.m_elementRotation;
            const auto end = rotation.begin() + m_arrays.elementCount();
            std::fill(end, rotation.end(), *(end - 1));
        }
    }

    void averageRotations()
    {
        bullet_fem::averageRotations(m_arrays.nodeRotations());
        for (int i = 0; i < nodes(); ++i)
            for (int b = 0; m_arrays.m_doubtful[i] >> b != 0; ++b)
                if (b < m_count && (m_arrays.m_doubtful[i] >> b & 1) != 0) rotateCarefully(i, b);
        tellSystems();
    }

    void eliminateFixedNodes() {}  // there are none

    // That a body with predicted impulses goes on as it moves; of the others the increments of the last two steps,
    // continued along a straight line.
    void guessIncrement()
    {
        double *last = m_arrays.m_direction.get(), *before = m_arrays.m_product.get();
        const auto lastIncrement = [this](int b, int k) -> const std::vector<Vec3>&
        { return motion(b).m_expected ? m_arrays.m_zeros : body(b).m_state.m_lastIncrement[k]; };
        gatherVectors([&](int b) -> const std::vector<Vec3>& { return lastIncrement(b, 0); }, last);
        gatherVectors([&](int b) -> const std::vector<Vec3>& { return lastIncrement(b, 1); }, before);
        extrapolate(last, before, m_arrays.m_increment.get(), nodes());
        completeGuess();
    }

    void addPredictedImpulses()
    {
        if (!anyExpected()) return;
        double* impulses = m_arrays.m_direction.get();
        gatherVectors([this](int b) -> const std::vector<Vec3>&
                      { return motion(b).m_expected ? *motion(b).m_expected : m_arrays.m_zeros; },
                      impulses);
        m_bSquares = addAndMeasure(impulses, m_arrays.m_rightSide.get(), nodes());
        PerBatch share;
        for (int b = 0; b < kBatchWidth; ++b) share[b] = 1 / (1 + m_settings.m_step * m_alpha[b]);
        const PerBatch squares = addImpulses(m_arrays.masses(), impulses, share, m_momenta);
        for (int b = 0; b < kBatchWidth; ++b)
            if (motion(b).m_expected)
                m_stops[b].m_floor = std::max(m_stops[b].m_floor, motion(b).m_expectedFloor * std::sqrt(squares[b]));
    }

    // Increments with impulses in them say nothing about those without.
    void keepIncrement()
    {
        keepMomenta();
        std::array<bool, kBatchWidth> expected{};
        for (int b = 0; b < m_count; ++b)
        {
            expected[b] = m_motions[b]->m_expected != nullptr;
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
                           [](const FreeMotion* m) { return m->m_expected != nullptr; });
    }

    // What A and P need of every body alone, but for what assemble() has told.
    void tellSystems()
    {
        for (int b = 0; b < m_count; ++b)
        {
            ElementWork& work = scratch(b).m_elements;
            work.m_isDouble = false;
            work.m_isComplete = work.m_likelySteps > 0;
            if (!work.m_isComplete) continue;
            --work.m_likelySteps;
            scaleWarpedSystem(body(b), m_settings.m_step);
        }
        scatter([this](int b) { return scratch(b).m_elements.m_nodeRotation.front().m; }, m_arrays.m_nodeRotation.get(),
                {9 * nodes()});
    }

    void rotateCarefully(int node, int b)
    {
        const NodeRotations rotations = {&m_arrays.model().elements().m_nodes, body(b).m_state.m_elementRotation.data(),
                                         nullptr};
        const NodeRotation R = carefulAverage(rotations, node);
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

    void completeSystem()
    {
        gatherWarped();
        for (int b = 0; b < kBatchWidth; ++b)
            m_inertiaFactor[b] = 1 + m_settings.m_step * RigidMomentum::damping(body(b));
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
        m_bSquares = addAndMeasure(m_arrays.m_residual.get(), m_arrays.m_rightSide.get(), nodes());
    }

    // That the body ends with the velocities that it began the step with, or that nothing comes of the impulses.
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
        gatherVectors([this](int b) -> const std::vector<Vec3>& { return body(b).m_state.m_v; }, dv);
        subtract(dv, m_arrays.m_v.get(), dv, nodes());
        completeGuess();
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

// Calls solve(arrays, bodies) with arrays that are lent for it.
template <class Job, class Solve>
bool solveInArrays(Job* const* jobs, int count, const Solve& solve)
{
    if (count < kSmallestBatch) return false;
    const Body& first = *jobs[0]->m_body;
    std::optional<BatchLoan> loan;
    try
    {
        loan.emplace(*jobs[0]->m_settings.m_batchMemory, first.m_model);
    }
    catch (const std::bad_alloc&)
    {
        return false;
    }
    Body* bodies[kBatchWidth];
    for (int k = 0; k < count; ++k) bodies[k] = jobs[k]->m_body;
    solve(loan->arrays(), bodies);
    return true;
}

}  // namespace

bool canBeBatched(const FreeMotion& motion)
{
    return isPlain(*motion.m_body, motion.m_settings) && motion.m_body->m_loads.m_priorVelocity.empty();
}

bool canBeBatched(const ImpulseResponse& response)
{
    return isPlain(*response.m_body, response.m_settings) &&
           !response.m_body->m_workspace.scratch().m_elements.m_isDouble;
}

bool areAlike(const StepSettings& a, const StepSettings& b)
{
    return a.m_step == b.m_step && a.m_tension == b.m_tension && a.m_momentumCorrection == b.m_momentumCorrection &&
           a.m_batchMemory == b.m_batchMemory;
}

bool solveBatched(FreeMotion* const* motions, int count)
{
    return solveInArrays(motions, count,
                         [&](BatchArrays& arrays, Body* const* bodies)
                         {
                             BatchedMotions batch(arrays, bodies, count, motions);
                             solveFreeMotion(batch);
                         });
}

bool solveBatched(ImpulseResponse* const* responses, int count)
{
    return solveInArrays(responses, count,
                         [&](BatchArrays& arrays, Body* const* bodies)
                         {
                             BatchedResponses batch(arrays, bodies, count, responses);
                             respondToImpulses(batch);
                         });
}

}  // namespace bullet_fem
