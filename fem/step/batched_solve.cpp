// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/step/batched_solve.h"

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
#include "fem/step/increment_solve.h"
#include "fem/step/step_scratch.h"
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
           canBeSideBySide(*body.m_model);
}

/// Bodies in their lanes; the lanes behind the last one have its values, too, and nothing comes of them.
class SideBySide
{
public:
    SideBySide(BodyLanes& lanes, Body* const* bodies, int count, const StepSettings& settings)
        : m_lanes(lanes), m_count(count), m_settings(settings)
    {
        for (int b = 0; b < kBodyLanes; ++b) m_bodies[b] = bodies[std::min(b, count - 1)];
    }

protected:
    Body& body(int b) const { return *m_bodies[b]; }
    StepScratch& scratch(int b) const { return m_bodies[b]->m_workspace.scratch(); }
    int nodes() const { return m_lanes.nodeCount(); }

    /// Calls of(b), which tells an array of Real, for all lanes, and takes them to [value][body].
    template <class Real, class Of>
    void gather(const Of& of, Real* to, const LaneLayout& layout) const
    {
        Real* arrays[kBodyLanes];
        for (int b = 0; b < kBodyLanes; ++b) arrays[b] = const_cast<Real*>(of(b));
        gatherLanes(arrays, to, layout);
    }

    /// The way back; where of(b) is null, nothing goes.
    template <class Real, class Of>
    void scatter(const Of& of, const Real* from, const LaneLayout& layout) const
    {
        Real* arrays[kBodyLanes] = {};
        for (int b = 0; b < m_count; ++b) arrays[b] = of(b);
        if (std::any_of(arrays, arrays + m_count, [](const Real* array) { return array != nullptr; }))
            scatterLanes(arrays, from, layout);
    }

    LaneLayout warped() const { return {m_lanes.elementCount(), kWarpedRows}; }

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
    void completeIncrement();
    void solve(const PerLane& bSquares, bool isGuessed);
    void addIncrement();
    void keepResiduals(const std::array<bool, kBodyLanes>& wanted) const;

    BodyLanes& m_lanes;
    Body* m_bodies[kBodyLanes];
    int m_count;
    StepSettings m_settings;
    LanePieces m_pieces;
    PerLane m_inertiaFactor;  // 1 + h alpha
    std::array<IncrementGoal, kBodyLanes> m_goals;
    std::array<StepSettings, kBodyLanes> m_allSettings;
    std::array<SolveReport, kBodyLanes> m_reports;

private:
    void addStiffness(ConstBodyVectors p) const;
    PerLane applyA(ConstBodyVectors p, BodyVectors Ap) const;
    PerLane residualNorms(const PerLane& active);
    void measureTruly(ConjugateGradientCourse* courses);
    void startFromGuess(const PerLane& bNorms, ConjugateGradientCourse* courses);
    void start(const PerLane& bNorms, ConjugateGradientCourse* courses);
    void advance(ConjugateGradientCourse* courses, bool isFirst);
    LaneRecurrence recurrence(const PerLane& active) const;
};

void SideBySide::gatherNodes()
{
    gatherVectors([this](int b) -> const std::vector<Vec3>& { return body(b).m_state.m_x; }, m_lanes.m_x.get());
    gather([this](int b) { return body(b).m_state.m_mass.data(); }, m_lanes.m_mass.get(), {nodes()});
}

void SideBySide::gatherMomenta()
{
    for (int b = 0; b < kBodyLanes; ++b)
    {
        const RigidMomentum::FreePiece piece = scratch(b).m_momentum.onlyPiece();
        m_pieces.m_mass[b] = piece.m_mass;
        for (int c = 0; c < 3; ++c)
        {
            m_pieces.m_center[c][b] = piece.m_center[c];
            m_pieces.m_linear[c][b] = piece.m_linear[c];
            m_pieces.m_angular[c][b] = piece.m_angular[c];
        }
        for (int k = 0; k < 9; ++k) m_pieces.m_inertia[k][b] = piece.m_inverseInertia(k / 3, k % 3);
    }
}

