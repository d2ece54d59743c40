// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/solver/gcr_iteration.h"

#include <algorithm>
#include <cmath>

namespace bullet_fem
{
namespace
{

// A direction counts as rounding if less than this share of its square is left after orthogonalisation.
constexpr double kSameDirection = 1e-10;

constexpr double kMuchLess = 0.25;  // share of a square

double product(const std::vector<double>& a, const std::vector<double>& b)
{
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

}  // namespace

void GcrIteration::Vectors::resize(int size)
{
    for (std::vector<double>* values : {&m_impulse, &m_left, &m_answer}) values->resize(size);
}

double GcrIteration::Vectors::square() const
{
    return product(m_left, m_answer);
}

void GcrIteration::Vectors::add(double share, const Vectors& other)
{
    for (std::size_t i = 0; i < m_left.size(); ++i)
    {
        m_impulse[i] += share * other.m_impulse[i];
        m_left[i] += share * other.m_left[i];
        m_answer[i] += share * other.m_answer[i];
    }
}

void GcrIteration::begin()
{
    m_hasBest = false;
    m_count = m_next = 0;
    for (Vectors* vectors : {&m_now, &m_best}) vectors->resize(m_joints.unknowns());
    for (Vectors& direction : m_directions) direction.resize(m_joints.unknowns());
    m_before.resize(m_joints.unknowns());
    m_shift.resize(m_joints.unknowns());
}

void GcrIteration::look(bool othersMoved)
{
    if (m_joints.isEmpty()) return;
    for (int i = 0; i < m_joints.unknowns(); ++i)
    {
        const ContactRow& row = m_joints.row(i / 3);
        m_now.m_impulse[i] = dot(row.m_impulse, row.m_axes[i % 3]);
    }
    m_joints.residual(m_now.m_left);
    m_now.m_answer.assign(m_now.m_left.begin(), m_now.m_left.end());
    m_joints.answer(m_now.m_answer);
    // The system changes with the active contacts, the held joints, and rows of others.
    if (noteActing() || othersMoved || m_changes != m_joints.changes()) m_hasBest = false;
    m_changes = m_joints.changes();
    noteDirection();
    noteLargest();
}

// True if the active contacts differ from those of the previous outer iteration.
bool GcrIteration::noteActing()
{
    const std::vector<ContactRow>& rows = m_rows.rows();
    bool changed = m_acting.size() != rows.size();
    m_acting.resize(rows.size());
    for (std::size_t k = 0; k < rows.size(); ++k)
    {
        const unsigned char acts = !rows[k].m_joint && dot(rows[k].m_impulse, rows[k].m_impulse) > 0;
        changed = changed || m_acting[k] != acts;
        m_acting[k] = acts;
    }
    return changed;
}

// Adds the direction from the best combination to the last outer iteration, orthogonalised against the others, and
// minimises along it.
void GcrIteration::noteDirection()
{
    if (!m_hasBest)
    {
        m_best = m_now;
        m_hasBest = true;
        m_count = m_next = 0;
        return;
    }
    Vectors& direction = m_directions[m_next];
    direction = m_now;
    direction.add(-1, m_best);
    const double whole = direction.square();
    for (int k = 0; k < m_count; ++k)
        if (k != m_next) direction.add(-product(direction.m_left, m_directions[k].m_answer), m_directions[k]);
    const double square = direction.square();
    // If two iterations leave equal residuals, rounding may make both negative.
    const double unit = square > kSameDirection * std::fabs(whole) ? 1 / std::sqrt(square) : 0;
    for (std::vector<double>* values : {&direction.m_impulse, &direction.m_left, &direction.m_answer})
        for (double& value : *values) value *= unit;
    m_best.add(-product(m_best.m_left, direction.m_answer), direction);
    m_next = (m_next + 1) % kDirections;
    m_count = std::min(m_count + 1, kDirections);
}

template <class Visit>
void GcrIteration::forEndsOf(const ContactRow& row, const Visit& visit) const
{
    const bool isRigid = row.m_a.m_body < 0 && row.m_b.m_body < 0;
    for (const ConstraintSide* end : {&row.m_a, &row.m_b})
        if (const int mover = m_rows.mover(*end); mover >= 0 && (isRigid || end->m_body >= 0)) visit(mover);
}

void GcrIteration::noteLargest()
{
    m_largest.assign(m_rows.movers(), 0);
    for (int k = 0; 3 * k < m_joints.unknowns(); ++k)
    {
        const double size = norm(m_joints.row(k).m_impulse);
        forEndsOf(m_joints.row(k), [&](int mover) { m_largest[mover] = std::max(m_largest[mover], size); });
    }
}

double GcrIteration::largestShare(double negligible) const
{
    double share = 0;
    for (int k = 0; 3 * k < m_joints.unknowns(); ++k)
    {
        const ContactRow& row = m_joints.row(k);
        const double* answer = &m_now.m_answer[3 * static_cast<std::size_t>(k)];
        const Vec3 lacks = {answer[0], answer[1], answer[2]};
        if (!(speedOf(row, lacks) > negligible)) continue;
        double largest = norm(lacks);
        forEndsOf(row, [&](int mover) { largest = std::max(largest, m_largest[mover]); });
        share = std::max(share, norm(lacks) / largest);
    }
    return share;
}

double GcrIteration::largestSpeed() const
{
    double largest = 0;
    for (double left : m_now.m_left) largest = std::max(largest, std::fabs(left));
    return largest;
}

void GcrIteration::combine()
{
    if (m_joints.isEmpty() || !m_hasBest || m_count == 0) return;
    m_joints.residual(m_before);
    takeBest();
    m_joints.residual(m_shift);
    for (std::size_t i = 0; i < m_shift.size(); ++i)
        m_shift[i] = (m_best.m_left[i] - m_now.m_left[i]) - (m_shift[i] - m_before[i]);
    m_joints.shift(&m_shift);
}

bool GcrIteration::isBestBehind() const
{
    return !m_joints.isEmpty() && m_count > 0 && m_best.square() < kMuchLess * m_now.square();
}

void GcrIteration::takeBest()
{
    for (int k = 0; 3 * k < m_joints.unknowns(); ++k)
    {
        ContactRow& row = m_joints.row(k);
        Vec3 impulse = row.m_impulse;
        for (int i = 0; i < 3; ++i)
            impulse += (m_best.m_impulse[3 * k + i] - m_now.m_impulse[3 * k + i]) * row.m_axes[i];
        m_rows.change(row, impulse);
    }
    m_rows.flush();
}

}  // namespace bullet_fem
