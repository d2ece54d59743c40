// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Shared by the reference implementations of the element kernels.
#pragma once

#include "fem/common/rotation.h"
#include "fem/elements/element_pass.h"

namespace bullet_fem
{
namespace reference
{

/// One element of a block.
template <class Real>
struct ReferenceElement
{
    const ElementBlock<Real>& m_block;
    int m_lane;

    Mat3 Dm() const { return matrix(m_block.m_Dm); }
    Mat3 DmInverse() const { return matrix(m_block.m_DmInverse); }

    template <class Entry>
    Mat3 matrix(const Entry (*entries)[kLanes]) const
    {
        Mat3 A;
        for (int k = 0; k < 9; ++k) A(k / 3, k % 3) = entries[k][m_lane];
        return A;
    }

    /// [u_1 - u_0, u_2 - u_0, u_3 - u_0], rounded to Rounded.
    template <class Rounded = Real>
    Mat3 edges(const PaddedVec3* u) const
    {
        const std::int32_t* node = m_block.m_node[m_lane];
        const auto edge = [&](int a)
        {
            const PaddedVec3 &to = u[node[a]], &from = u[node[0]];
            return Vec3{static_cast<Rounded>(to.x - from.x), static_cast<Rounded>(to.y - from.y),
                        static_cast<Rounded>(to.z - from.z)};
        };
        return Mat3::fromColumns(edge(1), edge(2), edge(3));
    }

    /// V (2 mu sym(E) + lambda tr(E) I), with `dilatation` in place of tr(E) throughout.
    Mat3 hooke(const Mat3& E, double dilatation) const
    {
        const double mu = m_block.m_muVolume[m_lane];
        return mu * (E + transpose(E)) +
               Mat3::diagonal(m_block.m_lambdaVolume[m_lane] * dilatation + 2.0 / 3 * mu * (dilatation - trace(E)));
    }
};

/// Corner forces f_1, f_2, f_3 in the columns, f_0 = -(f_1 + f_2 + f_3).
template <class Real>
void storeCorners(const Mat3& f, int lane, CornerBlock<Real>& out)
{
    const Vec3 corner[4] = {-(f.column(0) + f.column(1) + f.column(2)), f.column(0), f.column(1), f.column(2)};
    for (int a = 0; a < 4; ++a)
    {
        for (int c = 0; c < 3; ++c) out.m_vector[a][lane][c] = static_cast<Real>(corner[a][c]);
        out.m_vector[a][lane][3] = 0;
    }
}

/// R, R^T (F - R) and R^T Fdot.
struct Strains
{
    Mat3 m_R, m_elastic, m_viscous;
};

/// Computes strains at the present positions, and updates the rotation.
template <class Real>
Strains strainsOf(const ElementPass<Real>& pass, int b, int lane)
{
    const ReferenceElement<Real> element = {pass.m_elements->m_blocks[b], lane};
    const Mat3 DmInverse = element.DmInverse();
    const Mat3 F = element.edges(pass.m_x) * DmInverse, Fdot = element.edges(pass.m_v) * DmInverse;
    Quaternion& q = pass.m_rotation[b * kLanes + lane];
    const Mat3 R = pass.m_isRotated ? toMatrix(q) : polarRotation(F, toMatrix(q));
    if (!pass.m_isRotated) q = rounded(toQuaternion(R));

    const Mat3 FminusR = (element.template edges<double>(pass.m_x) - R * element.Dm()) * DmInverse;
    return {R, transposeTimes(R, FminusR), transposeTimes(R, Fdot)};
}

/// sigma_0 of the element, times V; zero without initial stress.
template <class Real>
Mat3 initialStress(const ElementPass<Real>& pass, int b, int lane)
{
    if (!pass.m_initialStress) return {};
    const auto& s = pass.m_initialStress[b].m_entry;
    return {{{s[0][lane], s[5][lane], s[4][lane]},
             {s[5][lane], s[1][lane], s[3][lane]},
             {s[4][lane], s[3][lane], s[2][lane]}}};
}

/// The skew [w]x with (tr(S) I - S) w = axl(M - M^T), or 0 where S is nearly flat.
inline Mat3 spinBalance(const Mat3& S, const Mat3& M)
{
    const Mat3 c = M - transpose(M);
    const Mat3 H = Mat3::diagonal(trace(S)) - S;
    const double least = kMinPivot * trace(H), minor = H(0, 0) * H(1, 1) - H(0, 1) * H(0, 1);
    if (!(least > 0 && H(0, 0) > least && minor > least * H(0, 0) && determinant(H) > least * minor)) return {};
    return crossMatrix(inverse(H) * Vec3{c(2, 1), c(0, 2), c(1, 0)});
}

/// The skew W with (sigma_0 + W) S symmetric; zero if its equation is nearly singular.
inline Mat3 torqueBalance(const Mat3& S, const Mat3& stress)
{
    return spinBalance(S, S * stress);
}

}  // namespace reference
}  // namespace bullet_fem
