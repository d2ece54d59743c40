// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/truncated_newton.h"

#include <algorithm>
#include <cmath>

namespace bullet_fem
{
namespace
{

constexpr int kMinInterval = 3;    // sweeps before the first step, and from one step to the next that pays
constexpr int kMaxInterval = 256;  // at most, where steps do not pay
constexpr double kPays = 0.4;      // share of the change that a sweep after a step that pays leaves at most
constexpr int kMaxIterations = 24;
// Rounding of W: impulses that cancel each other to this share of the energy of each alone solve nothing [-].
constexpr double kMinCurvature = 1e-7;
constexpr double kTolerance = 1e-3;  // of the squared residual in the preconditioner's norm [-]

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

}  // namespace

void TruncatedNewton::begin()
{
    m_of.reserve(m_rows.rows().size());
    m_waited = 0;
    m_interval = kMinInterval;
    m_changeThen = 0;
}

bool TruncatedNewton::step(const std::vector<int>& working, double change)
{
    if (m_changeThen > 0)
        m_interval = change > kPays * m_changeThen ? std::min(2 * m_interval, kMaxInterval)
                                                   : std::max(m_interval / 2, kMinInterval);
    m_changeThen = 0;
    if (++m_waited < m_interval) return false;
    m_waited = 0;
    m_changeThen = change;
    findFree(working);
    solve(working);
    project(working);
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
        of.m_free = sticks(row) ? 2 : 1;
        Vec3 missing = row.m_target - of.m_velocity;
        missing.x -= row.m_yield.x * of.m_start.x;
        of.m_residual = of.m_r = freePart(missing, of.m_free);
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
        if (of.m_free == 0) continue;
        const Vec3& w = row.m_rowCompliance;
        of.m_z = {of.m_r.x / (w.x + row.m_yield.x), of.m_r.y / w.y, of.m_r.z / w.z};
        sum += dot(of.m_r, of.m_z);
    }
    return sum;
}

// The rows' impulses become start + ofX x + ofD d; the velocities follow.
void TruncatedNewton::move(const std::vector<int>& working, double ofX, double ofD)
{
    for (std::size_t k = 0; k < working.size(); ++k)
    {
        const Row& of = m_of[k];
        if (of.m_free == 0) continue;
        ContactRow& row = m_rows.rows()[working[k]];
        m_rows.change(row, inWorld(row, of.m_start + ofX * of.m_x + ofD * of.m_d));
    }
}

// W d, from the velocities at start + x + d.
void TruncatedNewton::multiply(const std::vector<int>& working)
{
    move(working, 1, 1);
    for (std::size_t k = 0; k < working.size(); ++k)
    {
        Row& of = m_of[k];
        if (of.m_free == 0) continue;
        const ContactRow& row = m_rows.rows()[working[k]];
        of.m_Wd = velocity(row) - of.m_velocity - of.m_Wx;
    }
}

void TruncatedNewton::solve(const std::vector<int>& working)
{
    double rz = precondition(working);
    const double enough = kTolerance * rz;
    for (Row& of : m_of) of.m_d = of.m_z;
    for (int i = 0; i < kMaxIterations && rz > enough; ++i)
    {
        multiply(working);
        const auto product = [&](std::size_t k) -> Vec3
        {
            Vec3 w = m_of[k].m_Wd;
            w.x += m_rows.rows()[working[k]].m_yield.x * m_of[k].m_d.x;
            return freePart(w, m_of[k].m_free);
        };
        double dWd = 0, alone = 0;
        for (std::size_t k = 0; k < m_of.size(); ++k)
        {
            const Vec3 &d = m_of[k].m_d, &w = m_rows.rows()[working[k]].m_rowCompliance;
            dWd += dot(d, product(k));
            alone += w.x * d.x * d.x + w.y * d.y * d.y + w.z * d.z * d.z;
        }
        if (!(dWd > kMinCurvature * alone)) return;
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

// x = Proj(start + x) - start.
void TruncatedNewton::project(const std::vector<int>& working)
{
    for (std::size_t k = 0; k < working.size(); ++k)
    {
        Row& of = m_of[k];
        if (of.m_free == 0) continue;
        Vec3 to = of.m_start + of.m_x;
        const double most = m_rows.rows()[working[k]].m_friction * to.x, length = std::hypot(to.y, to.z);
        if (!(to.x > 0))
            to = {};
        else if (length > most)
            to = {to.x, to.y * most / length, to.z * most / length};
        of.m_x = to - of.m_start;
    }
}

// Minimizes the quadratic energy along x, within the cones.
void TruncatedNewton::search(const std::vector<int>& working)
{
    move(working, 1, 0);
    double slope = 0, curvature = 0;
    for (std::size_t k = 0; k < working.size(); ++k)
    {
        const Row& of = m_of[k];
        if (of.m_free == 0) continue;
        const ContactRow& row = m_rows.rows()[working[k]];
        slope += dot(of.m_residual, of.m_x);
        curvature += dot(of.m_x, velocity(row) - of.m_velocity) + row.m_yield.x * of.m_x.x * of.m_x.x;
    }
    const double share = !(slope > 0) ? 0 : curvature > slope ? slope / curvature : 1;
    if (share < 1) move(working, share, 0);
}

}  // namespace bullet_fem
