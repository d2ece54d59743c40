// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/batch/body_batch.h"

#include "fem/factor/rest_factor.h"
#include "fem/solve/warped_system.h"

namespace bullet_fem
{

void BodyBatch::gatherNodes()
{
    gatherVectors([this](int b) -> const std::vector<Vec3>& { return scratch(b).m_kickPosition; }, m_arrays.m_x.get());
    gather([this](int b) { return body(b).m_state.m_mass.data(); }, m_arrays.m_mass.get(), {nodes()});
}

void BodyBatch::gatherMomenta()
{
    for (int b = 0; b < kBatchWidth; ++b)
    {
        const RigidMomentum::FreeComponent piece = scratch(b).m_momentum.onlyComponent();
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
        RigidMomentum::FreeComponent piece;
        piece.m_mass = m_momenta.m_mass[b];
        for (int c = 0; c < 3; ++c)
        {
            piece.m_center[c] = m_momenta.m_center[c][b];
            piece.m_linear[c] = m_momenta.m_linear[c][b];
            piece.m_angular[c] = m_momenta.m_angular[c][b];
        }
        for (int k = 0; k < 9; ++k) piece.m_inverseInertia(k / 3, k % 3) = m_momenta.m_inertia[k][b];
        scratch(b).m_momentum.setOnlyComponent(piece, 1 / m_inertiaFactor[b]);
    }
}

void BodyBatch::completeSystem()
{
    for (int b = 0; b < m_count; ++b) completeWarpedSystem(body(b), m_settings);
    gather([this](int b) { return scratch(b).m_elements.m_single.m_warped.front().rows(); }, m_arrays.m_warped.get(),
           warped());
    gather([this](int b) { return scratch(b).m_elements.m_nodeRotation.front().m; }, m_arrays.m_nodeRotation.get(),
           {9 * nodes()});
    for (int b = 0; b < kBatchWidth; ++b) m_inertiaFactor[b] = 1 + m_settings.m_step * RigidMomentum::damping(body(b));
}

void BodyBatch::solve()
{
    double* b = m_arrays.m_rightSide.get();
    m_bSquares = removeImpulses(m_arrays.masses(), m_momenta, b, b);
    solveConjugateGradients(*this, m_stops, m_isGuessed, m_reports.data());
}

// Adds the elements' part of A p to the sums.
void BodyBatch::addStiffness(ConstBodyVectors p) const
{
    const double h = m_settings.m_step, beta = m_arrays.model().shape().m_material.m_stiffnessDamping;
    runElementProduct(m_arrays.elements(), h * (m_coefficients.stiffness() * h + beta), p);
}

// Computes b = (A - M) p, and sets p = 0.
void BodyBatch::stiffnessOf(BodyVectors p)
{
    const std::size_t size = static_cast<std::size_t>(3 * kBatchWidth) * nodes();
    PerBatch none;
    std::fill(std::begin(none.m), std::end(none.m), 0.0);
    addStiffness(p);
    addInertia(m_arrays.inertia(), none, p, m_arrays.m_rightSide.get());
    std::fill_n(p, size, 0.0);
}

// Computes Pi^T A p; returns its product with a vector.
PerBatch BodyBatch::applyA(ConstBodyVectors p, ConstBodyVectors with, BodyVectors Ap) const
{
    addStiffness(p);
    addInertia(m_arrays.inertia(), m_inertiaFactor, p, Ap);
    return removeImpulses(m_arrays.masses(), m_momenta, with, Ap);
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

// Includes bodies with a zero initial guess.
GuessMeasure<kBatchWidth> BodyBatch::measureGuess()
{
    const double* x = m_arrays.m_increment.get();
    applyA(x, x, m_arrays.m_product.get());
    const BatchGuessMeasure measured =
        bullet_fem::measureGuess({nodes(), x, m_arrays.m_rightSide.get(), m_arrays.m_product.get()});
    m_guessProducts = {measured.m_bx, measured.m_xAx};
    return {measured.m_xx, measured.m_residual};
}

// Updates all bodies, because measureGuess() does not store the residual.
PerBatch BodyBatch::scaleGuess(const PerBatch& scale, const PerBatch&)
{
    PerBatch all;
    std::fill(std::begin(all.m), std::end(all.m), 1.0);
    return bullet_fem::scaleGuess(recurrence(all), scale);
}

PerBatch BodyBatch::trueResidual(const PerBatch& active)
{
    applyA(m_arrays.m_increment.get(), m_arrays.m_increment.get(), m_arrays.m_product.get());
    return subtractProduct(recurrence(active));
}

PerBatch BodyBatch::precondition(bool isFirst)
{
    const double* r = m_arrays.m_residual.get();
    const RestModes& rest = m_arrays.model().restModes();
    const PerBatch scale = rotateIn(m_arrays.warp(), r);
    BatchMotions motions;
    removeRestImpulses(rest, m_arrays.m_factorVector.get(), motions);
    m_arrays.model().factor().lower().solveBatch(m_arrays.m_factorVector.get(), m_arrays.m_factorScratch.get());
    replaceRestMotions(rest, motions, m_arrays.m_factorVector.get());
    m_z = isFirst ? m_arrays.m_direction.get()  // first direction p = z; later z shares the memory of A p
                  : m_arrays.m_product.get();
    rotateOut(m_arrays.warp(), scale, m_z);
    return removeMotion(m_arrays.masses(), m_momenta, r, m_z);
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
    double* v = m_arrays.m_v.get();
    addWithMomentum(m_arrays.masses(), m_momenta, m_arrays.m_increment.get(), v);
    scatterVectors([this](int b) { return &scratch(b).m_velocity; }, v);
}

// Keeps the residuals of impulse responses, except after a breakdown.
void BodyBatch::keepResiduals(const std::array<bool, kBatchWidth>& wanted) const
{
    const auto keeps = [&](int b) { return wanted[b] && m_reports[b].m_stop != SolveStop::breakdown; };
    scatterVectors([&](int b) { return keeps(b) ? &scratch(b).m_residual : nullptr; }, m_arrays.m_residual.get());
    for (int b = 0; b < m_count; ++b) scratch(b).m_hasResidual = keeps(b);
}

}  // namespace bullet_fem
