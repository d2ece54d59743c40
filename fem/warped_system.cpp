// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/warped_system.h"

#include <algorithm>

#include "fem/factor/rest_factor.h"
#include "fem/rotation.h"
#include "fem/step_scratch.h"
#include "fem/warped_elements.h"

namespace bullet_fem
{

void WarpedSystem::applyUnconstrained(const std::vector<Vec3>& in, std::vector<Vec3>& out) const
{
    const RestShape& shape = m_body.m_model->shape();
    const BodyState& state = m_body.m_state;
    const double h = m_step, alpha = shape.m_material.m_massDamping + m_body.m_loads.m_massDamping;
    const std::array<double, 2> factors = {h * h + h * shape.m_material.m_stiffnessDamping, h * h};
    for (std::size_t i = 0; i < in.size(); ++i) out[i] = (1 + h * alpha) * state.m_mass[i] * in[i];
    addStiffnessProduct(shape, state.m_elementRotation, m_body.m_workspace.scratch().m_tension, factors, in, out);
}

void WarpedSystem::apply(const std::vector<Vec3>& in, std::vector<Vec3>& out) const
{
    applyUnconstrained(in, out);
    const std::vector<unsigned char>& fixed = m_body.m_state.m_fixed;
    for (std::size_t i = 0; i < out.size(); ++i)
        if (fixed[i]) out[i] = {};
}

void WarpedPreconditioner::apply(const std::vector<Vec3>& in, std::vector<Vec3>& out) const
{
    const RestFactor& factor = m_body.m_model->factor();
    const std::vector<unsigned char>& fixed = m_body.m_state.m_fixed;
    std::vector<float>& y = m_body.m_workspace.scratch().m_factorVector;

    // Scaled to order one, so that the range of single precision does not matter.
    double largest = 0;
    for (const Vec3& r : in) largest = std::max({largest, std::fabs(r.x), std::fabs(r.y), std::fabs(r.z)});
    const double down = largest > 0 ? 1 / largest : 0;
    for (std::size_t i = 0; i < in.size(); ++i)
    {
        const int k = factor.position(static_cast<int>(i));
        if (k < 0) continue;
        const Vec3 q = fixed[i] ? Vec3() : down * transposeTimes(rotation(static_cast<int>(i)), in[i]);
        for (int c = 0; c < 3; ++c) y[3 * k + c] = static_cast<float>(q[c]);
    }
    factor.lower().solve<1>(y.data(), m_body.m_workspace.scratch().m_factorScratch.data());
    for (std::size_t i = 0; i < in.size(); ++i)
    {
        const int k = factor.position(static_cast<int>(i));
        if (fixed[i])
            out[i] = {};
        else if (k < 0)
            out[i] = (1 / factor.diagonal(static_cast<int>(i))) * in[i];
        else
            out[i] = largest * (rotation(static_cast<int>(i)) * Vec3{y[3 * k], y[3 * k + 1], y[3 * k + 2]});
    }
}

void updateWarpRotations(Body& body)
{
    const std::vector<Tet>& tets = body.m_model->mesh().tets();
    BodyState& state = body.m_state;
    std::vector<Mat3>& sum = body.m_workspace.scratch().m_rotationSum;
    std::fill(sum.begin(), sum.end(), Mat3());
    Mat3 total;
    for (std::size_t e = 0; e < tets.size(); ++e)
    {
        const Mat3 weighted = body.m_model->shape().m_elements[e].m_volume * state.m_elementRotation[e];
        for (int node : tets[e]) sum[node] += weighted;
        total += weighted;
    }
    state.m_bodyRotation = polarRotation(total, state.m_bodyRotation);
    for (std::size_t i = 0; i < sum.size(); ++i)
        state.m_nodeRotation[i] = polarRotation(sum[i], state.m_nodeRotation[i]);
}

}  // namespace bullet_fem
