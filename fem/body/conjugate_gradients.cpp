// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/body/conjugate_gradients.h"

#include "fem/common/chunks.h"

namespace bullet_fem
{
namespace
{

// Four partial sums make additions independent; their order is fixed.
double dotOfRange(const std::vector<Vec3>& a, const std::vector<Vec3>& b, Range nodes)
{
    double sum[4] = {};
    int i = nodes.m_begin;
    for (; i + 4 <= nodes.m_end; i += 4)
        for (int k = 0; k < 4; ++k) sum[k] += dot(a[i + k], b[i + k]);
    for (; i < nodes.m_end; ++i) sum[0] += dot(a[i], b[i]);
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

}  // namespace

double dot(const std::vector<Vec3>& a, const std::vector<Vec3>& b, const Threads* threads)
{
    const Chunks chunks(static_cast<int>(a.size()), kEntriesPerChunk);
    double sums[Chunks::kMax];
    runTasks(threads, chunks.count(), [&](int k) { sums[k] = dotOfRange(a, b, chunks[k]); });
    double sum = 0;
    for (int k = 0; k < chunks.count(); ++k) sum += sums[k];
    return sum;
}

namespace
{

/// System interface of solveConjugateGradients() for a single system.
class VectorsOfOne
{
public:
    static constexpr int kBodies = 1;
    using Numbers = PerBody<1>;

    explicit VectorsOfOne(const OperatorSystem& system) : m_system(system) {}

    int count() const { return 1; }
    Numbers rightSideSquares() const { return {{dotOf(m_system.m_b, m_system.m_b)}}; }
    void startFromZero() { vectors().m_r = m_system.m_b; }

    GuessMeasure<1> measureGuess()
    {
        const Numbers xx = {{dotOf(m_system.m_x, m_system.m_x)}};
        if (xx[0] > 0) return {xx, trueResidual({})};
        startFromZero();
        return {xx, {}};
    }

    GuessProducts<1> guessProducts() const
    {
        return {{{dotOf(m_system.m_b, m_system.m_x)}}, {{dotOf(m_system.m_x, vectors().m_Ap)}}};
    }

    /// r = b - A x, or b if x becomes zero.
    Numbers scaleGuess(const Numbers& scale, const Numbers& isScaled)
    {
        if (!(isScaled[0] > 0)) return {};
        const double factor = scale[0];
        std::vector<Vec3>&x = m_system.m_x, &r = vectors().m_r;
        const std::vector<Vec3>&b = m_system.m_b, &Ax = vectors().m_Ap;
        forEachNode(
            [&](int i)
            {
                x[i] *= factor;
                r[i] = factor > 0 ? b[i] - factor * Ax[i] : b[i];
            });
        return {{dotOf(r, r)}};
    }

    Numbers trueResidual(const Numbers&)
    {
        std::vector<Vec3>&Ax = vectors().m_Ap, &r = vectors().m_r;
        const std::vector<Vec3>& b = m_system.m_b;
        m_system.m_A.apply(m_system.m_x, Ax);
        forEachNode([&](int i) { r[i] = b[i] - Ax[i]; });
        return {{dotOf(r, r)}};
    }

    Numbers precondition(bool isFirst)
    {
        std::vector<Vec3>& z = isFirst ? vectors().m_p : vectors().m_z;  // the first direction p = z
        m_system.m_P.apply(vectors().m_r, z);
        return {{dotOf(vectors().m_r, z)}};
    }

    /// p = z if beta is 0, whatever p contained.
    void turnDirection(const Numbers& beta, const Numbers&)
    {
        std::vector<Vec3>& p = vectors().m_p;
        const std::vector<Vec3>& z = vectors().m_z;
        forEachNode([&, factor = beta[0]](int i) { p[i] = factor > 0 ? z[i] + factor * p[i] : z[i]; });
    }

    Numbers applyToDirection()
    {
        m_system.m_A.apply(vectors().m_p, vectors().m_Ap);
        return {{dotOf(vectors().m_p, vectors().m_Ap)}};
    }

    Numbers advance(const Numbers& step, const Numbers&)
    {
        std::vector<Vec3>&x = m_system.m_x, &r = vectors().m_r;
        const std::vector<Vec3>&p = vectors().m_p, &Ap = vectors().m_Ap;
        forEachNode(
            [&, length = step[0]](int i)
            {
                x[i] += length * p[i];
                r[i] += -length * Ap[i];
            });
        return {{dotOf(r, r)}};
    }

private:
    ConjugateGradientScratch& vectors() const { return m_system.m_scratch; }
    double dotOf(const std::vector<Vec3>& a, const std::vector<Vec3>& b) const { return dot(a, b, m_system.m_threads); }

    /// Calls update(i) for every node; update may change entries i only.
    template <class Update>
    void forEachNode(const Update& update) const
    {
        runRanges(m_system.m_threads, {static_cast<int>(m_system.m_b.size()), kEntriesPerChunk},
                  [&](Range nodes)
                  {
                      for (int i = nodes.m_begin; i < nodes.m_end; ++i) update(i);
                  });
    }

    const OperatorSystem& m_system;
};

}  // namespace

SolveReport solveConjugateGradients(const OperatorSystem& system, const ConjugateGradientStop& stop, bool isGuessed)
{
    VectorsOfOne vectors(system);
    SolveReport report;
    solveConjugateGradients(vectors, &stop, isGuessed, &report);
    return report;
}

}  // namespace bullet_fem
