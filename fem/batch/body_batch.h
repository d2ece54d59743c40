// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>
#include <array>

#include "bullet_fem/fem/body/body.h"
#include "fem/batch/batch_arrays.h"
#include "fem/batch/batch_exchange.h"
#include "fem/body/conjugate_gradients.h"
#include "fem/body/step_coefficients.h"
#include "fem/body/step_scratch.h"

namespace bullet_fem
{

/// Bodies in the columns of the batch arrays. Unused columns repeat the last body; their results are discarded.
class BodyBatch
{
public:
    BodyBatch(BatchArrays& arrays, Body* const* bodies, int count, const StepSettings& settings)
        : m_arrays(arrays), m_count(count), m_settings(settings), m_coefficients(settings, *bodies[0])
    {
        for (int b = 0; b < kBatchWidth; ++b) m_bodies[b] = bodies[std::min(b, count - 1)];
    }

    // Stages of the step.
    void solve();
    void addIncrement();
    void completeSystem();

    // Interface of solveConjugateGradients().
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
    PerBatch applyToDirection()
    {
        return applyA(m_arrays.m_direction.get(), m_arrays.m_direction.get(), m_arrays.m_product.get());
    }
    PerBatch advance(const PerBatch& step, const PerBatch& active);

protected:
    Body& body(int b) const { return *m_bodies[b]; }
    StepScratch& scratch(int b) const { return m_bodies[b]->m_workspace.scratch(); }
    int nodes() const { return m_arrays.nodeCount(); }

    /// Copies of(b), the body's array of Real, for all lanes to [value][body].
    template <class Real, class Of>
    void gather(const Of& of, Real* to, const BatchLayout& layout) const
    {
        Real* arrays[kBatchWidth];
        for (int b = 0; b < kBatchWidth; ++b) arrays[b] = const_cast<Real*>(of(b));
        gatherBatch(arrays, to, layout);
    }

    /// Copies lanes back to the bodies' arrays; skips those for which of(b) is null.
    template <class Real, class Of>
    void scatter(const Of& of, const Real* from, const BatchLayout& layout) const
    {
        Real* arrays[kBatchWidth] = {};
        for (int b = 0; b < m_count; ++b) arrays[b] = of(b);
        if (std::any_of(arrays, arrays + m_count, [](const Real* array) { return array != nullptr; }))
            scatterBatch(arrays, from, layout);
    }

    BatchLayout warped() const { return {m_arrays.elementCount(), kWarpedRows}; }

    /// gather() and scatter() for one vector a node: of(b) returns a std::vector<Vec3>.
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
    void stiffnessOf(BodyVectors p);
    void keepResiduals(const std::array<bool, kBatchWidth>& wanted) const;

    BatchArrays& m_arrays;
    Body* m_bodies[kBatchWidth];
    int m_count;
    StepSettings m_settings;
    StepCoefficients m_coefficients;
    BatchMomenta m_momenta;
    PerBatch m_inertiaFactor;  // 1 + h alpha
    PerBatch m_bSquares;       // |b|^2
    bool m_isGuessed = true;   // false: dv is zero
    ConjugateGradientStop m_stops[kBatchWidth];
    std::array<SolveReport, kBatchWidth> m_reports;

private:
    void addStiffness(ConstBodyVectors p) const;
    PerBatch applyA(ConstBodyVectors p, ConstBodyVectors with, BodyVectors Ap) const;
    BatchRecurrence recurrence(const PerBatch& active) const;

    GuessProducts<kBatchWidth> m_guessProducts;
    BodyVectors m_z = nullptr;
};

}  // namespace bullet_fem
