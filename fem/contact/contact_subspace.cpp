// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/contact_rows.h"
#include "fem/contact/obstacle_response.h"

namespace bullet_fem
{
namespace
{

constexpr int kMostIterations = 8;
constexpr double kEnough = 0.05;  // share of the residual at which a minimization ends
// Many points on few nodes are redundant: directions of less than this share of their rows' own compliance are noise of
// single precision, or contradictions that no impulse can resolve.
constexpr double kSingular = 1e-3;
constexpr double kSticks = 1 - 1e-6;  // share of the largest friction up to which a point sticks

}  // namespace

// Gauss-Seidel finds quickly what touches and what slides, and slowly how forces spread over many points of one body.
// Over the points that neither part nor slide the problem is linear, and conjugate gradients minimize from time to time
// [Silcowitz, Niebe, Erleben 2010, projected Gauss-Seidel subspace minimization]. If sweeps find more to do after it
// than before, it led astray and is taken back. A sweep comes last, and leaves all impulses in their cones.
void ContactRows::searchSubspace()
{
    Subspace& s = m_subspace;
    s.m_sweeps = 0;
    const bool astray = s.m_tried && s.m_sweepWork > s.m_work;
    s.m_work = s.m_sweepWork;
    s.m_tried = !astray;
    if (astray)
        for (const auto& [k, impulse] : m_saved) change(m_rows[k], impulse);
    else
        minimizeOverSubspace();
}

void ContactRows::chooseSubspace()
{
    m_saved.clear();
    for (int k : m_working)
    {
        Row& row = m_rows[k];
        m_saved.push_back({k, row.m_impulse});
        const double normal = dot(row.m_impulse, row.m_axes[0]);
        const Vec3 friction = row.m_impulse - normal * row.m_axes[0];
        row.m_freeAxes = 0;
        if (!row.m_idle && normal > 0) row.m_freeAxes = norm(friction) < kSticks * row.m_friction * normal ? 3 : 1;
        row.m_direction = {};
        const Vec3 v = velocity(row);
        for (int i = 0; i < row.m_freeAxes; ++i)
            row.m_residual[i] =
                row.m_target[i] - dot(row.m_axes[i], v) - row.m_yield[i] * dot(row.m_axes[i], row.m_impulse);
    }
}

// sum over all free axes of term(row, axis).
template <class Term>
double ContactRows::sumOverSubspace(const Term& term)
{
    double sum = 0;
    for (int k : m_working)
        for (int i = 0; i < m_rows[k].m_freeAxes; ++i) sum += term(m_rows[k], i);
    return sum;
}

void ContactRows::minimizeOverSubspace()
{
    const auto own = [](const Row& row, int i) { return row.m_rowCompliance[i] + row.m_yield[i]; };
    const auto residual2 = [&](const Row& row, int i) { return row.m_residual[i] * row.m_residual[i] / own(row, i); };
    chooseSubspace();
    double rz = sumOverSubspace(residual2), beta = 0;
    const double goal = kEnough * kEnough * rz;
    for (int k = 0; k < kMostIterations && rz > goal; ++k)
    {
        const double pp = sumOverSubspace(
            [&](Row& row, int i)
            {
                row.m_direction[i] = row.m_residual[i] / own(row, i) + beta * row.m_direction[i];
                return own(row, i) * row.m_direction[i] * row.m_direction[i];
            });
        respondToDirections();
        const double pWp =
            sumOverSubspace([](const Row& row, int i) { return row.m_direction[i] * row.m_response[i]; });
        if (!(pWp > kSingular * pp)) return;
        followDirections(rz / pWp);
        const double next = sumOverSubspace(residual2);
        beta = next / rz;
        rz = next;
    }
}

// The velocities that impulses along all directions would make.
void ContactRows::respondToDirections()
{
    const std::vector<Obstacle>& obstacles = m_problem->m_obstacles;
    m_probeLinear.assign(obstacles.size(), Vec3());
    m_probeAngular.assign(obstacles.size(), Vec3());
    forEachTouchedBody(nullptr, [this](int b) { m_bodies[b].working().beginProbe(); });
    const auto push = [&](const RowEnd& end, const Vec3& impulse)
    {
        if (end.m_body >= 0) m_bodies[end.m_body].working().addToProbe(end.m_end, impulse);
        if (end.m_obstacle < 0) return;
        respond(*m_problem, end.m_obstacle, impulse, cross(end.m_arm, impulse),
                [this](int k, const Vec3& linear, const Vec3& angular)
                {
                    m_probeLinear[k] += linear;
                    m_probeAngular[k] += angular;
                });
    };
    const auto velocityOf = [this](const RowEnd& end)
    {
        if (end.m_body >= 0) return m_bodies[end.m_body].working().probeVelocity(end.m_end);
        if (end.m_obstacle < 0) return Vec3();
        return m_probeLinear[end.m_obstacle] + cross(m_probeAngular[end.m_obstacle], end.m_arm);
    };
    for (int k : m_working)
    {
        const Row& row = m_rows[k];
        Vec3 impulse;
        for (int i = 0; i < row.m_freeAxes; ++i) impulse += row.m_direction[i] * row.m_axes[i];
        if (row.m_freeAxes == 0) continue;
        push(row.m_a, impulse);
        push(row.m_b, -impulse);
    }
    forEachTouchedBody(threadsForCompliance(), [this](int b) { m_bodies[b].working().respondToProbe(); });
    for (int k : m_working)
    {
        Row& row = m_rows[k];
        if (row.m_freeAxes == 0) continue;
        const Vec3 v = velocityOf(row.m_a) - velocityOf(row.m_b);
        for (int i = 0; i < row.m_freeAxes; ++i)
            row.m_response[i] = dot(row.m_axes[i], v) + row.m_yield[i] * row.m_direction[i];
    }
}

void ContactRows::followDirections(double step)
{
    for (int k : m_working)
    {
        Row& row = m_rows[k];
        for (int i = 0; i < row.m_freeAxes; ++i)
        {
            row.m_impulse += (step * row.m_direction[i]) * row.m_axes[i];
            row.m_residual[i] -= step * row.m_response[i];
        }
    }
    forEachTouchedBody(nullptr, [&](int b) { m_bodies[b].followProbe(step); });
    for (std::size_t k = 0; k < m_problem->m_obstacles.size(); ++k)
    {
        m_problem->m_obstacles[k].m_linearVelocity += step * m_probeLinear[k];
        m_problem->m_obstacles[k].m_angularVelocity += step * m_probeAngular[k];
    }
}

}  // namespace bullet_fem
