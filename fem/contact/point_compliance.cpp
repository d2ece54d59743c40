// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/point_compliance.h"

#include <algorithm>

#include "fem/contact/compliance_cache.h"
#include "fem/contact/compliance_kernel.h"
#include "fem/factor/rest_factor.h"
#include "fem/warped_system.h"

namespace bullet_fem
{
namespace
{

constexpr std::size_t kTile = 16;  // of a transposition: what it reads and writes stays in the cache

std::size_t padded(std::size_t count, std::size_t multiple)
{
    return (count + multiple - 1) / multiple * multiple;
}

}  // namespace

void PointCompliance::Columns::resize(std::size_t rows, std::size_t columns)
{
    m_rows = rows;
    if (m_values.size() < rows * columns) m_values.resize(rows * columns);
}

void PointCompliance::clear(std::size_t nodes)
{
    m_firstWeight.assign(1, 0);
    m_weight.clear();
    m_node.clear();
    m_placeOfNode.resize(nodes);
}

void PointCompliance::add(const SurfacePoint& point)
{
    for (int a = 0; a < point.m_count; ++a)
    {
        if (point.m_weights[a] == 0) continue;
        m_weight.push_back(static_cast<float>(point.m_weights[a]));
        m_node.push_back(point.m_nodes[a]);
    }
    addEmpty();
}

void PointCompliance::form(const ContactBody& body, double scale, DenseCompliance& W)
{
    listNodes();
    body.m_compliance->request(m_nodes);
    turnNodes(body);
    formNodeColumns(body, scale);
    mirrorNodeColumns();

    const std::size_t order = 3 * static_cast<std::size_t>(points()), rows = m_N.m_rows;
    m_half.resize(rows, padded(order, kTile));
    for (int e = 0; e < points(); ++e)
        for (int c = 0; c < 3; ++c) sumOverNodes(m_N, e, c, m_half.column(3 * e + c));
    m_transposedHalf.resize(padded(order, kTile), rows);
    for (std::size_t j = 0; j < order; j += kTile)
        for (std::size_t i = 0; i < rows; i += kTile)
            for (std::size_t b = i; b < i + kTile; ++b)
                for (std::size_t a = j; a < j + kTile; ++a) m_transposedHalf.column(b)[a] = m_half.column(a)[b];
    for (int e = 0; e < points(); ++e)
        for (int c = 0; c < 3; ++c) sumOverNodes(m_transposedHalf, e, c, W.column(3 * e + c));
}

void PointCompliance::listNodes()
{
    m_nodes.assign(m_node.begin(), m_node.end());
    std::sort(m_nodes.begin(), m_nodes.end());
    m_nodes.erase(std::unique(m_nodes.begin(), m_nodes.end()), m_nodes.end());
    for (std::size_t t = 0; t < m_nodes.size(); ++t) m_placeOfNode[m_nodes[t]] = static_cast<int>(t);
    for (int& node : m_node) node = m_placeOfNode[node];
}

void PointCompliance::turnNodes(const ContactBody& body)
{
    const WarpedPreconditioner P(*body.m_body);
    const std::vector<unsigned char>& fixed = body.m_body->m_state.m_fixed;
    const std::size_t room = padded(m_nodes.size(), kNodePadding);
    m_offsets.assign(room, 0);
    m_rotations.assign(9 * room, 0.f);
    for (std::size_t t = 0; t < m_nodes.size(); ++t)
    {
        m_offsets[t] = body.m_compliance->offset(m_nodes[t]);
        if (fixed[m_nodes[t]]) continue;
        const Mat3 R = P.rotation(m_nodes[t]);
        for (int k = 0; k < 9; ++k) m_rotations[k * room + t] = static_cast<float>(R(k / 3, k % 3));
    }
}

// The lower triangle of N, and more of it.
void PointCompliance::formNodeColumns(const ContactBody& body, double scale)
{
    const RestFactor& factor = body.m_body->m_model->factor();
    const std::size_t room = m_offsets.size();
    RestColumn column;
    column.m_offsets = m_offsets.data();
    column.m_rotations = m_rotations.data();
    column.m_padded = room;
    m_N.resize(3 * room, 3 * m_nodes.size());
    for (std::size_t t = 0; t < m_nodes.size(); ++t)
    {
        const int node = m_nodes[t];
        column.m_blocks = body.m_compliance->column(node);
        column.m_first = t / kNodePadding * kNodePadding;
        for (int k = 0; k < 9; ++k) column.m_source[k] = static_cast<float>(scale) * m_rotations[k * room + t];
        turnColumn(column, m_N.column(3 * t));
        if (factor.position(node) >= 0 || body.m_body->m_state.m_fixed[node]) continue;
        for (int c = 0; c < 3; ++c)
            m_N.column(3 * t + c)[3 * t + c] = static_cast<float>(scale / factor.diagonal(node));
    }
}

// What single precision left asymmetric would feed energy to the sweeps.
void PointCompliance::mirrorNodeColumns()
{
    const std::size_t order = 3 * m_nodes.size();
    for (std::size_t first = 0; first < order; first += kTile)
        for (std::size_t i = first; i < order; ++i)
            for (std::size_t j = first; j < std::min(i, first + kTile); ++j) m_N.column(i)[j] = m_N.column(j)[i];
}

// A point's sum over its nodes' columns.
void PointCompliance::sumOverNodes(Columns& of, int point, int axis, float* sum)
{
    const int first = m_firstWeight[point], count = m_firstWeight[point + 1] - first;
    m_terms.clear();
    for (int k = first; k < first + count; ++k) m_terms.push_back(of.column(3 * m_node[k] + axis));
    const std::size_t size = &of == &m_N ? m_N.m_rows : 3 * static_cast<std::size_t>(points());
    addWeighted({m_terms.data(), m_weight.data() + first, count}, size, sum);
}

}  // namespace bullet_fem