void SideBySide::keepMomenta() const
{
    for (int b = 0; b < m_count; ++b)
    {
        RigidMomentum::FreePiece piece;
        piece.m_mass = m_pieces.m_mass[b];
        for (int c = 0; c < 3; ++c)
        {
            piece.m_center[c] = m_pieces.m_center[c][b];
            piece.m_linear[c] = m_pieces.m_linear[c][b];
            piece.m_angular[c] = m_pieces.m_angular[c][b];
        }
        for (int k = 0; k < 9; ++k) piece.m_inverseInertia(k / 3, k % 3) = m_pieces.m_inertia[k][b];
        scratch(b).m_momentum.setOnlyPiece(piece);
    }
}

void SideBySide::gatherWarped()
{
    for (int b = 0; b < m_count; ++b) completeWarpedSystem(body(b), m_settings);
    gather([this](int b) { return scratch(b).m_elements.m_single.m_warped.front().rows(); }, m_lanes.m_warped.get(),
           warped());
    gather([this](int b) { return scratch(b).m_elements.m_nodeRotation.front().m; }, m_lanes.m_nodeRotation.get(),
           {9 * nodes()});
}

// See completeIncrement() of a body.
void SideBySide::completeIncrement()
{
    completeIncrements(m_lanes.masses(), m_pieces, m_lanes.m_v.get(), m_lanes.m_increment.get());
}

// Of A p what elements add to the sums.
void SideBySide::addStiffness(ConstBodyVectors p) const
{
    const double h = m_settings.m_step, beta = m_lanes.model().shape().m_material.m_stiffnessDamping;
    multiplyLanes(m_lanes.elements(), h * h + h * beta, p);
}

// Returns p . A p.
PerLane SideBySide::applyA(ConstBodyVectors p, BodyVectors Ap) const
{
    addStiffness(p);
    return addInertia(m_lanes.inertia(), m_inertiaFactor, p, Ap);
}

LaneRecurrence SideBySide::recurrence(const PerLane& active) const
{
    return {nodes(),
            m_lanes.m_increment.get(),
            m_lanes.m_residual.get(),
            m_lanes.m_direction.get(),
            m_lanes.m_rightSide.get(),
            m_lanes.m_product.get(),
            active};
}

PerLane rootsOf(const PerLane& squares)
{
    PerLane roots;
    std::transform(squares.m, squares.m + kBodyLanes, roots.m, [](double square) { return std::sqrt(square); });
    return roots;
}

// r = b - A x of some bodies, and its norm.
PerLane SideBySide::residualNorms(const PerLane& active)
{
    applyA(m_lanes.m_increment.get(), m_lanes.m_product.get());
    return rootsOf(subtractProduct(recurrence(active)));
}

void SideBySide::measureTruly(ConjugateGradientCourse* courses)
{
    PerLane active;
    const auto any = [&active] { return std::any_of(active.m, active.m + kBodyLanes, [](double a) { return a > 0; }); };
    for (int b = 0; b < m_count; ++b) active[b] = courses[b].wantsTrueResidual();
    if (any())
    {
        const PerLane norms = residualNorms(active);
        for (int b = 0; b < m_count; ++b)
            if (active[b] > 0) courses[b].noteTrueResidual(norms[b]);
    }
    for (int b = 0; b < m_count; ++b) active[b] = courses[b].decide();
    if (!any()) return;
    const PerLane norms = residualNorms(active);
    for (int b = 0; b < m_count; ++b)
        if (active[b] > 0) courses[b].noteLastResidual(norms[b]);
}

