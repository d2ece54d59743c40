// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Rotations of several elements, and their deformed edges minus rotated rest edges. Included once for every instruction
// set.
#if defined(BULLETFEM_DEFORMED_EDGES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BULLETFEM_DEFORMED_EDGES_INL_H
#undef BULLETFEM_DEFORMED_EDGES_INL_H
#else
#define BULLETFEM_DEFORMED_EDGES_INL_H
#endif

#include "fem/elements/polar_lanes-inl.h"

#if HWY_TARGET != HWY_SCALAR
HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{

/// Number of double vectors per Real vector.
template <class Real>
constexpr int parts()
{
    return width<Real>() / width<double>();
}

HWY_INLINE Vector<float> rounded(const Vector<double> (&v)[2])
{
    const hn::Half<Lanes<float> > half;
    return hn::Combine(Lanes<float>(), hn::DemoteTo(half, v[1]), hn::DemoteTo(half, v[0]));
}

HWY_INLINE Vector<double> rounded(const Vector<double> (&v)[1])
{
    return v[0];
}

HWY_INLINE Vector<double> promoted(Vector<float> v, int part)
{
    const hn::Half<Lanes<float> > half;
    return hn::PromoteTo(Lanes<double>(), part == 0 ? hn::LowerHalf(half, v) : hn::UpperHalf(half, v));
}

HWY_INLINE Vector<double> promoted(Vector<double> v, int)
{
    return v;
}

template <class Real>
HWY_INLINE Matrix<Real> roundedMatrix(const Matrix<double> (&D)[parts<Real>()])
{
    Matrix<Real> A;
    HWY_UNROLL(9)
    for (int k = 0; k < 9; ++k)
    {
        Vector<double> entry[parts<Real>()];
        HWY_UNROLL(2)
        for (int part = 0; part < parts<Real>(); ++part) entry[part] = D[part].m[k / 3][k % 3];
        A.m[k / 3][k % 3] = rounded(entry);
    }
    return A;
}

/// Rotation matrices of quaternions of unit length to rounding of Real: then 2 / |q|^2 = 4 - 2 |q|^2.
HWY_INLINE Matrix<double> unitMatrix(const Quaternions<double>& q)
{
    const Vector<double> squares = hn::MulAdd(q.w, q.w, dot3(q.x, q.x, q.y, q.y, q.z, q.z));
    return toMatrix<double>(q, hn::NegMulAdd(number<double>(2), squares, number<double>(4)));
}

/// C - A B.
HWY_INLINE Matrix<double> minusProduct(Matrix<double> C, const Matrix<double>& A, const Matrix<double>& B)
{
    HWY_UNROLL(9)
    for (int k = 0; k < 9; ++k)
    {
        const int i = k / 3, j = k % 3;
        Vector<double>& c = C.m[i][j];
        c = hn::NegMulAdd(A.m[i][0], B.m[0][j], c);
        c = hn::NegMulAdd(A.m[i][1], B.m[1][j], c);
        c = hn::NegMulAdd(A.m[i][2], B.m[2][j], c);
    }
    return C;
}

/// D_s of as many elements as a Real vector has lanes. Elements::edges(part) returns those of a double vector.
template <class Real, class Elements>
HWY_INLINE Matrix<Real> roundedEdges(const Elements& elements)
{
    Matrix<double> D[parts<Real>()];
    HWY_UNROLL(2)
    for (int part = 0; part < parts<Real>(); ++part) D[part] = elements.edges(part);
    return roundedMatrix<Real>(D);
}

/// D_s - R D_m, for elements with restEdges(part): computed in double, where the difference is accurate enough for
/// strains of 1e-7, then rounded.
template <class Real, class Elements>
HWY_INLINE Matrix<Real> edgesMinusRotated(const Elements& elements, const Quaternions<Real>& q)
{
    Matrix<double> D[parts<Real>()];
    HWY_UNROLL(2)
    for (int part = 0; part < parts<Real>(); ++part)
    {
        const Matrix<double> R =
            unitMatrix({promoted(q.x, part), promoted(q.y, part), promoted(q.z, part), promoted(q.w, part)});
        const Matrix<double> Dm = elements.restEdges(part);
        D[part] = minusProduct(elements.edges(part), R, Dm);
    }
    return roundedMatrix<Real>(D);
}

/// The edges of a block's elements from `lane` on, as many as a vector has lanes.
template <class Real>
struct DeformedLanes
{
    const ElementBlock<Real>& m_block;
    const StagedEdges<double, width<Real>()>& m_x;
    int m_lane;

    HWY_INLINE Matrix<Real> DmInverse() const { return loadMatrix(m_block.m_DmInverse, m_lane); }
    HWY_INLINE Matrix<double> edges(int part) const { return m_x.load(part * width<double>()); }
    HWY_INLINE Matrix<double> restEdges(int part) const
    {
        return loadMatrix(m_block.m_Dm, m_lane + part * width<double>());
    }
};

HWY_INLINE Quaternions<float> loadQuaternions(const Quaternion* q, float)
{
    Quaternions<float> result;
    hn::LoadInterleaved4(Lanes<float>(), &q->x, result.x, result.y, result.z, result.w);
    return result;
}

HWY_INLINE Quaternions<double> loadQuaternions(const Quaternion* q, double)
{
    const Lanes<double> d;
    const hn::Rebind<float, Lanes<double> > single;
    hn::Vec<decltype(single)> x, y, z, w;
    hn::LoadInterleaved4(single, &q->x, x, y, z, w);
    return {hn::PromoteTo(d, x), hn::PromoteTo(d, y), hn::PromoteTo(d, z), hn::PromoteTo(d, w)};
}

HWY_INLINE void storeQuaternions(const Quaternions<float>& q, Quaternion* out)
{
    hn::StoreInterleaved4(q.x, q.y, q.z, q.w, Lanes<float>(), &out->x);
}

HWY_INLINE void storeQuaternions(const Quaternions<double>& q, Quaternion* out)
{
    const hn::Rebind<float, Lanes<double> > single;
    hn::StoreInterleaved4(hn::DemoteTo(single, q.x), hn::DemoteTo(single, q.y), hn::DemoteTo(single, q.z),
                          hn::DemoteTo(single, q.w), single, &out->x);
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();
#endif  // HWY_TARGET != HWY_SCALAR

#endif
