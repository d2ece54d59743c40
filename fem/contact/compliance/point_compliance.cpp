// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/compliance/point_compliance.h"

#include <algorithm>

#include "fem/body/step_scratch.h"
#include "fem/contact/compliance/compliance_cache.h"
#include "fem/contact/compliance/compliance_kernel.h"
#include "fem/factor/rest_factor.h"
#include "fem/factor/rest_modes.h"
#include "fem/solve/warped_system.h"

namespace bullet_fem
{
namespace
{

constexpr std::size_t kTile = 16;  // tile of a transposition, which fits in the cache

void growTo(std::vector<float>& values, std::size_t size)
{
    if (values.size() < size) values.resize(size);
}

}  // namespace

void PointCompliance::clear(std::size_t nodes)
{
    m_first.assign(1, 0);
    m_weight.clear();
    m_slot.clear();
    m_own = 0;
    m_slotOfNode.resize(nodes);
}

void PointCompliance::add(const SurfacePoint& point)
{
    for (int a = 0; a < point.m_count; ++a)
    {
        if (point.m_weights[a] == 0) continue;
        m_weight.push_back(point.m_weights[a]);
        m_slot.push_back(point.m_nodes[a]);
    }
    m_first.push_back(static_cast<int>(m_slot.size()));
}

void PointCompliance::addOwn()
{
    ++m_own;
    m_weight.push_back(1);
    m_slot.push_back(-1);
    m_first.push_back(static_cast<int>(m_slot.size()));
}

void PointCompliance::numberSlots()
{
    constexpr int kUnused = -1, kUsed = 0;
    std::fill(m_slotOfNode.begin(), m_slotOfNode.end(), kUnused);
    for (int node : m_slot)
        if (node >= 0) m_slotOfNode[node] = kUsed;
    m_nodes.clear();
    for (std::size_t node = 0; node < m_slotOfNode.size(); ++node)
    {
        if (m_slotOfNode[node] == kUnused) continue;
        m_slotOfNode[node] = static_cast<int>(m_nodes.size());
        m_nodes.push_back(static_cast<int>(node));
    }
    int own = static_cast<int>(m_nodes.size());
    for (int& slot : m_slot) slot = slot >= 0 ? m_slotOfNode[slot] : own++;
}

void PointCompliance::request(const ContactBody& body, const Threads* threads)
{
    body.m_compliance->request(m_nodes, threads);
}

void PointCompliance::form(const ContactBody& body, double scale, const std::vector<RigidMomentum::Share>& shares)
{
    m_rows = order();
    growTo(m_N, m_rows * 3 * slots());
    turnNodes(body);
    formNodeColumns(body, scale);
    if (m_own > 0) std::fill(column(3 * m_nodes.size()), column(3 * slots()), 0.f);
    mirrorNodeColumns();
    setRigid(body, shares);
}

void PointCompliance::scaleElastic(double factor)
{
    for (std::size_t k = 0; k < 3 * m_rows * static_cast<std::size_t>(slots()); ++k)
        m_N[k] = static_cast<float>(factor * m_N[k]);
}

void PointCompliance::setRigid(const ContactBody& body, const std::vector<RigidMomentum::Share>& shares)
{
    const RigidMomentum& momentum = body.m_body->m_workspace.scratch().m_momentum;
    m_rigidOfSlot.assign(slots(), RigidSide());
    for (std::size_t t = 0; t < shares.size(); ++t) m_rigidOfSlot[t] = {shares[t], momentum.responseTo(shares[t])};
    m_rigid.assign(points(), RigidSide());
    for (int p = 0; p < points(); ++p)
        for (int k = m_first[p]; k < m_first[p + 1]; ++k) m_rigid[p].add(m_weight[k], m_rigidOfSlot[m_slot[k]]);
}

void PointCompliance::addRigid(const std::vector<RigidMotion>& motions, std::vector<double>& slotValues) const
{
    for (int slot = 0; slot < slots(); ++slot)
    {
        const RigidSide& side = m_rigidOfSlot[slot];
        if (side.component() < 0) continue;
        const Vec3 v = side.velocity(motions[side.component()]);
        for (int i = 0; i < 3; ++i) slotValues[3 * static_cast<std::size_t>(slot) + i] += v[i];
    }
}

void PointCompliance::set(std::size_t i, std::size_t j, double value)
{
    column(j)[i] = column(i)[j] = static_cast<float>(value);
}

void PointCompliance::setResponse(std::size_t slot, std::size_t j, const Vec3& velocity)
{
    for (std::size_t i = 3 * slot; i < 3 * slot + 3; ++i)
        if (slot != j / 3 || i >= j) set(i, j, velocity[static_cast<int>(i - 3 * slot)]);
}

Vec3 PointCompliance::read(int point, const std::vector<double>& slotValues) const
{
    Vec3 sum;
    for (int k = m_first[point]; k < m_first[point + 1]; ++k)
    {
        const double* value = &slotValues[3 * static_cast<std::size_t>(m_slot[k])];
        sum += m_weight[k] * Vec3{value[0], value[1], value[2]};
    }
    return sum;
}

Mat3 PointCompliance::elasticBlock(int e, int f) const
{
    Mat3 w;
    for (int k = m_first[e]; k < m_first[e + 1]; ++k)
        for (int l = m_first[f]; l < m_first[f + 1]; ++l)
        {
            const double weight = m_weight[k] * m_weight[l];
            for (int c = 0; c < 3; ++c)
            {
                const float* to = column(3 * static_cast<std::size_t>(m_slot[l]) + c) + 3 * m_slot[k];
                for (int i = 0; i < 3; ++i) w(i, c) += weight * to[i];
            }
        }
    return w;
}

void PointCompliance::turnNodes(const ContactBody& body)
{
    const WarpedPreconditioner P(*body.m_body);
    const std::vector<unsigned char>& fixed = body.m_body->m_state.m_fixed;
    m_offsets.assign(m_nodes.size(), 0);
    m_rotations.assign(3 * kColumnOfRotation * m_nodes.size(), 0.f);
    for (std::size_t t = 0; t < m_nodes.size(); ++t)
    {
        m_offsets[t] = body.m_compliance->offset(m_nodes[t]);
        if (fixed[m_nodes[t]]) continue;
        const Mat3 R = P.rotation(m_nodes[t]);
        float* columns = &m_rotations[3 * kColumnOfRotation * t];
        for (int k = 0; k < 9; ++k) columns[kColumnOfRotation * (k % 3) + k / 3] = static_cast<float>(R(k / 3, k % 3));
    }
}

// The lower triangle of N, with full diagonal blocks.
void PointCompliance::formNodeColumns(const ContactBody& body, double scale)
{
    const RestFactor& factor = body.m_body->m_model->factor();
    RestColumn source;
    source.m_offsets = m_offsets.data();
    source.m_rotations = m_rotations.data();
    source.m_end = m_nodes.size();
    source.m_stride = m_rows;
    for (std::size_t t = 0; t < m_nodes.size(); ++t)
    {
        const int node = m_nodes[t];
        source.m_blocks = body.m_compliance->column(node);
        source.m_first = t;
        const float* columns = &m_rotations[3 * kColumnOfRotation * t];
        for (int k = 0; k < 9; ++k)
            source.m_source[k] = static_cast<float>(scale) * columns[kColumnOfRotation * (k % 3) + k / 3];
        turnColumn(source, column(3 * t));
        addRestModes(body, scale, t);
        if (factor.position(node) >= 0 || body.m_body->m_state.m_fixed[node]) continue;
        for (int c = 0; c < 3; ++c) column(3 * t + c)[3 * t + c] = static_cast<float>(scale / factor.diagonal(node));
    }
}

// The rest modes of components that had other fixed nodes when the factor was built, and cannot move as a whole now.
void PointCompliance::addRestModes(const ContactBody& body, double scale, std::size_t slot)
{
    const BodyModel& model = *body.m_body->m_model;
    const int component = model.mesh().nodeComponent()[m_nodes[slot]];
    if (!model.restModes().components()[component].moves() ||
        body.m_body->m_workspace.scratch().m_momentum.isMovable(component))
        return;
    const WarpedPreconditioner P(*body.m_body);
    const std::vector<unsigned char>& fixed = body.m_body->m_state.m_fixed;
    const Mat3 turned = scale * transpose(P.rotation(m_nodes[slot]));
    for (std::size_t t = slot; t < m_nodes.size() && !fixed[m_nodes[slot]]; ++t)
    {
        if (fixed[m_nodes[t]]) continue;
        const Mat3 block = P.rotation(m_nodes[t]) * model.restModes().response(m_nodes[t], m_nodes[slot]) * turned;
        for (int i = 0; i < 3; ++i)
            for (int c = 0; c < 3; ++c) column(3 * slot + c)[3 * t + i] += static_cast<float>(block(i, c));
    }
}

// Symmetrised, because rounding errors of single precision would add energy in sweeps.
void PointCompliance::mirrorNodeColumns()
{
    const std::size_t order = 3 * m_nodes.size();
    for (std::size_t first = 0; first < order; first += kTile)
        for (std::size_t i = first; i < order; ++i)
            for (std::size_t j = first; j < std::min(i, first + kTile); ++j) column(i)[j] = column(j)[i];
}

}  // namespace bullet_fem