// An iteration of those that are not over yet.
void SideBySide::advance(ConjugateGradientCourse* courses, bool isFirst)
{
    double *r = m_lanes.m_residual.get(), *p = m_lanes.m_direction.get(), *Ap = m_lanes.m_product.get();
    PerLane active, beta, step;
    for (int b = 0; b < m_count; ++b) active[b] = !courses[b].isOver();

    const PerLane scale = rotateIn(m_lanes.warp(), r);
    m_lanes.model().factor().lower().solveSide(m_lanes.m_factorVector.get(), m_lanes.m_factorScratch.get());
    double* const z = isFirst ? p : Ap;  // the first direction; later ones are made of it before A p takes its place
    const PerLane rz = rotateOut(m_lanes.warp(), scale, r, z);
    for (int b = 0; b < m_count; ++b) beta[b] = courses[b].beta(rz[b]);
    if (!isFirst) turnDirection(recurrence(active), z, beta);
    const PerLane pAp = applyA(p, Ap);
    for (int b = 0; b < m_count; ++b) active[b] = active[b] > 0 && courses[b].step(rz[b], pAp[b], step[b]);
    const PerLane norms = rootsOf(advanceAlong(recurrence(active), step));
    for (int b = 0; b < m_count; ++b)
        if (active[b] > 0) courses[b].noteStep(rz[b], norms[b]);
}

void SideBySide::start(const PerLane& bNorms, ConjugateGradientCourse* courses)
{
    for (int k = 0; k < m_count; ++k) courses[k] = {stopOf(m_allSettings[k], m_goals[k]), bNorms[k], true};
    std::copy_n(m_lanes.m_rightSide.get(), static_cast<std::size_t>(3 * kBodyLanes) * nodes(),
                m_lanes.m_residual.get());
}

// Guesses that are zero remain, those that are good enough, too, and of the others the best multiples are taken.
void SideBySide::startFromGuess(const PerLane& bNorms, ConjugateGradientCourse* courses)
{
    const double* x = m_lanes.m_increment.get();
    addStiffness(x);
    const LaneGuessMeasure measured =
        measureGuess(m_lanes.inertia(), m_inertiaFactor, {x, m_lanes.m_rightSide.get(), m_lanes.m_product.get()});
    const PerLane norms = rootsOf(measured.m_residual);
    PerLane scale, isScaled, all;
    for (int k = 0; k < m_count; ++k)
    {
        const bool isZero = !(measured.m_xx[k] > 0);
        all[k] = 1;
        courses[k] = {stopOf(m_allSettings[k], m_goals[k]), bNorms[k], isZero};
        isScaled[k] = !isZero && !courses[k].noteGuess(norms[k]);
        scale[k] = isScaled[k] > 0 ? optimalScale(measured.m_bx[k], measured.m_xAx[k]) : 1;
    }
    const PerLane scaledNorms = rootsOf(scaleGuess(recurrence(all), scale));
    for (int k = 0; k < m_count; ++k)
        if (isScaled[k] > 0) courses[k].noteScaledGuess(scaledNorms[k]);
}

// solveConjugateGradients() of the increments; unless they are guessed, they are zero.
void SideBySide::solve(const PerLane& bSquares, bool isGuessed)
{
    ConjugateGradientCourse courses[kBodyLanes];
    const PerLane bNorms = rootsOf(bSquares);
    if (isGuessed)
        startFromGuess(bNorms, courses);
    else
        start(bNorms, courses);
    measureTruly(courses);
    const auto allOver = [&]
    { return std::all_of(courses, courses + m_count, [](const auto& course) { return course.isOver(); }); };
    for (bool isFirst = true; !allOver(); isFirst = false)
    {
        advance(courses, isFirst);
        measureTruly(courses);
    }
    for (int k = 0; k < m_count; ++k) m_reports[k] = courses[k].report();
}

void SideBySide::addIncrement()
{
    double *dv = m_lanes.m_increment.get(), *v = m_lanes.m_v.get();
    if (m_settings.m_momentumCorrection)
        addWithMomentum(m_lanes.masses(), m_pieces, dv, v);
    else
        addLanes(dv, v, nodes());
    scatterVectors([this](int b) { return &scratch(b).m_velocity; }, v);
}

// What impulses have left undone; nothing after a breakdown.
void SideBySide::keepResiduals(const std::array<bool, kBodyLanes>& wanted) const
{
    const auto keeps = [&](int b) { return wanted[b] && m_reports[b].m_stop != SolveStop::breakdown; };
    scatterVectors([&](int b) { return keeps(b) ? &scratch(b).m_residual : nullptr; }, m_lanes.m_residual.get());
    for (int b = 0; b < m_count; ++b) scratch(b).m_hasResidual = keeps(b);
}

