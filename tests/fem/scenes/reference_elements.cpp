// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/scenes/reference_elements.h"

#include <array>
#include <cmath>

#include "benchmarks/reference/positive_part.h"
#include "bullet_fem/fem/common/symmetric.h"
#include "fem/laws/neo_hooke.h"
#include "fem/scenes/reference_math.h"

namespace bullet_fem
{
namespace reference
{
namespace
{

template <class Real>
void storeTension(const Mat3& T, int lane, WarpedBlock<Real>& out)
{
    const double entries[6] = {T(0, 0), T(1, 1), T(2, 2), T(1, 2), T(0, 2), T(0, 1)};
    for (int k = 0; k < 6; ++k) out.m_tension[k][lane] = static_cast<Real>(entries[k]);
}

// For both laws, all in the element's own frame until stored; `initial` is the initial stress with its W.
template <class Real>
void passNonlinear(const ElementPass<Real>& pass, int b, int lane, const Strains& strains, const Mat3& initial)
{
    const ElementBlock<Real>& block = pass.m_elements->m_blocks[b];
    const Mat3 DmInverse = ReferenceElement<Real>{block, lane}.DmInverse(), R = strains.m_R;
    const Mat3 e = 0.5 * (strains.m_elastic + transpose(strains.m_elastic));
    const Mat3 rate = 0.5 * (strains.m_viscous + transpose(strains.m_viscous));
    const double lambda = block.m_lambdaVolume[lane], mu = block.m_muVolume[lane];
    LawResponse law = {2 * mu * e + Mat3::diagonal(lambda * trace(e)), Mat3::identity(), lambda, 1, 0};
    if (pass.m_elements->m_law[b].m_lane[lane] > 0 && mu > 0) law = neoHooke(e, lambda, mu);
    const double dilatation = trace(transposeTimes(law.m_cofactor, rate));
    const Mat3 viscous = law.m_bulk * dilatation * law.m_cofactor + 2 * mu * law.m_shear * rate;
    const Mat3 P = law.m_stress + pass.m_damping * viscous + initial;
    storeCorners(timesTranspose(-1.0 * (R * P), DmInverse), lane, pass.m_force[b]);

    WarpedBlock<Real>& warped = pass.m_warped[b];
    const Mat3 g = std::sqrt(law.m_shear) * timesTranspose(DmInverse, R);
    for (int k = 0; k < 9; ++k) warped.m_gradient[k][lane] = static_cast<Real>(g(k / 3, k % 3));
    const Mat3 given = 0.5 * (initial + transpose(initial));
    const double factor = pass.m_tensionFactor / law.m_shear;
    storeTension(factor * (R * timesTranspose(positivePart(law.m_stress + given), R)), lane, warped);
    const Mat3 C = 1 / std::sqrt(law.m_shear) * (R * timesTranspose(law.m_cofactor, R));
    const double entries[6] = {C(0, 0), C(1, 1), C(2, 2), C(1, 2), C(0, 2), C(0, 1)};
    for (int k = 0; k < 6; ++k) pass.m_tangent[b].m_cofactor[k][lane] = static_cast<Real>(entries[k]);
    pass.m_tangent[b].m_bulk[lane] = static_cast<Real>(law.m_bulk);
}

template <class Real>
void passElement(const ElementPass<Real>& pass, int b, int lane, const Strains& strains, double dilatation, double rate)
{
    const ReferenceElement<Real> element = {pass.m_elements->m_blocks[b], lane};
    const Mat3 DmInverse = element.DmInverse(), R = strains.m_R;
    const Mat3 elastic = element.hooke(strains.m_elastic, dilatation);
    const Mat3 viscous = element.hooke(strains.m_viscous, rate), initial = initialStress(pass, b, lane);
    const Mat3 S = Mat3::identity() + 0.5 * (strains.m_elastic + transpose(strains.m_elastic));
    const Mat3 P = elastic + pass.m_damping * viscous + initial + torqueBalance(S, initial);
    if (pass.m_tangent) return passNonlinear(pass, b, lane, strains, initial + torqueBalance(S, initial));
    storeCorners(timesTranspose(-1.0 * (R * P), DmInverse), lane, pass.m_force[b]);

    WarpedBlock<Real>& warped = pass.m_warped[b];
    const Mat3 g = timesTranspose(DmInverse, R);
    for (int k = 0; k < 9; ++k) warped.m_gradient[k][lane] = static_cast<Real>(g(k / 3, k % 3));
    storeTension(pass.m_tensionFactor * (R * timesTranspose(positivePart(elastic + initial), R)), lane, warped);
}

// sum over b of p_b g'_b^T.
template <class Real>
Mat3 gradientOf(const ElementProduct<Real>& product, int b, int lane, Mat3& g)
{
    for (int k = 0; k < 9; ++k) g(k / 3, k % 3) = product.m_warped[b].m_gradient[k][lane];
    return ReferenceElement<Real>{product.m_elements->m_blocks[b], lane}.edges(product.m_p) * g;
}

template <class Real>
double dilatationOf(const ElementProduct<Real>& product, int b, int lane)
{
    Mat3 g;
    return trace(gradientOf(product, b, lane, g));
}

template <class Real>
void multiplyElement(const ElementProduct<Real>& product, int b, int lane, double dilatation)
{
    const WarpedBlock<Real>& warped = product.m_warped[b];
    const auto& t = warped.m_tension;
    Mat3 g;
    const Mat3 H = gradientOf(product, b, lane, g);
    const Mat3 T = {{{t[0][lane], t[5][lane], t[4][lane]},
                     {t[5][lane], t[1][lane], t[3][lane]},
                     {t[4][lane], t[3][lane], t[2][lane]}}};
    const ReferenceElement<Real> element = {product.m_elements->m_blocks[b], lane};
    Mat3 P = product.m_stiffnessFactor * element.hooke(H, dilatation) + H * T;
    if (product.m_tangent)
    {
        const auto& c = product.m_tangent[b].m_cofactor;
        const Mat3 C = {{{c[0][lane], c[5][lane], c[4][lane]},
                         {c[5][lane], c[1][lane], c[3][lane]},
                         {c[4][lane], c[3][lane], c[2][lane]}}};
        const double mu = element.m_block.m_muVolume[lane];
        P = product.m_stiffnessFactor *
                (mu * (H + transpose(H)) + product.m_tangent[b].m_bulk[lane] * trace(transposeTimes(C, H)) * C) +
            H * T;
    }
    storeCorners(timesTranspose(P, g), lane, product.m_out[b]);
}

}  // namespace

template <class Real>
void runElementPass(const ElementPass<Real>& pass, Range pieces)
{
    const ElementBlocks<Real>& elements = *pass.m_elements;
    for (int p = pieces.m_begin; p < pieces.m_end; ++p)
        for (int lane = 0; lane < kLanes; ++lane)
        {
            const PatchGroup group = elements.hasPatches() ? elements.m_groups[p] : PatchGroup{p, 1};
            std::array<Strains, ElementPatches::kMax> strains;
            double dilatation = 0, rate = 0;
            for (int k = 0; k < group.m_blocks; ++k)
            {
                const int b = group.m_firstBlock + k;
                const double share = elements.hasPatches() ? elements.m_share[b].m_lane[lane] : 1;
                strains[k] = strainsOf(pass, b, lane);
                dilatation += share * trace(strains[k].m_elastic);
                rate += share * trace(strains[k].m_viscous);
            }
            for (int k = 0; k < group.m_blocks; ++k)
                passElement(pass, group.m_firstBlock + k, lane, strains[k], dilatation, rate);
        }
}

template <class Real>
void runElementProduct(const ElementProduct<Real>& product, Range pieces)
{
    const ElementBlocks<Real>& elements = *product.m_elements;
    for (int p = pieces.m_begin; p < pieces.m_end; ++p)
        for (int lane = 0; lane < kLanes; ++lane)
        {
            const PatchGroup group = elements.hasPatches() ? elements.m_groups[p] : PatchGroup{p, 1};
            double dilatation = 0;
            for (int b = group.m_firstBlock; b < group.m_firstBlock + group.m_blocks; ++b)
                dilatation +=
                    (elements.hasPatches() ? elements.m_share[b].m_lane[lane] : 1) * dilatationOf(product, b, lane);
            for (int b = group.m_firstBlock; b < group.m_firstBlock + group.m_blocks; ++b)
                multiplyElement(product, b, lane, dilatation);
        }
}

template <class Real>
void runElementStrains(const ElementStrains<Real>& strains, Range blocks)
{
    for (int b = blocks.m_begin; b < blocks.m_end; ++b)
        for (int lane = 0; lane < kLanes; ++lane)
        {
            const ElementBlock<Real>& block = strains.m_elements->m_blocks[b];
            Mat3 DmInverse, Dm;
            for (int k = 0; k < 9; ++k)
            {
                DmInverse(k / 3, k % 3) = block.m_DmInverse[k][lane];
                Dm(k / 3, k % 3) = block.m_Dm[k][lane];
            }
            const std::int32_t* node = block.m_node[lane];
            const auto edge = [&](int a)
            {
                const PaddedVec3 &to = strains.m_x[node[a]], &from = strains.m_x[node[0]];
                return Vec3{to.x - from.x, to.y - from.y, to.z - from.z};
            };
            const Mat3 Ds = Mat3::fromColumns(edge(1), edge(2), edge(3));
            Quaternion& q = strains.m_rotation[b * kLanes + lane];
            const Mat3 R = polarRotation(Ds * DmInverse, toMatrix(q));
            q = rounded(toQuaternion(R));
            const SymmetricTensor E = symmetricPart(transposeTimes(R, (Ds - R * Dm) * DmInverse));
            const double entries[6] = {E.xx, E.yy, E.zz, E.yz, E.xz, E.xy};
            for (int k = 0; k < 6; ++k) strains.m_strain[b].m_entry[k][lane] = static_cast<Real>(entries[k]);
        }
}

template void runElementPass(const ElementPass<float>&, Range);
template void runElementPass(const ElementPass<double>&, Range);
template void runElementProduct(const ElementProduct<float>&, Range);
template void runElementProduct(const ElementProduct<double>&, Range);
template void runElementStrains(const ElementStrains<float>&, Range);
template void runElementStrains(const ElementStrains<double>&, Range);

}  // namespace reference
}  // namespace bullet_fem
