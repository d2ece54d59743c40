// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// One element of bodies side by side, for the element kernels. Included once for every instruction set.
#if defined(BULLETFEM_LANE_ELEMENT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BULLETFEM_LANE_ELEMENT_INL_H
#undef BULLETFEM_LANE_ELEMENT_INL_H
#else
#define BULLETFEM_LANE_ELEMENT_INL_H
#endif

#include <cstddef>

#include "fem/batch/batch_elements.h"
#include "fem/elements/element_math-inl.h"

#if HWY_TARGET != HWY_SCALAR
HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{

using F = Vector<float>;

HWY_INLINE Vector<double> difference(const double* to, const double* from)
{
    const Lanes<double> d;
    return hn::Sub(hn::Load(d, to), hn::Load(d, from));
}

/// One element of as many bodies as a vector has lanes.
struct LaneElement
{
    const BatchElements& m_all;
    const BatchElementPass* m_pass;
    int m_element, m_lane;  // the first body
    bool m_isCopy = false;  // true: discard its forces
    int m_group = 0;        // of patches

    HWY_INLINE const ElementBlock<float>& block() const { return m_all.m_rest->m_blocks[m_element / kLanes]; }
    HWY_INLINE int place() const { return m_element % kLanes; }
    HWY_INLINE const BatchCorners& corners() const { return m_all.m_corners[m_element]; }
    HWY_INLINE double* sumOf(int corner) const { return m_all.m_sums + corners().m_sum[corner] + m_lane; }
    HWY_INLINE float* rotations() const
    {
        return m_all.m_rotation + static_cast<std::size_t>(m_element) * 4 * kBatchWidth + m_lane;
    }
    HWY_INLINE float* gradients() const
    {
        return m_all.m_warped + static_cast<std::size_t>(m_element) * kWarpedRows * kBatchWidth + m_lane;
    }
    HWY_INLINE float* tensions() const { return gradients() + 9 * kBatchWidth; }

    HWY_INLINE F lambda() const { return hn::Set(Lanes<float>(), block().m_lambdaVolume[place()]); }
    HWY_INLINE F share() const
    {
        return hn::Set(Lanes<float>(), m_all.m_rest->m_share[m_element / kLanes].m_lane[place()]);
    }
    HWY_INLINE F filter(int entry) const
    {
        return hn::Set(Lanes<float>(), m_all.m_rest->m_filter[m_group].m_entry[entry][place()]);
    }
    HWY_INLINE bool hasInitialStress() const { return false; }
    HWY_INLINE Symmetric<float> initialStress() const { return {}; }
    HWY_INLINE F mu() const { return hn::Set(Lanes<float>(), block().m_muVolume[place()]); }
    HWY_INLINE F damping() const { return number<float>(m_pass->m_damping); }
    HWY_INLINE Matrix<float> DmInverse() const
    {
        Matrix<float> A;
        HWY_UNROLL(9)
        for (int k = 0; k < 9; ++k) A.m[k / 3][k % 3] = hn::Set(Lanes<float>(), block().m_DmInverse[k][place()]);
        return A;
    }
    HWY_INLINE Matrix<double> restEdges(int) const
    {
        Matrix<double> A;
        HWY_UNROLL(9)
        for (int k = 0; k < 9; ++k) A.m[k / 3][k % 3] = hn::Set(Lanes<double>(), block().m_Dm[k][place()]);
        return A;
    }
    HWY_INLINE Matrix<double> edgesOf(const double* values, int part) const
    {
        const double* at = values + m_lane + part * width<double>();
        const double* from = at + corners().m_node[0];
        Matrix<double> D;
        HWY_UNROLL(3)
        for (int a = 0; a < 3; ++a)
        {
            const double* to = at + corners().m_node[a + 1];
            HWY_UNROLL(3)
            for (int i = 0; i < 3; ++i) D.m[i][a] = difference(to + i * kBatchWidth, from + i * kBatchWidth);
        }
        return D;
    }
    HWY_INLINE Matrix<double> edges(int part) const { return edgesOf(m_pass->m_x, part); }
    HWY_INLINE Matrix<float> roundedEdgesOf(const double* values) const
    {
        Matrix<double> D[parts<float>()];
        HWY_UNROLL(2)
        for (int part = 0; part < parts<float>(); ++part) D[part] = edgesOf(values, part);
        return roundedMatrix<float>(D);
    }
    HWY_INLINE Matrix<float> velocityEdges() const { return roundedEdgesOf(m_pass->m_v); }

    /// Adds f_1, f_2, f_3, the columns of f, and f_0 = -(f_1 + f_2 + f_3) to the sums of the corners.
    HWY_INLINE void storeForces(const Matrix<float>& f) const
    {
        if (m_isCopy) return;
        double* const sums[4] = {sumOf(0), sumOf(1), sumOf(2), sumOf(3)};
        HWY_UNROLL(3)
        for (int i = 0; i < 3; ++i)
        {
            const F others = hn::Add(hn::Add(f.m[i][0], f.m[i][1]), f.m[i][2]);
            addTo(sums[0] + i * kBatchWidth, hn::Sub(hn::Zero(Lanes<float>()), others));
            HWY_UNROLL(3)
            for (int a = 0; a < 3; ++a) addTo(sums[a + 1] + i * kBatchWidth, f.m[i][a]);
        }
    }
    static HWY_INLINE void addTo(double* sum, F value)
    {
        const Lanes<double> d;
        HWY_UNROLL(2)
        for (int part = 0; part < parts<float>(); ++part, sum += width<double>())
            hn::Store(hn::Add(hn::Load(d, sum), promoted(value, part)), d, sum);
    }
    HWY_INLINE void storeGradients(const Matrix<float>& g) const
    {
        HWY_UNROLL(9)
        for (int k = 0; k < 9; ++k) hn::Store(g.m[k % 3][k / 3], Lanes<float>(), gradients() + k * kBatchWidth);
    }
    HWY_INLINE Matrix<float> loadGradients() const
    {
        Matrix<float> g;
        HWY_UNROLL(9)
        for (int k = 0; k < 9; ++k) g.m[k / 3][k % 3] = hn::Load(Lanes<float>(), gradients() + k * kBatchWidth);
        return g;
    }
    HWY_INLINE void storeRotation(const Matrix<float>& R) const
    {
        HWY_UNROLL(9)
        for (int k = 0; k < 9; ++k) hn::Store(R.m[k / 3][k % 3], Lanes<float>(), gradients() + k * kBatchWidth);
    }
    HWY_INLINE Matrix<float> loadRotation() const { return loadGradients(); }
    HWY_INLINE void storeTension(const Symmetric<float>& T) const
    {
        const F entries[6] = {T.xx, T.yy, T.zz, T.yz, T.xz, T.xy};
        HWY_UNROLL(6)
        for (int k = 0; k < 6; ++k) hn::Store(entries[k], Lanes<float>(), tensions() + k * kBatchWidth);
    }
    HWY_INLINE Symmetric<float> loadTension() const
    {
        const Lanes<float> d;
        const float* t = tensions();
        return {hn::Load(d, t),
                hn::Load(d, t + kBatchWidth),
                hn::Load(d, t + 2 * kBatchWidth),
                hn::Load(d, t + 3 * kBatchWidth),
                hn::Load(d, t + 4 * kBatchWidth),
                hn::Load(d, t + 5 * kBatchWidth)};
    }

    HWY_INLINE Quaternions<float> loadRotations() const
    {
        const Lanes<float> d;
        const float* q = rotations();
        return {hn::Load(d, q), hn::Load(d, q + kBatchWidth), hn::Load(d, q + 2 * kBatchWidth),
                hn::Load(d, q + 3 * kBatchWidth)};
    }
    HWY_INLINE void storeRotations(const Quaternions<float>& q) const
    {
        const Lanes<float> d;
        float* to = rotations();
        hn::Store(q.x, d, to);
        hn::Store(q.y, d, to + kBatchWidth);
        hn::Store(q.z, d, to + 2 * kBatchWidth);
        hn::Store(q.w, d, to + 3 * kBatchWidth);
    }
};

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET != HWY_SCALAR

#endif
