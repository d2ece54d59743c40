// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Transfer of element strains to and from edge domains. Included once for every instruction set.
#if defined(BULLETFEM_SMOOTHED_STRAIN_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BULLETFEM_SMOOTHED_STRAIN_INL_H
#undef BULLETFEM_SMOOTHED_STRAIN_INL_H
#else
#define BULLETFEM_SMOOTHED_STRAIN_INL_H
#endif

#include "fem/elements/element_math-inl.h"
#include "fem/elements/smoothed_elements.h"

#if HWY_TARGET != HWY_SCALAR
HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{

/// Stores strains as quads of the elements from `lane` on.
template <class Real>
HWY_INLINE void storeQuads(const Symmetric<Real>& E, Vector<Real> theta, StrainQuads<Real>& out, int lane)
{
    const Lanes<Real> d;
    hn::StoreInterleaved4(E.xx, E.yy, E.zz, E.yz, d, out.m_quad[0][lane]);
    hn::StoreInterleaved4(E.xz, E.xy, theta, hn::Zero(d), d, out.m_quad[1][lane]);
}

/// Loads strains stored by storeQuads().
template <class Real>
HWY_INLINE Symmetric<Real> loadQuads(const Real* first, const Real* second, Vector<Real>& theta)
{
    const Lanes<Real> d;
    Symmetric<Real> E;
    Vector<Real> zero;
    hn::LoadInterleaved4(d, first, E.xx, E.yy, E.zz, E.yz);
    hn::LoadInterleaved4(d, second, E.xz, E.xy, theta, zero);
    return E;
}

/// The smoothed strains of as many elements as a vector has lanes, transferred to vectors via memory.
template <class Real>
struct StagedStrains
{
    HWY_ALIGN Real m_quad[2][width<Real>()][4];

    /// Elements of block b, from `lane` on.
    HWY_INLINE void stage(const EdgeSmoothing<Real>& smoothing, const SmoothedStrain<Real>& strain, int b, int lane)
    {
        for (int i = 0; i < width<Real>(); ++i) stageLane(smoothing, strain, b, lane, i);
    }

    HWY_INLINE Symmetric<Real> load() const
    {
        Vector<Real> theta;
        return loadQuads<Real>(m_quad[0][0], m_quad[1][0], theta);
    }

private:
    HWY_INLINE void stageLane(const EdgeSmoothing<Real>& smoothing, const SmoothedStrain<Real>& strain, int b, int lane,
                              int i)
    {
        const hn::CappedTag<Real, 4> d;
        const typename EdgeSmoothing<Real>::BlockShares& lanes = smoothing.m_lanes[b];
        const std::int32_t* domain = lanes.m_domain[lane + i];
        const auto own = hn::Set(d, lanes.m_own[lane + i]), share = hn::Set(d, lanes.m_ofDomain[lane + i]);
        HWY_UNROLL(2)
        for (int half = 0; half < 2; ++half)
            for (int c = 0; c < 4; c += static_cast<int>(hn::MaxLanes(d)))
            {
                const auto load = [&](int k) { return hn::Load(d, strain.m_domain[domain[k]].m_quad[half] + c); };
                const auto a = hn::Add(load(0), load(1)), b2 = hn::Add(load(2), load(3)), e = hn::Add(load(4), load(5));
                const auto sum = hn::Add(hn::Add(a, b2), e);
                const auto mine = hn::Mul(own, hn::Load(d, strain.m_element[b].m_quad[half][lane + i] + c));
                hn::Store(hn::MulAdd(share, sum, mine), d, m_quad[half][i] + c);
            }
    }
};

/// V (2 mu dev(s) + (lambda + 2/3 mu) theta I); the moduli include V.
template <class Real>
HWY_INLINE Symmetric<Real> smoothedStress(Vector<Real> lambda, Vector<Real> mu, const Symmetric<Real>& s,
                                          Vector<Real> theta)
{
    return hookeUnder<Real>(pressureInPatch<Real>(lambda, mu, trace(s), theta), mu, s);
}

template <class Real>
HWY_INLINE Vector<Real> loadLambda(const ElementBlocks<Real>& elements, int b, int lane)
{
    return hn::Load(Lanes<Real>(), elements.m_blocks[b].m_lambdaVolume + lane);
}

template <class Real>
HWY_INLINE Vector<Real> loadMu(const ElementBlocks<Real>& elements, int b, int lane)
{
    return hn::Load(Lanes<Real>(), elements.m_blocks[b].m_muVolume + lane);
}

template <class Real>
HWY_INLINE void storeMatrix(const Matrix<Real>& A, Real (*entries)[kLanes], int lane)
{
    HWY_UNROLL(9)
    for (int k = 0; k < 9; ++k) hn::Store(A.m[k / 3][k % 3], Lanes<Real>(), entries[k] + lane);
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET != HWY_SCALAR

#endif
