// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/compliance/working_set.h"

#include <algorithm>

namespace bullet_fem
{
namespace
{

constexpr double kMaxLeft = 0.25;     // share of sides that may have left before the set is compacted
constexpr std::size_t kTogether = 4;  // responses that the kernel adds in one pass

}  // namespace

void WorkingSet::clear()
{
    m_ends.clear();
    m_wanted.clear();
    m_sides.clear();
    m_terms.clear();
    m_slots.clear();
    m_place.clear();
    m_packed = m_stride = 0;
}

void WorkingSet::reset(const PointCompliance& points, int components)
{
    clear();
    m_points = &points;
    m_place.assign(points.points(), -1);
    m_placeOfSlot.assign(points.slots(), -1);
    m_motion.assign(components, RigidMotion());
    const std::size_t most = points.order();
    if (m_W.size() < most * most) m_W.resize(most * most);
    m_velocity.assign(most, 0);
    m_ends.reserve(points.points());
    m_wanted.reserve(points.points());
    m_sides.reserve(points.points());
    m_terms.reserve(points.terms());
    m_slots.reserve(points.slots());
    m_isKept.reserve(points.slots());
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

void WorkingSet::respond(int e, const Vec3& impulse, std::vector<double>& values) const
{
    const Side& side = m_sides[m_place[e]];
    for (int t = side.m_first; t < side.m_end;)
    {
        std::array<Response, kTogether> responses;
        std::size_t count = 0;
        for (; t < side.m_end && count < kTogether; ++t)
            responses[count++] = {&m_W[3 * static_cast<std::size_t>(m_terms[t].m_place) * m_stride], m_stride,
                                  m_terms[t].m_weight * impulse};
        addResponses(responses.data(), count, order(), values.data());
    }
}

void WorkingSet::pack(const std::vector<double>& slotVelocity)
{
    const auto left = std::count(m_wanted.begin(), m_wanted.end(), static_cast<unsigned char>(0));
    if (static_cast<double>(left) > kMaxLeft * static_cast<double>(m_ends.size())) dropThoseThatLeft();
    while (m_sides.size() < m_ends.size()) findTerms(m_ends[m_sides.size()]);
    if (order() > m_stride) widen();
    while (m_packed < m_slots.size()) packSlot(slotVelocity);
}

// The terms of the next side; new slots join the set.
void WorkingSet::findTerms(int e)
{
    const int first = static_cast<int>(m_terms.size());
    m_points->forEachSlot(e,
                          [this](int slot, double weight)
                          {
                              int& place = m_placeOfSlot[slot];
                              if (place < 0)
                              {
                                  place = static_cast<int>(m_slots.size());
                                  m_slots.push_back(slot);
                              }
                              m_terms.push_back({place, weight});
                          });
    m_sides.push_back({first, static_cast<int>(m_terms.size()), m_points->rigid(e)});
}

// Columns and velocity of the next slot.
void WorkingSet::packSlot(const std::vector<double>& slotVelocity)
{
    const int slot = m_slots[m_packed];
    const Response whole = m_points->response(slot, {});
    for (int c = 0; c < 3; ++c)
    {
        const float* from = whole.m_columns + c * whole.m_stride;
        float* column = &m_W[(3 * m_packed + c) * m_stride];
        for (std::size_t k = 0; k <= m_packed; ++k)
            for (std::size_t i = 0; i < 3; ++i)
                column[3 * k + i] = m_W[(3 * k + i) * m_stride + 3 * m_packed + c] = from[3 * m_slots[k] + i];
    }
    const RigidSide& rigid = m_points->rigidOfSlot(slot);
    const Vec3 motion = rigid.component() >= 0 ? rigid.velocity(m_motion[rigid.component()]) : Vec3();
    for (std::size_t i = 0; i < 3; ++i)
        m_velocity[3 * m_packed + i] = slotVelocity[3 * slot + i] - motion[static_cast<int>(i)];
    ++m_packed;
}

// With room for some new slots; compact, because sweeps read all of it repeatedly.
std::size_t WorkingSet::wantedStride(std::size_t slots) const
{
    return padded(3 * std::min(slots + slots / 4 + 2, m_placeOfSlot.size()), kResponsePadding);
}

void WorkingSet::widen()
{
    const std::size_t before = m_stride;
    m_stride = wantedStride(m_slots.size());
    for (std::size_t column = 3 * m_packed; column-- > 1;)
        std::copy_backward(&m_W[column * before], &m_W[column * before] + 3 * m_packed,
                           &m_W[column * m_stride] + 3 * m_packed);
}

void WorkingSet::dropThoseThatLeft()
{
    m_isKept.assign(m_slots.size(), 0);
    std::size_t kept = 0;
    for (std::size_t k = 0; k < m_ends.size(); ++k)
    {
        const int e = m_ends[k];
        m_place[e] = m_wanted[k] ? static_cast<int>(kept) : -1;
        if (!m_wanted[k]) continue;
        m_ends[kept++] = e;
        m_points->forEachSlot(e,
                              [this](int slot, double)
                              {
                                  if (m_placeOfSlot[slot] >= 0) m_isKept[m_placeOfSlot[slot]] = 1;
                              });
    }
    m_ends.resize(kept);
    m_wanted.assign(kept, 1);
    m_sides.clear();
    m_terms.clear();
    keepSlots(static_cast<std::size_t>(std::count(m_isKept.begin(), m_isKept.end(), static_cast<unsigned char>(1))));
}

// Columns, and rows within them, only move towards the front.
void WorkingSet::keepSlots(std::size_t count)
{
    const std::size_t stride = std::min(m_stride, wantedStride(count));
    std::size_t kept = 0;
    for (std::size_t f = 0; f < m_slots.size(); ++f)
    {
        m_placeOfSlot[m_slots[f]] = m_isKept[f] ? static_cast<int>(kept) : -1;
        if (!m_isKept[f]) continue;
        for (std::size_t c = 0; c < 3; ++c)
        {
            m_velocity[3 * kept + c] = m_velocity[3 * f + c];
            const float* from = &m_W[(3 * f + c) * m_stride];
            float* to = &m_W[(3 * kept + c) * stride];
            for (std::size_t e = 0; e < m_slots.size(); ++e, from += 3)
            {
                if (!m_isKept[e]) continue;
                for (int i = 0; i < 3; ++i) to[i] = from[i];
                to += 3;
            }
        }
        m_slots[kept++] = m_slots[f];
    }
    m_slots.resize(kept);
    m_packed = kept;
    m_stride = stride;
}

void WorkingSet::load(const std::vector<double>& slotVelocity)
{
    std::fill(m_motion.begin(), m_motion.end(), RigidMotion());
    for (std::size_t k = 0; k < m_slots.size(); ++k)
        for (std::size_t i = 0; i < 3; ++i) m_velocity[3 * k + i] = slotVelocity[3 * m_slots[k] + i];
}

void WorkingSet::noteSweep(int slot, bool first)
{
    const std::size_t size = 3 * m_slots.size() + 6 * m_motion.size();
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
