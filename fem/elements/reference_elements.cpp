// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The element kernels in plain C++, an element at a time in double precision: what the others are tested against.
#include "fem/common/rotation.h"
#include "fem/elements/element_product.h"
#include "fem/elements/positive_part.h"

namespace bullet_fem
{
namespace reference
{
namespace
{

/// One element of a block.
template <class Real>
struct Element
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

    /// V (2 mu sym(E) + lambda tr(E) I).
    Mat3 hooke(const Mat3& E) const
    {
        return m_block.m_muVolume[m_lane] * (E + transpose(E)) +
               Mat3::diagonal(m_block.m_lambdaVolume[m_lane] * trace(E));
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

template <class Real>
void storeTension(const Mat3& T, int lane, WarpedBlock<Real>& out)
{
    const double entries[6] = {T(0, 0), T(1, 1), T(2, 2), T(1, 2), T(0, 2), T(0, 1)};
    for (int k = 0; k < 6; ++k) out.m_tension[k][lane] = static_cast<Real>(entries[k]);
}

template <class Real>
void passElement(const ElementPass<Real>& pass, int b, int lane)
{
    const Element<Real> element = {pass.m_elements->m_blocks[b], lane};
    const Mat3 DmInverse = element.DmInverse();
    const Mat3 F = element.edges(pass.m_x) * DmInverse, Fdot = element.edges(pass.m_v) * DmInverse;
    Quaternion& q = pass.m_rotation[b * kLanes + lane];
    const Mat3 R = pass.m_isRotated ? toMatrix(q) : polarRotation(F, toMatrix(q));
    if (!pass.m_isRotated) q = rounded(toQuaternion(R));

    const Mat3 FminusR = (element.template edges<double>(pass.m_x) - R * element.Dm()) * DmInverse;
    const Mat3 elastic = element.hooke(transposeTimes(R, FminusR));
    const Mat3 viscous = element.hooke(transposeTimes(R, Fdot));
    storeCorners(timesTranspose(-1.0 * (R * (elastic + pass.m_damping * viscous)), DmInverse), lane, pass.m_force[b]);

    WarpedBlock<Real>& warped = pass.m_warped[b];
    const Mat3 g = timesTranspose(DmInverse, R);
    for (int k = 0; k < 9; ++k) warped.m_gradient[k][lane] = static_cast<Real>(g(k / 3, k % 3));
    storeTension(pass.m_tensionFactor * (R * timesTranspose(positivePart(elastic), R)), lane, warped);
}

template <class Real>
void multiplyElement(const ElementProduct<Real>& product, int b, int lane)
{
    const WarpedBlock<Real>& warped = product.m_warped[b];
    const auto& t = warped.m_tension;
    Mat3 g;
    for (int k = 0; k < 9; ++k) g(k / 3, k % 3) = warped.m_gradient[k][lane];
    const Mat3 T = {{{t[0][lane], t[5][lane], t[4][lane]},
                     {t[5][lane], t[1][lane], t[3][lane]},
                     {t[4][lane], t[3][lane], t[2][lane]}}};
    const Element<Real> element = {product.m_elements->m_blocks[b], lane};
    const Mat3 H = element.edges(product.m_p) * g;
    const Mat3 P = product.m_stiffnessFactor * element.hooke(H) + H * T;
    storeCorners(timesTranspose(P, g), lane, product.m_out[b]);
}

}  // namespace

template <class Real>
void runElementPass(const ElementPass<Real>& pass, Range blocks)
{
    for (int b = blocks.m_begin; b < blocks.m_end; ++b)
        for (int lane = 0; lane < kLanes; ++lane) passElement(pass, b, lane);
}

template <class Real>
void runElementProduct(const ElementProduct<Real>& product, Range blocks)
{
    for (int b = blocks.m_begin; b < blocks.m_end; ++b)
        for (int lane = 0; lane < kLanes; ++lane) multiplyElement(product, b, lane);
}

template void runElementPass(const ElementPass<float>&, Range);
template void runElementPass(const ElementPass<double>&, Range);
template void runElementProduct(const ElementProduct<float>&, Range);
template void runElementProduct(const ElementProduct<double>&, Range);

}  // namespace reference
}  // namespace bullet_fem
