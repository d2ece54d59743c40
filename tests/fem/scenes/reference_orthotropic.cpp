// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/reference/positive_part.h"
#include "fem/scenes/reference_elements.h"
#include "fem/scenes/reference_math.h"

namespace bullet_fem
{
namespace reference
{
namespace
{

// V D sym(E).
template <class Real>
Mat3 restOfStress(const StiffnessBlock<Real>& block, int lane, const Mat3& E)
{
    ElasticMatrix D;
    int entry = 0;
    for (int i = 0; i < 6; ++i)
        for (int j = i; j < 6; ++j, ++entry) D(i, j) = D(j, i) = static_cast<double>(block.m_entry[entry][lane]);
    return toMatrix(stressOf(D, symmetricPart(E)));
}

template <class Real>
void storeSymmetric(const Mat3& S, int lane, Real (&to)[6][kLanes])
{
    const double entries[6] = {S(0, 0), S(1, 1), S(2, 2), S(1, 2), S(0, 2), S(0, 1)};
    for (int k = 0; k < 6; ++k) to[k][lane] = static_cast<Real>(entries[k]);
}

template <class Real>
Mat3 loadSymmetric(const Real (&s)[6][kLanes], int lane)
{
    return {{{s[0][lane], s[5][lane], s[4][lane]},
             {s[5][lane], s[1][lane], s[3][lane]},
             {s[4][lane], s[3][lane], s[2][lane]}}};
}

/// S, and (tr(S) I - S)^-1 or zero.
struct Stretch
{
    Mat3 m_S, m_spin;

    static Stretch of(const Mat3& S)
    {
        const Mat3 G = Mat3::diagonal(trace(S)) - S;
        const double least = kMinPivot * trace(G), minor = G(0, 0) * G(1, 1) - G(0, 1) * G(0, 1);
        const bool definite = least > 0 && G(0, 0) > least && minor > least * G(0, 0) && determinant(G) > least * minor;
        return {S, definite ? inverse(G) : Mat3()};
    }

    Mat3 turnOf(const Mat3& M) const
    {
        return crossMatrix(m_spin * Vec3{M(2, 1) - M(1, 2), M(0, 2) - M(2, 0), M(1, 0) - M(0, 1)});
    }
    Mat3 change(const Mat3& H) const { return H - turnOf(H) * m_S; }  // its symmetric part is used
    Mat3 balanced(const Mat3& stress) const { return stress + turnOf(m_S * stress); }
};

template <class Real>
void passOrthotropic(const StretchPass<Real>& pass, int b, int lane)
{
    const ElementPass<Real>& plain = pass.m_elements;
    const Strains strains = strainsOf(plain, b, lane);
    const StiffnessBlock<Real>& D = plain.m_elements->m_stiffness[b];
    const ReferenceElement<Real> element = {plain.m_elements->m_blocks[b], lane};
    const Mat3 damped = strains.m_elastic + plain.m_damping * strains.m_viscous;
    const Stretch stretch = Stretch::of(Mat3::identity() + 0.5 * (strains.m_elastic + transpose(strains.m_elastic)));
    const Mat3 rest = restOfStress(D, lane, strains.m_elastic) + initialStress(plain, b, lane);
    const Mat3 viscous = plain.m_damping * restOfStress(D, lane, stretch.change(strains.m_viscous));
    const Mat3 P = element.hooke(damped, trace(damped)) + stretch.balanced(rest + viscous);
    storeCorners(timesTranspose(-1.0 * (strains.m_R * P), element.DmInverse()), lane, plain.m_force[b]);

    StretchBlock<Real>& out = pass.m_warped[b];
    for (int k = 0; k < 9; ++k) out.m_rotation[k][lane] = static_cast<Real>(strains.m_R(k / 3, k % 3));
    storeSymmetric(
        plain.m_tensionFactor * positivePart(element.hooke(strains.m_elastic, trace(strains.m_elastic)) + rest), lane,
        out.m_tension);
    storeSymmetric(stretch.m_S, lane, out.m_stretch);
    storeSymmetric(stretch.m_spin, lane, out.m_spin);
}

template <class Real>
void multiplyOrthotropic(const StretchProduct<Real>& product, int b, int lane)
{
    const ElementProduct<Real>& plain = product.m_elements;
    const StretchBlock<Real>& warped = product.m_warped[b];
    const ReferenceElement<Real> element = {plain.m_elements->m_blocks[b], lane};
    const Mat3 R = element.matrix(warped.m_rotation);
    const Mat3 H = transposeTimes(R, element.edges(plain.m_p) * element.DmInverse());
    const Stretch stretch = {loadSymmetric(warped.m_stretch, lane), loadSymmetric(warped.m_spin, lane)};
    const Mat3 rest = stretch.balanced(restOfStress(plain.m_elements->m_stiffness[b], lane, stretch.change(H)));
    const Mat3 P =
        plain.m_stiffnessFactor * (element.hooke(H, trace(H)) + rest) + H * loadSymmetric(warped.m_tension, lane);
    storeCorners(timesTranspose(R * P, element.DmInverse()), lane, plain.m_out[b]);
}

}  // namespace

template <class Real>
void runOrthotropicPass(const StretchPass<Real>& pass, Range blocks)
{
    for (int b = blocks.m_begin; b < blocks.m_end; ++b)
        for (int lane = 0; lane < kLanes; ++lane) passOrthotropic(pass, b, lane);
}

template <class Real>
void runOrthotropicProduct(const StretchProduct<Real>& product, Range blocks)
{
    for (int b = blocks.m_begin; b < blocks.m_end; ++b)
        for (int lane = 0; lane < kLanes; ++lane) multiplyOrthotropic(product, b, lane);
}

template void runOrthotropicPass(const StretchPass<float>&, Range);
template void runOrthotropicPass(const StretchPass<double>&, Range);
template void runOrthotropicProduct(const StretchProduct<float>&, Range);
template void runOrthotropicProduct(const StretchProduct<double>&, Range);

}  // namespace reference
}  // namespace bullet_fem