class SideBySideMotions : public SideBySide
{
public:
    SideBySideMotions(BodyLanes& lanes, Body* const* bodies, int count, FreeMotion* const* motions)
        : SideBySide(lanes, bodies, count, motions[0]->m_settings), m_motions(motions)
    {
    }

    void run()
    {
        gatherState();
        prescribe();
        assemble();
        rotateNodes();
        guess();
        solve(m_bSquares, true);
        addIncrement();
        keep();
    }

private:
    const FreeMotion& motion(int b) const { return *m_motions[std::min(b, m_count - 1)]; }

    void gatherState()
    {
        gatherNodes();
        gatherVectors([this](int b) -> const std::vector<Vec3>& { return body(b).m_state.m_v; }, m_lanes.m_v.get());
        gatherVectors([this](int b) -> const std::vector<Vec3>& { return body(b).m_loads.m_force; },
                      m_lanes.m_rightSide.get());
        for (int b = 0; b < kBodyLanes; ++b)
        {
            m_alpha[b] = RigidMomentum::damping(body(b));
            m_inertiaFactor[b] = 1 + m_settings.m_step * m_alpha[b];
            m_allSettings[b] = motion(b).m_settings;
        }
    }

    // See RigidMomentum::prescribe().
    void prescribe()
    {
        LaneLoads loads = {m_lanes.m_v.get(), m_lanes.m_rightSide.get(), m_alpha, {}};
        sumMasses(m_lanes.masses(), m_pieces);
        for (int b = 0; b < kBodyLanes; ++b)
        {
            const double perMass = 1 / m_pieces.m_mass[b];
            for (PerLane& component : m_pieces.m_center) component[b] *= perMass;
            loads.m_share[b] = m_settings.m_step / (1 + m_settings.m_step * m_alpha[b]);
        }
        const PerLane squares = sumPrescribed(m_lanes.masses(), loads, m_pieces);
        for (int b = 0; b < kBodyLanes; ++b)
        {
            m_goals[b] = {1e-3 * (m_settings.m_step * std::sqrt(squares[b])), motion(b).m_expected != nullptr};
            Mat3 inertia;
            for (int k = 0; k < 9; ++k) inertia(k / 3, k % 3) = m_pieces.m_inertia[k][b];
            const Vec3 center = {m_pieces.m_center[0][b], m_pieces.m_center[1][b], m_pieces.m_center[2][b]};
            inertia = RigidMomentum::inverseInertia(inertia, m_pieces.m_mass[b], center);
            for (int k = 0; k < 9; ++k) m_pieces.m_inertia[k][b] = inertia(k / 3, k % 3);
        }
    }

    // b = h (f_ext + f_el(x) - alpha M v - (h + beta) K' v), and A of this step.
    void assemble()
    {
        const double h = m_settings.m_step, beta = m_lanes.model().shape().m_material.m_stiffnessDamping;
        LanePass pass = {m_lanes.m_x.get(), m_lanes.m_v.get(), h + beta, m_settings.m_tension ? h * h : 0, {}, {}, {}};
        for (int b = 0; b < kBodyLanes; ++b)
        {
            Quaternion* rotation = body(b).m_state.m_elementRotation.data();
            pass.m_rotationBefore[b] = rotation;
            if (b >= m_count) continue;
            pass.m_rotation[b] = rotation;
            ElementWork& work = scratch(b).m_elements;
            if (work.m_likelySteps > 0) pass.m_warped[b] = work.m_single.m_warped.data();
        }
        passOverLanes(m_lanes.elements(), pass);
        m_bSquares = addForces(m_lanes.inertia(), m_alpha, h, m_lanes.m_v.get(), m_lanes.m_rightSide.get());
        for (int b = 0; b < m_count; ++b)  // what fills the last block is the last element again
        {
            std::vector<Quaternion>& rotation = body(b).m_state.m_elementRotation;
            const auto end = rotation.begin() + m_lanes.elementCount();
            std::fill(end, rotation.end(), *(end - 1));
        }
    }

