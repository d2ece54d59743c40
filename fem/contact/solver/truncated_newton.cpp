// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/solver/truncated_newton.h"

#include <algorithm>
#include <cmath>

#include "fem/contact/contact_tuning.h"

namespace bullet_fem
{
namespace
{

// Rounding of W: share of the energy of each impulse alone, by elastic responses and by all, below which the energy of
// a direction is rounding. Impulses of more contacts than a body has freedoms cancel each other up to that.
constexpr double kRoundingOfElastic = 1e-7, kRoundingOfAll = 1e-12;
constexpr double kTolerance = 1e-5;  // of the squared residual in the preconditioner's norm [-]

Vec3 inAxes(const ContactRow& row, const Vec3& v)
{
    return {dot(row.m_axes[0], v), dot(row.m_axes[1], v), dot(row.m_axes[2], v)};
}

Vec3 inWorld(const ContactRow& row, const Vec3& v)
{
    return v.x * row.m_axes[0] + v.y * row.m_axes[1] + v.z * row.m_axes[2];
}

// Without the components that are not free.
Vec3 freePart(const Vec3& v, int free)
{
    return {free > 0 ? v.x : 0, free > 1 ? v.y : 0, free > 1 ? v.z : 0};
}

// Velocity that the free components of a row lack with this impulse, all in its axes.
Vec3 residual(const ContactRow& row, const Vec3& impulse, const Vec3& velocity, int free)
{
    Vec3 missing = row.m_target - velocity;
    missing.x -= row.m_yield.x * impulse.x;
    return freePart(missing, free);
}

}  // namespace

void TruncatedNewton::begin()
{
    m_of.reserve(m_rows.rows().size());
    m_waited = 0;
    m_interval = kMinInterval;
    m_budget = kBudget;
    m_changeThen = 0;
}

bool TruncatedNewton::isDue(double change, double tolerance)
{
    if (m_changeThen > 0)
    {
        const bool pays = change <= kPays * m_changeThen;
        m_interval = pays ? std::max(m_interval / 2, kMinInterval) : 2 * m_interval;
        m_budget = pays ? std::min(2 * m_budget, 8 * kBudget) : std::max(m_budget / 2, kBudget / 2);
    }
    m_changeThen = 0;
    if (++m_waited == 1) m_changeFirst = change;
    if (m_waited < m_interval) return false;
    const double rate = std::pow(change / m_changeFirst, 1.0 / (m_waited - 1));
    m_waited = 0;
    return !(rate < 1 && change * std::pow(rate, kSweepsPerStep) <= tolerance);
}

bool TruncatedNewton::step(const std::vector<int>& working, double change, double tolerance)
{
    if (!isDue(change, tolerance)) return false;
    m_changeThen = change;
    m_left = m_budget;
    findFree(working);
    for (solve(working); project(working); solve(working)) measure(working);
    search(working);
    return true;
}

Vec3 TruncatedNewton::velocity(const ContactRow& row) const
{
    return inAxes(row, m_rows.velocity(row));
}

void TruncatedNewton::findFree(const std::vector<int>& working)
{
    m_of.assign(working.size(), Row());
    for (std::size_t k = 0; k < working.size(); ++k)
    {
        const ContactRow& row = m_rows.rows()[working[k]];
        Row& of = m_of[k];
        of.m_start = inAxes(row, row.m_impulse);
        of.m_velocity = velocity(row);
        if (row.m_joint || row.m_torsion || row.m_idle || !(of.m_start.x > 0)) continue;
        of.m_moves = true;
        of.m_elastic = m_rows.elasticCompliance(row);
        of.m_free = sticks(row) ? 2 : 1;
        of.m_residual = of.m_r = residual(row, of.m_start, of.m_velocity, of.m_free);
    }
}

// z = the residual over each axis' own compliance; returns r . z.
double TruncatedNewton::precondition(const std::vector<int>& working)
{
    double sum = 0;
    for (std::size_t k = 0; k < working.size(); ++k)
    {
        const ContactRow& row = m_rows.rows()[working[k]];
        Row& of = m_of[k];
        const Vec3& w = row.m_rowCompliance;
        of.m_z = freePart({of.m_r.x / (w.x + row.m_yield.x), of.m_r.y / w.y, of.m_r.z / w.z}, of.m_free);
        sum += dot(of.m_r, of.m_z);
    }
    return sum;
}

// The rows' impulses become start + ofX x + ofD d; joints and velocities follow. W is then its Schur complement.
void TruncatedNewton::move(const std::vector<int>& working, double ofX, double ofD)
{
    forEachMoving(working, [&](const Row& of, ContactRow& row)
                  { m_rows.change(row, inWorld(row, of.m_start + ofX * of.m_x + ofD * of.m_d)); });
    if (m_joints.isLinear()) m_joints.solve();
}

// W d, from the velocities at start + x + d.
void TruncatedNewton::multiply(const std::vector<int>& working)
{
    move(working, 1, 1);
    forEachMoving(working,
                  [this](Row& of, const ContactRow& row) { of.m_Wd = velocity(row) - of.m_velocity - of.m_Wx; });
}

void TruncatedNewton::solve(const std::vector<int>& working)
{
    double rz = precondition(working);
    const double enough = kTolerance * rz;
    for (Row& of : m_of) of.m_d = of.m_z;
    for (; m_left > 0 && rz > enough; --m_left)
    {
        multiply(working);
        const auto product = [&](std::size_t k) -> Vec3
        {
            Vec3 w = m_of[k].m_Wd;
            w.x += m_rows.rows()[working[k]].m_yield.x * m_of[k].m_d.x;
            return freePart(w, m_of[k].m_free);
        };
        double dWd = 0, rounding = 0;
        for (std::size_t k = 0; k < m_of.size(); ++k)
        {
            dWd += dot(m_of[k].m_d, product(k));
            const Vec3 &d = m_of[k].m_d, &w = m_rows.rows()[working[k]].m_rowCompliance;
            rounding += kRoundingOfElastic * m_of[k].m_elastic * dot(d, d);
            rounding += kRoundingOfAll * (w.x * d.x * d.x + w.y * d.y * d.y + w.z * d.z * d.z);
        }
        if (!(dWd > rounding)) return;
        const double length = rz / dWd;
        for (std::size_t k = 0; k < m_of.size(); ++k)
        {
            m_of[k].m_x += length * m_of[k].m_d;
            m_of[k].m_Wx += length * m_of[k].m_Wd;
            m_of[k].m_r -= length * product(k);
        }
        const double next = precondition(working);
        for (Row& of : m_of) of.m_d = of.m_z + (next / rz) * of.m_d;
        rz = next;
    }
}

// x = Proj(start + x) - start. True if rows let go or slide, which are held there; the others must take over what they
// bore: on a stiff body, impulses with a resultant would undo the step.
bool TruncatedNewton::project(const std::vector<int>& working)
{
    bool any = false;
    forEachMoving(working,
                  [&any](Row& of, const ContactRow& row)
                  {
                      Vec3 to = of.m_start + of.m_x;
                      const double most = row.m_friction * to.x, length = std::hypot(to.y, to.z);
                      const int before = of.m_free;
                      if (!(to.x > 0))
                      {
                          to = {};
                          of.m_free = 0;
                      }
                      else if (length > most)
                      {
                          to = {to.x, to.y * most / length, to.z * most / length};
                          of.m_free = std::min(of.m_free, 1);
                      }
                      any = any || of.m_free < before;
                      of.m_x = to - of.m_start;
                  });
    return any;
}

// The residual at start + x.
void TruncatedNewton::measure(const std::vector<int>& working)
{
    move(working, 1, 0);
    forEachMoving(working,
                  [this](Row& of, const ContactRow& row)
                  {
                      const Vec3 v = velocity(row);
                      of.m_Wx = v - of.m_velocity;
                      of.m_r = residual(row, of.m_start + of.m_x, v, of.m_free);
                  });
}

// Minimizes the quadratic energy along x, within the cones.
void TruncatedNewton::search(const std::vector<int>& working)
{
    move(working, 1, 0);
    double slope = 0, curvature = 0;
    forEachMoving(working,
                  [&](const Row& of, const ContactRow& row)
                  {
                      slope += dot(of.m_residual, of.m_x);
                      curvature += dot(of.m_x, velocity(row) - of.m_velocity) + row.m_yield.x * of.m_x.x * of.m_x.x;
                  });
    const double share = !(slope > 0) ? 0 : curvature > slope ? slope / curvature : 1;
    if (share < 1) move(working, share, 0);
}

}  // namespace bullet_fem
