// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <cstddef>

#include "benchmarks/reference/positive_part.h"
#include "bullet_fem/fem/common/symmetric.h"
#include "fem/scenes/reference_elements.h"
#include "fem/scenes/reference_math.h"

namespace bullet_fem
{
namespace reference
{
namespace
{

struct ReadStrain
{
    Mat3 m_strain;
    double m_theta;
};

template <class Real>
void storeStrain(const Mat3& A, double theta, int lane, StrainQuads<Real>& out)
{
    const double entries[2][4] = {{A(0, 0), A(1, 1), A(2, 2), A(1, 2) + A(2, 1)},
                                  {A(0, 2) + A(2, 0), A(0, 1) + A(1, 0), theta, 0}};
    for (int k = 0; k < 8; ++k) out.m_quad[k / 4][lane][k % 4] = static_cast<Real>(entries[k / 4][k % 4]);
}

ReadStrain strainOfQuads(const double (&s)[2][4])
{
    const double yz = 0.5 * s[0][3], xz = 0.5 * s[1][0], xy = 0.5 * s[1][1];
    return {{{{s[0][0], xy, xz}, {xy, s[0][1], yz}, {xz, yz, s[0][2]}}}, s[1][2]};
}

template <class Real>
ReadStrain ownStrain(const SmoothedStrain<Real>& strain, int b, int lane)
{
    double s[2][4];
    for (int k = 0; k < 8; ++k) s[k / 4][k % 4] = strain.m_element[b].m_quad[k / 4][lane][k % 4];
    return strainOfQuads(s);
}

// theta is that of the element itself.
template <class Real>
ReadStrain smoothedStrain(const EdgeSmoothing<Real>& smoothing, const SmoothedStrain<Real>& strain, int b, int lane)
{
    const typename EdgeSmoothing<Real>::BlockShares& lanes = smoothing.m_lanes[b];
    double s[2][4];
    for (int k = 0; k < 8; ++k)
    {
        double sum = 0;
        for (const int domain : lanes.m_domain[lane]) sum += strain.m_domain[domain].m_quad[k / 4][k % 4];
        s[k / 4][k % 4] =
            lanes.m_own[lane] * strain.m_element[b].m_quad[k / 4][lane][k % 4] + lanes.m_ofDomain[lane] * sum;
    }
    return {strainOfQuads(s).m_strain, ownStrain(strain, b, lane).m_theta};
}

// Calls visit(k, b, share) for the elements of a lane of a piece: block b, with its share of the patch's volume.
template <class Real, class Visit>
void visitPatch(const ElementBlocks<Real>& elements, int piece, int lane, const Visit& visit)
{
    const PatchGroup& group = elements.m_groups[piece];
    for (int k = 0; k < group.m_blocks; ++k)
        visit(k, group.m_firstBlock + k, elements.m_share[group.m_firstBlock + k].m_lane[lane]);
}

template <class Real>
Mat3 stressOf(const ElementBlocks<Real>& elements, int b, int lane, const ReadStrain& s)
{
    return ReferenceElement<Real>{elements.m_blocks[b], lane}.hooke(s.m_strain, s.m_theta);
}

template <class Real>
Mat3 matrixOf(const Real (*entries)[kLanes], int lane)
{
    Mat3 A;
    for (int k = 0; k < 9; ++k) A(k / 3, k % 3) = entries[k][lane];
    return A;
}

template <class Real>
void passElement(const SmoothedPass<Real>& pass, int b, int lane)
{
    const ElementPass<Real>& plain = pass.m_elements;
    const ElementBlocks<Real>& elements = *plain.m_elements;
    const Mat3 initial = initialStress(plain, b, lane);
    const Mat3 elastic = stressOf(elements, b, lane, smoothedStrain(*pass.m_smoothing, pass.m_elastic, b, lane));
    const Mat3 damped = stressOf(elements, b, lane, smoothedStrain(*pass.m_smoothing, pass.m_damped, b, lane));
    const Mat3 S = Mat3::identity() + ownStrain(pass.m_elastic, b, lane).m_strain;
    const Mat3 P = damped + initial + torqueBalance(S, elastic + initial);
    const Mat3 R = matrixOf(pass.m_warped[b].m_rotation, lane);
    const ReferenceElement<Real> element = {elements.m_blocks[b], lane};
    storeCorners(-1.0 * (R * timesTranspose(P, element.DmInverse())), lane, plain.m_force[b]);
    const Mat3 T = plain.m_tensionFactor * positivePart(elastic + initial);
    const double entries[6] = {T(0, 0), T(1, 1), T(2, 2), T(1, 2), T(0, 2), T(0, 1)};
    for (int k = 0; k < 6; ++k) pass.m_warped[b].m_tension[k][lane] = static_cast<Real>(entries[k]);
}

}  // namespace

template <class Real>
void findStrains(const SmoothedPass<Real>& pass, Range pieces)
{
    const ElementBlocks<Real>& elements = *pass.m_elements.m_elements;
    for (int p = pieces.m_begin; p < pieces.m_end; ++p)
        for (int lane = 0; lane < kLanes; ++lane)
        {
            Mat3 elastic[ElementPatches::kMax], damped[ElementPatches::kMax];
            double theta = 0, dampedTheta = 0;
            visitPatch(elements, p, lane,
                       [&](int k, int b, double share)
                       {
                           const Strains s = strainsOf(pass.m_elements, b, lane);
                           for (int i = 0; i < 9; ++i)
                               pass.m_warped[b].m_rotation[i][lane] = static_cast<Real>(s.m_R(i / 3, i % 3));
                           elastic[k] = s.m_elastic;
                           damped[k] = s.m_elastic + pass.m_elements.m_damping * s.m_viscous;
                           theta += share * trace(elastic[k]);
                           dampedTheta += share * trace(damped[k]);
                       });
            visitPatch(elements, p, lane,
                       [&](int k, int b, double)
                       {
                           storeStrain(0.5 * (elastic[k] + transpose(elastic[k])), theta, lane,
                                       pass.m_elastic.m_element[b]);
                           storeStrain(0.5 * (damped[k] + transpose(damped[k])), dampedTheta, lane,
                                       pass.m_damped.m_element[b]);
                       });
        }
}

template <class Real>
void findStrains(const SmoothedProduct<Real>& product, Range pieces)
{
    const ElementBlocks<Real>& elements = *product.m_elements.m_elements;
    for (int p = pieces.m_begin; p < pieces.m_end; ++p)
        for (int lane = 0; lane < kLanes; ++lane)
        {
            Mat3 strain[ElementPatches::kMax];
            double theta = 0;
            visitPatch(elements, p, lane,
                       [&](int k, int b, double share)
                       {
                           const ReferenceElement<Real> element = {elements.m_blocks[b], lane};
                           const Mat3 H = element.edges(product.m_elements.m_p) * element.DmInverse();
                           strain[k] = transposeTimes(matrixOf(product.m_warped[b].m_rotation, lane), H);
                           theta += share * trace(strain[k]);
                           const auto& t = product.m_warped[b].m_tension;
                           const Mat3 T = {{{t[0][lane], t[5][lane], t[4][lane]},
                                            {t[5][lane], t[1][lane], t[3][lane]},
                                            {t[4][lane], t[3][lane], t[2][lane]}}};
                           const Mat3 HT = H * T;
                           for (int i = 0; i < 9; ++i)
                               product.m_tension[b].m_entry[i][lane] = static_cast<Real>(HT(i / 3, i % 3));
                       });
            visitPatch(elements, p, lane,
                       [&](int k, int b, double)
                       { storeStrain(strain[k], theta, lane, product.m_strain.m_element[b]); });
        }
}

template <class Real>
void averageStrains(const EdgeSmoothing<Real>& smoothing, const SmoothedStrain<Real>& strain, Range domains)
{
    const Real* quads = &strain.m_element->m_quad[0][0][0];
    for (int d = domains.m_begin; d < domains.m_end; ++d)
        for (int k = 0; k < 8; ++k)
        {
            double sum = 0;
            for (int i = smoothing.m_start[d]; i < smoothing.m_start[d + 1]; ++i)
            {
                const std::ptrdiff_t quad = smoothing.m_place[i] + k / 4 * kLanes;
                sum += static_cast<double>(smoothing.m_weight[i]) * static_cast<double>(quads[4 * quad + k % 4]);
            }
            strain.m_domain[d].m_quad[k / 4][k % 4] = static_cast<Real>(sum);
        }
}

template <class Real>
void findForces(const SmoothedPass<Real>& pass, Range blocks)
{
    for (int b = blocks.m_begin; b < blocks.m_end; ++b)
        for (int lane = 0; lane < kLanes; ++lane) passElement(pass, b, lane);
}

template <class Real>
void findForces(const SmoothedProduct<Real>& product, Range blocks)
{
    const ElementProduct<Real>& plain = product.m_elements;
    for (int b = blocks.m_begin; b < blocks.m_end; ++b)
        for (int lane = 0; lane < kLanes; ++lane)
        {
            const ReadStrain s = smoothedStrain(*product.m_smoothing, product.m_strain, b, lane);
            const Mat3 stress = plain.m_stiffnessFactor * stressOf(*plain.m_elements, b, lane, s);
            const Mat3 P =
                matrixOf(product.m_warped[b].m_rotation, lane) * stress + matrixOf(product.m_tension[b].m_entry, lane);
            const ReferenceElement<Real> element = {plain.m_elements->m_blocks[b], lane};
            storeCorners(timesTranspose(P, element.DmInverse()), lane, plain.m_out[b]);
        }
}

template void findStrains(const SmoothedPass<float>&, Range);
template void findStrains(const SmoothedPass<double>&, Range);
template void findStrains(const SmoothedProduct<float>&, Range);
template void findStrains(const SmoothedProduct<double>&, Range);
template void averageStrains(const EdgeSmoothing<float>&, const SmoothedStrain<float>&, Range);
template void averageStrains(const EdgeSmoothing<double>&, const SmoothedStrain<double>&, Range);
template void findForces(const SmoothedPass<float>&, Range);
template void findForces(const SmoothedPass<double>&, Range);
template void findForces(const SmoothedProduct<float>&, Range);
template void findForces(const SmoothedProduct<double>&, Range);

}  // namespace reference
}  // namespace bullet_fem
