// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/compliance/working_set.h"

#include <algorithm>

namespace bullet_fem
{
namespace
{

constexpr double kMaxLeft = 0.25;  // share of sides that may have left before the set is compacted

}  // namespace

void WorkingSet::reset(int ends, int components)
{
    m_ends.clear();
    m_rigid.clear();
    m_rigid.reserve(ends);
    m_motion.assign(components, RigidMotion());
    m_wanted.clear();
    m_packed = 0;
    m_place.assign(ends, -1);
    m_stride = 0;
    const std::size_t most = padded(3 * static_cast<std::size_t>(ends), kResponsePadding);
    if (m_W.size() < most * most) m_W.resize(most * most);
    m_velocity.assign(most, 0);
    m_ends.reserve(ends);
    m_wanted.reserve(ends);
    m_swept.reserve(most + 6 * m_motion.size());
    for (std::vector<double>& delta : m_sweptDelta) delta.reserve(most + 6 * m_motion.size());
}

void WorkingSet::choose()
{
    std::fill(m_wanted.begin(), m_wanted.end(), static_cast<unsigned char>(0));
}

void WorkingSet::add(int e)
{
    if (m_place[e] < 0)
    {
        m_place[e] = static_cast<int>(m_ends.size());
        m_ends.push_back(e);
        m_wanted.push_back(1);
    }
    m_wanted[m_place[e]] = 1;
}

void WorkingSet::put(const Vec3& v, std::vector<double>& values, std::size_t place)
{
    for (int i = 0; i < 3; ++i) values[3 * place + i] = v[i];
}

void WorkingSet::pack(PointCompliance& points, const std::vector<double>& slotVelocity)
{
    const auto left = std::count(m_wanted.begin(), m_wanted.end(), static_cast<unsigned char>(0));
    if (static_cast<double>(left) > kMaxLeft * static_cast<double>(m_ends.size())) dropThoseThatLeft();
    if (order() > m_stride) widen();
    for (; m_packed < m_ends.size(); ++m_packed)
    {
        const int f = m_ends[m_packed];
        m_rigid.resize(m_packed);
        m_rigid.push_back(points.rigid(f));
        put(Vec3(), m_velocity, m_packed);
        put(points.read(f, slotVelocity) - velocity(f), m_velocity, m_packed);
        for (std::size_t k = 0; k <= m_packed; ++k)
        {
            const Mat3 w = points.elasticBlock(m_ends[k], f);
            float *column = block(k, m_packed), *mirrored = block(m_packed, k);
            for (int c = 0; c < 3; ++c)
                for (int i = 0; i < 3; ++i)
                    column[c * m_stride + i] = mirrored[i * m_stride + c] = static_cast<float>(w(i, c));
        }
    }
}

// With room for some new sides; compact, because sweeps read all of it repeatedly.
std::size_t WorkingSet::wantedStride(std::size_t ends) const
{
    return padded(3 * std::min(ends + ends / 4 + 2, m_place.size()), kResponsePadding);
}

void WorkingSet::widen()
{
    const std::size_t before = m_stride;
    m_stride = wantedStride(m_ends.size());
    for (std::size_t column = 3 * m_packed; column-- > 1;)
        std::copy_backward(&m_W[column * before], &m_W[column * before] + 3 * m_packed,
                           &m_W[column * m_stride] + 3 * m_packed);
}

// Columns, and rows within them, only move towards the front.
void WorkingSet::dropThoseThatLeft()
{
    const auto all =
        static_cast<std::size_t>(std::count(m_wanted.begin(), m_wanted.end(), static_cast<unsigned char>(1)));
    const std::size_t stride = std::min(m_stride, wantedStride(all));
    std::size_t kept = 0, packed = 0;
    for (std::size_t f = 0; f < m_ends.size(); ++f)
    {
        m_place[m_ends[f]] = m_wanted[f] ? static_cast<int>(kept) : -1;
        if (!m_wanted[f]) continue;
        if (f < m_packed)
        {
            put(at(m_velocity, static_cast<int>(f)), m_velocity, kept);
            m_rigid[kept] = m_rigid[f];
            for (int c = 0; c < 3; ++c)
            {
                const float* from = &m_W[(3 * f + c) * m_stride];
                float* to = &m_W[(3 * kept + c) * stride];
                for (std::size_t e = 0; e < m_packed; ++e, from += 3)
                {
                    if (!m_wanted[e]) continue;
                    for (int i = 0; i < 3; ++i) to[i] = from[i];
                    to += 3;
                }
            }
            ++packed;
        }
        m_ends[kept++] = m_ends[f];
    }
    m_ends.resize(kept);
    m_wanted.assign(kept, 1);
    m_packed = packed;
    m_stride = stride;
}

void WorkingSet::load(const PointCompliance& points, const std::vector<double>& slotVelocity)
{
    std::fill(m_motion.begin(), m_motion.end(), RigidMotion());
    for (std::size_t k = 0; k < m_ends.size(); ++k) put(points.read(m_ends[k], slotVelocity), m_velocity, k);
}

void WorkingSet::noteSweep(int slot, bool first)
{
    const std::size_t size = 3 * m_ends.size() + 6 * m_motion.size();
    if (first)
        for (std::vector<double>& delta : m_sweptDelta) delta.assign(size, 0.0);
    m_swept.resize(size);
    forEachValue(
        [&](double value, std::size_t k)
        {
            if (!first) m_sweptDelta[slot][k] = value - m_swept[k];
            m_swept[k] = value;
        });
}

void WorkingSet::mixSweeps(const std::array<double, kMixed>& shares)
{
    forEachValue(
        [&](double& value, std::size_t k)
        {
            for (int j = 0; j < kMixed; ++j) value -= shares[j] * m_sweptDelta[j][k];
        });
}

}  // namespace bullet_fem
