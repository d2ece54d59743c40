// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Hooke's law for several elements at a time. Included once for every instruction set.
#if defined(BULLETFEM_HOOKE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BULLETFEM_HOOKE_INL_H
#undef BULLETFEM_HOOKE_INL_H
#else
#define BULLETFEM_HOOKE_INL_H
#endif

#include "fem/common/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{

/// LawResponse without the energy.
template <class Real>
struct ResponseLanes
{
    HWY_INLINE ResponseLanes() = default;  // an implicit one would not be compiled for the instruction set

    Symmetric<Real> m_stress, m_cofactor;
    Vector<Real> m_bulk, m_shear;
};

template <class Real>
HWY_INLINE Symmetric<Real> withoutDoubling(const Symmetric<Real>& E)
{
    const Vector<Real> half = number<Real>(0.5);
    return {E.xx, E.yy, E.zz, half * E.yz, half * E.xz, half * E.xy};
}

template <class Real>
HWY_INLINE Symmetric<Real> withDoubling(const Symmetric<Real>& E)
{
    return {E.xx, E.yy, E.zz, E.yz + E.yz, E.xz + E.xz, E.xy + E.xy};
}

/// Stress 2 mu E + pressure I of a strain with doubled shears; mu includes the volume.
template <class Real>
HWY_INLINE Symmetric<Real> hookeUnder(Vector<Real> pressure, Vector<Real> mu, const Symmetric<Real>& E)
{
    const Vector<Real> twoMu = mu + mu;
    return {hn::MulAdd(twoMu, E.xx, pressure),
            hn::MulAdd(twoMu, E.yy, pressure),
            hn::MulAdd(twoMu, E.zz, pressure),
            mu * E.yz,
            mu * E.xz,
            mu * E.xy};
}

/// Stress 2 mu E + lambda tr(E) I of a strain with doubled shears; the Lame constants include the volume.
template <class Real>
HWY_INLINE Symmetric<Real> hooke(Vector<Real> lambda, Vector<Real> mu, const Symmetric<Real>& E)
{
    return hookeUnder<Real>(lambda * trace(E), mu, E);
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#endif
