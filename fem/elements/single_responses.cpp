// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/elements/single_responses.h"

namespace bullet_fem
{
namespace
{

template <class Real>
void storeMatrix(const Mat3& A, double scale, Real (*to)[kLanes], int lane)
{
    const double entries[6] = {A(0, 0), A(1, 1), A(2, 2), A(1, 2), A(0, 2), A(0, 1)};
    for (int k = 0; k < 6; ++k) to[k][lane] = static_cast<Real>(scale * entries[k]);
}

}  // namespace

template <class Real>
void SingleResponses<Real>::respond(const ElementBlocks<Real>& elements, const double* history, int first, int count)
{
    for (int lane = 0; lane < count; ++lane)
    {
        const SingleLane& single = elements.m_single[first + lane];
        if (!single.m_law) continue;
        const auto entry = [&](int k) { return static_cast<double>(m_strain[k][lane]); };
        const Mat3 e = {
            {{entry(0), entry(5), entry(4)}, {entry(5), entry(1), entry(3)}, {entry(4), entry(3), entry(2)}}};
        LawPoint point;
        point.m_lambda = static_cast<double>(m_lambda[lane]) / single.m_volume;
        point.m_mu = single.m_mu;
        point.m_pressure = static_cast<double>(m_pressure[lane]) / single.m_volume;
        point.m_size = single.m_size;
        point.m_constants = single.m_constants.data();
        if (single.m_law->m_historyCount > 0) point.m_history = history + single.m_history;
        const LawResponse response = single.m_law->m_respond(e, point);
        storeMatrix(response.m_stress, single.m_volume, m_stress, lane);
        storeMatrix(response.m_cofactor, 1, m_cofactor, lane);
        m_bulk[lane] = static_cast<Real>(single.m_volume * response.m_bulk);
        m_shear[lane] = static_cast<Real>(response.m_shear);
    }
}

template struct SingleResponses<float>;
template struct SingleResponses<double>;

}  // namespace bullet_fem
