// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Polar rotations of several elements, and their deformed edges minus rotated rest edges. Included once for every
// instruction set.
#if defined(BULLETFEM_DEFORMED_EDGES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BULLETFEM_DEFORMED_EDGES_INL_H
#undef BULLETFEM_DEFORMED_EDGES_INL_H
#else
#define BULLETFEM_DEFORMED_EDGES_INL_H
#endif

#include <type_traits>

#include "fem/elements/lanes-inl.h"
#include "fem/elements/robust_rotations.h"

HWY_BEFORE_NAMESPACE();
namespace bullet_fem
{
namespace HWY_NAMESPACE
{

/// Quaternions of any nonzero length.
template <class Real>
struct Quaternions
{
    using V = Vector<Real>;
    HWY_INLINE Quaternions() = default;
    HWY_INLINE Quaternions(V qx, V qy, V qz, V qw) : x(qx), y(qy), z(qz), w(qw) {}

    V x, y, z, w;
};

template <class Real>
HWY_INLINE Quaternions<Real> normalised(const Quaternions<Real>& q)
{
    const Vector<Real> squares = hn::MulAdd(q.w, q.w, dot3(q.x, q.x, q.y, q.y, q.z, q.z));
    const Vector<Real> s = number<Real>(1) / hn::Sqrt(squares);
    return {q.x * s, q.y * s, q.z * s, q.w * s};
}

/// Rotation matrices of quaternions, two = 2 / |q|^2.
template <class Real>
HWY_INLINE Matrix<Real> toMatrix(const Quaternions<Real>& q, Vector<Real> two)
{
    using V = Vector<Real>;
    const V one = number<Real>(1), x2 = two * q.x, y2 = two * q.y, z2 = two * q.z;
    const V wx = q.w * x2, wy = q.w * y2, wz = q.w * z2, yy = q.y * y2, zz = q.z * z2;
    return {{{one - (yy + zz), hn::MulSub(q.x, y2, wz), hn::MulAdd(q.x, z2, wy)},
             {hn::MulAdd(q.x, y2, wz), one - hn::MulAdd(q.x, x2, zz), hn::MulSub(q.y, z2, wx)},
             {hn::MulSub(q.x, z2, wy), hn::MulAdd(q.y, z2, wx), one - hn::MulAdd(q.x, x2, yy)}}};
}

/// |q|^2 R.
template <class Real>
HWY_INLINE Matrix<Real> toScaledMatrix(const Quaternions<Real>& q)
{
    using V = Vector<Real>;
    const V x2 = q.x + q.x, y2 = q.y + q.y, z2 = q.z + q.z;
    const V wx = q.w * x2, wy = q.w * y2, wz = q.w * z2;
    const V ww = q.w * q.w, yy = q.y * q.y, zz = q.z * q.z, difference = zz - yy;
    const V wwxx = hn::MulAdd(q.x, q.x, ww), wwMinusxx = hn::NegMulAdd(q.x, q.x, ww);
    return {{{wwxx - (yy + zz), hn::MulSub(q.x, y2, wz), hn::MulAdd(q.x, z2, wy)},
             {hn::MulAdd(q.x, y2, wz), wwMinusxx - difference, hn::MulSub(q.y, z2, wx)},
             {hn::MulSub(q.x, z2, wy), hn::MulAdd(q.y, z2, wx), wwMinusxx + difference}}};
}

/// exp(2 c) q to third order in c, not normalised, by the Cayley map, which gives a rotation for every c.
template <class Real>
HWY_INLINE Quaternions<Real> turned(const Quaternions<Real>& q, const Vector<Real> (&c)[3])
{
    return {hn::NegMulAdd(c[2], q.y, hn::MulAdd(c[1], q.z, hn::MulAdd(c[0], q.w, q.x))),
            hn::NegMulAdd(c[0], q.z, hn::MulAdd(c[2], q.x, hn::MulAdd(c[1], q.w, q.y))),
            hn::NegMulAdd(c[1], q.x, hn::MulAdd(c[0], q.y, hn::MulAdd(c[2], q.w, q.z))),
            hn::NegMulAdd(c[2], q.z, hn::NegMulAdd(c[1], q.y, hn::NegMulAdd(c[0], q.x, q.w)))};
}

/// Outcome of a Newton step per element.
template <class Real>
struct NewtonStep
{
    hn::Mask<Lanes<Real>> m_definite;   // H is positive definite beyond rounding: R converges to the global maximum
    hn::Mask<Lanes<Real>> m_converged;  // the remaining error is of the size of rounding
};

/// One Newton step towards the maximum of tr(R^T F): with S = F R^T, H w = g, H = tr(S) I - sym(S), g = axl(S - S^T), R
/// is rotated by w. H w = g is solved by cofactors. After a step by w the error is about |w|^2 |H| |H^-1|. Skips
/// elements whose H is not positive definite, or so large that it may overflow, and those in `done`.
template <class Real>
HWY_INLINE NewtonStep<Real> newtonStep(const Matrix<Real>& F, hn::Mask<Lanes<Real>> done, Quaternions<Real>& q)
{
    using V = Vector<Real>;
    constexpr bool kSingle = std::is_same<Real, float>::value;
    const V tiny = number<Real>(kSingle ? 1e-4 : 1e-10), error = number<Real>(kSingle ? 1e-7 : 1e-17);
    const V huge = number<Real>(kSingle ? 1e24 : 1e200);  // larger values may overflow in products of three entries

    const Matrix<Real> S = timesTranspose(F, toScaledMatrix(q));
    const V g0 = S.m[2][1] - S.m[1][2], g1 = S.m[0][2] - S.m[2][0], g2 = S.m[1][0] - S.m[0][1];
    const V half = number<Real>(-0.5);
    const V h00 = S.m[1][1] + S.m[2][2], h11 = S.m[0][0] + S.m[2][2], h22 = S.m[0][0] + S.m[1][1];
    const V h01 = half * (S.m[0][1] + S.m[1][0]), h02 = half * (S.m[0][2] + S.m[2][0]),
            h12 = half * (S.m[1][2] + S.m[2][1]);
    const V c00 = hn::MulSub(h11, h22, h12 * h12), c01 = hn::MulSub(h02, h12, h01 * h22),
            c02 = hn::MulSub(h01, h12, h02 * h11);
    const V c11 = hn::MulSub(h00, h22, h02 * h02), c12 = hn::MulSub(h01, h02, h00 * h12),
            c22 = hn::MulSub(h00, h11, h01 * h01);
    const V det = dot3(h00, c00, h01, c01, h02, c02);

    // Sylvester's pivots h00, c22 / h00, det / c22 against the trace.
    const V trace = h00 + h11 + h22, least = hn::Max(tiny * trace, hn::Zero(Lanes<Real>()));
    const auto definite = hn::And(hn::And(h00 > least, c22 > least * h00), hn::And(det > least * c22, det < huge));

    const V s = number<Real>(0.5) / det;
    const auto moves = hn::AndNot(done, definite);
    const V c[3] = {hn::IfThenElseZero(moves, s * dot3(c00, g0, c01, g1, c02, g2)),
                    hn::IfThenElseZero(moves, s * dot3(c01, g0, c11, g1, c12, g2)),
                    hn::IfThenElseZero(moves, s * dot3(c02, g0, c12, g1, c22, g2))};
    q = turned<Real>(q, c);
    const V squaredStep = number<Real>(4) * dot3(c[0], c[0], c[1], c[1], c[2], c[2]);
    const V cofactors = c00 + c11 + c22;  // det times the trace of H^-1
    return {definite, hn::And(definite, squaredStep * trace * cofactors <= error * det)};
}

/// q <- the polar rotations of those F that are not in `known`, one by one.
template <class Real>
HWY_INLINE void singleRotations(const Matrix<Real>& F, hn::Mask<Lanes<Real>> known, Quaternions<Real>& q)
{
    const Lanes<Real> d;
    HWY_ALIGN Real entries[9][kLanes];
    BasicQuaternion<Real> rotation[kLanes];
    HWY_ALIGN Real marks[kLanes];
    for (int k = 0; k < 9; ++k) hn::Store(F.m[k / 3][k % 3], d, entries[k]);
    hn::StoreInterleaved4(q.x, q.y, q.z, q.w, d, &rotation[0].x);
    hn::Store(hn::IfThenElseZero(known, number<Real>(1)), d, marks);
    for (int lane = 0; lane < width<Real>(); ++lane)
        if (marks[lane] == 0) rotation[lane] = robustPolar(entries, lane, rotation[lane]);
    hn::LoadInterleaved4(d, &rotation[0].x, q.x, q.y, q.z, q.w);
}

constexpr int kBatch = 2;  // vectors of elements processed together, to hide latencies

/// q <- the polar rotations of `count` F, with q as initial guess. Elements where Newton's iteration fails are done one
/// by one. An element's result does not depend on the others: its iteration stops when it has converged.
template <class Real>
HWY_INLINE void polarRotations(const Matrix<Real>* F, int count, Quaternions<Real>* q)
{
    constexpr int kMaxSteps = 6;
    const Lanes<Real> d;
    hn::Mask<Lanes<Real>> converged[kBatch];
    for (auto& mask : converged) mask = hn::MaskFromVec(hn::Zero(d));
    bool over[kBatch] = {};
    int left = count;
    for (int k = 0; k < kMaxSteps && left > 0; ++k)
        for (int i = 0; i < count; ++i)
        {
            if (over[i]) continue;
            const NewtonStep<Real> step = newtonStep(F[i], converged[i], q[i]);
            converged[i] = hn::Or(converged[i], step.m_converged);
            over[i] = hn::AllTrue(d, hn::Or(converged[i], hn::Not(step.m_definite)));
            left -= over[i];
        }
    for (int i = 0; i < count; ++i)
    {
        q[i] = normalised(q[i]);
        if (HWY_UNLIKELY(!hn::AllTrue(d, converged[i]))) singleRotations(F[i], converged[i], q[i]);
    }
}

/// Number of double vectors per Real vector.
template <class Real>
constexpr int parts()
{
    return width<Real>() / width<double>();
}

#if HWY_TARGET == HWY_SCALAR
HWY_INLINE Vector<float> rounded(const Vector<double> (&v)[1], float)
{
    return hn::DemoteTo(Lanes<float>(), v[0]);
}

HWY_INLINE Vector<double> promoted(Vector<float> v, int)
{
    return hn::PromoteTo(Lanes<double>(), v);
}
#else
HWY_INLINE Vector<float> rounded(const Vector<double> (&v)[2], float)
{
    const hn::Half<Lanes<float>> half;
    return hn::Combine(Lanes<float>(), hn::DemoteTo(half, v[1]), hn::DemoteTo(half, v[0]));
}

HWY_INLINE Vector<double> promoted(Vector<float> v, int part)
{
    const hn::Half<Lanes<float>> half;
    return hn::PromoteTo(Lanes<double>(), part == 0 ? hn::LowerHalf(half, v) : hn::UpperHalf(half, v));
}
#endif

HWY_INLINE Vector<double> rounded(const Vector<double> (&v)[1], double)
{
    return v[0];
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
        for (int part = 0; part < parts<Real>(); ++part) entry[part] = D[part].m[k / 3][k % 3];
        A.m[k / 3][k % 3] = rounded(entry, Real());
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
    for (int part = 0; part < parts<Real>(); ++part) D[part] = elements.edges(part);
    return roundedMatrix<Real>(D);
}

/// D_s - R D_m, for elements with restEdges(part): computed in double, where the difference is accurate enough for
/// strains of 1e-7, then rounded.
template <class Real, class Elements>
HWY_INLINE Matrix<Real> edgesMinusRotated(const Elements& elements, const Quaternions<Real>& q)
{
    Matrix<double> D[parts<Real>()];
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
    const hn::Rebind<float, Lanes<double>> single;
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
    const hn::Rebind<float, Lanes<double>> single;
    hn::StoreInterleaved4(hn::DemoteTo(single, q.x), hn::DemoteTo(single, q.y), hn::DemoteTo(single, q.z),
                          hn::DemoteTo(single, q.w), single, &out->x);
}

}  // namespace HWY_NAMESPACE
}  // namespace bullet_fem
HWY_AFTER_NAMESPACE();

#endif