    void rotateNodes()
    {
        averageLanes(m_lanes.nodeRotations());
        for (int i = 0; i < nodes(); ++i)
            for (int b = 0; m_lanes.m_doubtful[i] >> b != 0; ++b)
                if (b < m_count && (m_lanes.m_doubtful[i] >> b & 1) != 0) rotateCarefully(i, b);
        tellSystems();
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
        scatter([this](int b) { return scratch(b).m_elements.m_nodeRotation.front().m; }, m_lanes.m_nodeRotation.get(),
                {9 * nodes()});
    }

    void rotateCarefully(int node, int b)
    {
        const NodeRotations rotations = {&m_lanes.model().elements().m_nodes, body(b).m_state.m_elementRotation.data(),
                                         nullptr};
        const NodeRotation R = carefulAverage(rotations, node);
        for (int k = 0; k < 9; ++k)
            m_lanes.m_nodeRotation[(static_cast<std::size_t>(node) * 9 + k) * kBodyLanes + b] = R.m[k];
    }

    // What contact is expected to push goes with the loads, and the guess is that the body moves on; that of the others
    // is the increments of the last two steps, continued along a straight line.
    void guess()
    {
        addExpected();
        double *last = m_lanes.m_direction.get(), *before = m_lanes.m_product.get();
        const auto lastIncrement = [this](int b, int k) -> const std::vector<Vec3>&
        { return motion(b).m_expected ? m_lanes.m_zeros : body(b).m_state.m_lastIncrement[k]; };
        gatherVectors([&](int b) -> const std::vector<Vec3>& { return lastIncrement(b, 0); }, last);
        gatherVectors([&](int b) -> const std::vector<Vec3>& { return lastIncrement(b, 1); }, before);
        continueLanes(last, before, m_lanes.m_increment.get(), nodes());
        completeIncrement();
    }

    bool anyExpected() const
    {
        return std::any_of(m_motions, m_motions + m_count,
                           [](const FreeMotion* m) { return m->m_expected != nullptr; });
    }

    void addExpected()
    {
        if (!anyExpected()) return;
        double* impulses = m_lanes.m_direction.get();
        gatherVectors([this](int b) -> const std::vector<Vec3>&
                      { return motion(b).m_expected ? *motion(b).m_expected : m_lanes.m_zeros; },
                      impulses);
        m_bSquares = addLanes(impulses, m_lanes.m_rightSide.get(), nodes());
        PerLane share;
        for (int b = 0; b < kBodyLanes; ++b) share[b] = 1 / (1 + m_settings.m_step * m_alpha[b]);
        const PerLane squares = addImpulses(m_lanes.masses(), impulses, share, m_pieces);
        for (int b = 0; b < kBodyLanes; ++b)
            if (motion(b).m_expected)
                m_goals[b].m_floor = std::max(m_goals[b].m_floor, motion(b).m_expectedFloor * std::sqrt(squares[b]));
    }

    // Increments with impulses in them say nothing about those without.
    void keep()
    {
        keepMomenta();
        std::array<bool, kBodyLanes> expected{};
        for (int b = 0; b < m_count; ++b)
        {
            expected[b] = m_motions[b]->m_expected != nullptr;
            m_motions[b]->m_report = m_reports[b];
            std::array<std::vector<Vec3>, 2>& last = body(b).m_state.m_lastIncrement;
            if (!expected[b]) last[0].swap(last[1]);
        }
        scatterVectors([&](int b) { return expected[b] ? nullptr : &body(b).m_state.m_lastIncrement[0]; },
                       m_lanes.m_increment.get());
        keepResiduals(expected);
    }

    FreeMotion* const* m_motions;
    PerLane m_alpha, m_bSquares;
};

class SideBySideResponses : public SideBySide
{
public:
    SideBySideResponses(BodyLanes& lanes, Body* const* bodies, int count, ImpulseResponse* const* responses)
        : SideBySide(lanes, bodies, count, responses[0]->m_settings), m_responses(responses)
    {
    }

    void run()
    {
        gatherState();
        double *b = m_lanes.m_rightSide.get(), *left = m_lanes.m_residual.get();
        addImpulses(m_lanes.masses(), b, m_share, m_pieces);
        const PerLane bSquares = addLanes(left, b, nodes());
        for (int k = 0; k < kBodyLanes; ++k)
        {
            m_goals[k] = {response(k).m_floor, response(k).m_steady};
            m_allSettings[k] = response(k).m_settings;
        }
        solve(bSquares, guess());
        addIncrement();
        keepMomenta();
        std::array<bool, kBodyLanes> all;
        all.fill(true);
        keepResiduals(all);
        for (int k = 0; k < m_count; ++k) m_responses[k]->m_report = m_reports[k];
    }

private:
    const ImpulseResponse& response(int b) const { return *m_responses[std::min(b, m_count - 1)]; }

    void gatherState()
    {
        gatherNodes();
        gatherMomenta();
        gatherWarped();
        for (int b = 0; b < kBodyLanes; ++b)
        {
            const double hAlpha = m_settings.m_step * RigidMomentum::damping(body(b));
            m_inertiaFactor[b] = 1 + hAlpha;
            m_share[b] = 1 / (1 + hAlpha);
        }
        gatherVectors([this](int b) -> const std::vector<Vec3>& { return scratch(b).m_velocity; }, m_lanes.m_v.get());
        gatherVectors([this](int b) -> const std::vector<Vec3>& { return *response(b).m_impulses; },
                      m_lanes.m_rightSide.get());
        gatherVectors([this](int b) -> const std::vector<Vec3>&
                      { return scratch(b).m_hasResidual ? scratch(b).m_residual : m_lanes.m_zeros; },
                      m_lanes.m_residual.get());
    }

    // That the body ends with the velocities that it began the step with, or that nothing comes of the impulses: false
    // if that goes for all.
    bool guess()
    {
        double* dv = m_lanes.m_increment.get();
        const bool anySteady =
            std::any_of(m_responses, m_responses + m_count, [](const ImpulseResponse* r) { return r->m_steady; });
        if (!anySteady)
        {
            std::fill_n(dv, static_cast<std::size_t>(3 * kBodyLanes) * nodes(), 0.0);
            return false;
        }
        gatherVectors([this](int b) -> const std::vector<Vec3>& { return body(b).m_state.m_v; }, dv);
        subtractLanes(dv, m_lanes.m_v.get(), dv, nodes());
        completeIncrement();
        PerLane keeps;
        for (int b = 0; b < kBodyLanes; ++b) keeps[b] = response(b).m_steady;
        clearOthers(keeps, dv, nodes());
        return true;
    }

    ImpulseResponse* const* m_responses;
    PerLane m_share;
};

// Lends lanes and solves in them.
template <class Solve, class Job>
bool solveInLanes(Job* const* jobs, int count)
{
    if (count < kLeastSideBySide) return false;
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
    Body* bodies[kBodyLanes];
    for (int k = 0; k < count; ++k) bodies[k] = jobs[k]->m_body;
    Solve(loan->lanes(), bodies, count, jobs).run();
    return true;
}

}  // namespace

bool canBeSideBySide(const FreeMotion& motion)
{
    return isPlain(*motion.m_body, motion.m_settings) && motion.m_body->m_loads.m_priorVelocity.empty();
}

bool canBeSideBySide(const ImpulseResponse& response)
{
    return isPlain(*response.m_body, response.m_settings) &&
           !response.m_body->m_workspace.scratch().m_elements.m_isDouble;
}

bool areAlike(const StepSettings& a, const StepSettings& b)
{
    return a.m_step == b.m_step && a.m_tension == b.m_tension && a.m_momentumCorrection == b.m_momentumCorrection &&
           a.m_batchMemory == b.m_batchMemory;
}

bool solveSideBySide(FreeMotion* const* motions, int count)
{
    return solveInLanes<SideBySideMotions>(motions, count);
}

bool solveSideBySide(ImpulseResponse* const* responses, int count)
{
    return solveInLanes<SideBySideResponses>(responses, count);
}

}  // namespace bullet_fem
