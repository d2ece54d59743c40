// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/subspace_search.h"

#include "fem/contact/obstacle_response.h"

namespace bullet_fem
{
namespace
{

constexpr int kSweepsBetween = 5;
constexpr int kMostIterations = 8;
constexpr double kEnough = 0.05;  // share of the residual at which a minimization ends
// Many points on few nodes are redundant: directions of less than this share of their rows' own compliance are noise of
// single precision, or contradictions that no impulse can resolve.
constexpr double kSingular = 1e-3;
constexpr double kSticks = 1 - 1e-6;  // share of the largest friction up to which a point sticks

}  // namespace

void SubspaceSearch::begin()
{
    m_directions.reserve(m_rows.rows().size());
    for (std::vector<Vec3>* velocities : {&m_linear, &m_angular})
        velocities->reserve(m_rows.problem().m_obstacles.size());
    reset();
}

void SubspaceSearch::reset()
{
    m_sweeps = 0;
    m_sweepWork = m_work = 0;
    m_tried = false;
}

void SubspaceSearch::noteSweep(double work)
{
    ++m_sweeps;
    m_sweepWork = work;
}

bool SubspaceSearch::isDue() const
{
    return m_sweeps == kSweepsBetween;
}

void SubspaceSearch::search(const std::vector<int>& working)
{
    m_sweeps = 0;
    const bool astray = m_tried && m_sweepWork > m_work;
    m_work = m_sweepWork;
    m_tried = !astray;
    if (!astray)
    {
        choose(working);
        return minimize();
    }
    for (const Direction& d : m_directions) m_rows.change(m_rows.rows()[d.m_row], d.m_impulse);
}

void SubspaceSearch::choose(const std::vector<int>& working)
{
    m_directions.clear();
    for (int k : working)
    {
        const ContactRow& row = m_rows.rows()[k];
        const double normal = dot(row.m_impulse, row.m_axes[0]);
        const Vec3 friction = row.m_impulse - normal * row.m_axes[0];
        Direction d;
        d.m_row = k;
        d.m_impulse = row.m_impulse;
        d.m_freeAxes = 0;
        if (!row.m_idle && normal > 0) d.m_freeAxes = norm(friction) < kSticks * row.m_friction * normal ? 3 : 1;
        const Vec3 v = m_rows.velocity(row);
        for (int i = 0; i < d.m_freeAxes; ++i)
            d.m_residual[i] =
                row.m_target[i] - dot(row.m_axes[i], v) - row.m_yield[i] * dot(row.m_axes[i], row.m_impulse);
        m_directions.push_back(d);
    }
}

// The sum over all free axes of term(direction, row, axis).
template <class Term>
double SubspaceSearch::sum(const Term& term)
{
    double sum = 0;
    for (Direction& d : m_directions)
        for (int i = 0; i < d.m_freeAxes; ++i) sum += term(d, m_rows.rows()[d.m_row], i);
    return sum;
}

void SubspaceSearch::minimize()
{
    const auto own = [](const ContactRow& row, int i) { return row.m_rowCompliance[i] + row.m_yield[i]; };
    const auto residual2 = [&](const Direction& d, const ContactRow& row, int i)
    { return d.m_residual[i] * d.m_residual[i] / own(row, i); };
    double rz = sum(residual2), beta = 0;
    const double goal = kEnough * kEnough * rz;
    for (int k = 0; k < kMostIterations && rz > goal; ++k)
    {
        const double pp = sum(
            [&](Direction& d, const ContactRow& row, int i)
            {
                d.m_direction[i] = d.m_residual[i] / own(row, i) + beta * d.m_direction[i];
                return own(row, i) * d.m_direction[i] * d.m_direction[i];
            });
        respondToDirections();
        const double pWp =
            sum([](const Direction& d, const ContactRow&, int i) { return d.m_direction[i] * d.m_response[i]; });
        if (!(pWp > kSingular * pp)) return;
        followDirections(rz / pWp);
        const double next = sum(residual2);
        beta = next / rz;
        rz = next;
    }
}

// The velocities that impulses along all directions would make.
void SubspaceSearch::respondToDirections()
{
    const ContactProblem& problem = m_rows.problem();
    m_linear.assign(problem.m_obstacles.size(), Vec3());
    m_angular.assign(problem.m_obstacles.size(), Vec3());
    m_rows.forEachTouchedBody(nullptr, [this](int b) { m_rows.body(b).working().beginProbe(); });
    const auto push = [&](const RowEnd& end, const Vec3& impulse)
    {
        if (end.m_body >= 0) m_rows.body(end.m_body).working().addToProbe(end.m_end, impulse);
        if (end.m_obstacle < 0) return;
        respond(problem, end.m_obstacle, impulse, cross(end.m_arm, impulse),
                [this](int k, const Vec3& linear, const Vec3& angular)
                {
                    m_linear[k] += linear;
                    m_angular[k] += angular;
                });
    };
    const auto velocityOf = [this](const RowEnd& end)
    {
        if (end.m_body >= 0) return m_rows.body(end.m_body).working().probeVelocity(end.m_end);
        if (end.m_obstacle < 0) return Vec3();
        return m_linear[end.m_obstacle] + cross(m_angular[end.m_obstacle], end.m_arm);
    };
    for (const Direction& d : m_directions)
    {
        const ContactRow& row = m_rows.rows()[d.m_row];
        Vec3 impulse;
        for (int i = 0; i < d.m_freeAxes; ++i) impulse += d.m_direction[i] * row.m_axes[i];
        if (d.m_freeAxes == 0) continue;
        push(row.m_a, impulse);
        push(row.m_b, -impulse);
    }
    m_rows.forEachTouchedBody(m_rows.threadsForCompliance(),
                              [this](int b) { m_rows.body(b).working().respondToProbe(); });
    for (Direction& d : m_directions)
    {
        const ContactRow& row = m_rows.rows()[d.m_row];
        if (d.m_freeAxes == 0) continue;
        const Vec3 v = velocityOf(row.m_a) - velocityOf(row.m_b);
        for (int i = 0; i < d.m_freeAxes; ++i)
            d.m_response[i] = dot(row.m_axes[i], v) + row.m_yield[i] * d.m_direction[i];
    }
}

void SubspaceSearch::followDirections(double step)
{
    for (Direction& d : m_directions)
    {
        ContactRow& row = m_rows.rows()[d.m_row];
        for (int i = 0; i < d.m_freeAxes; ++i)
        {
            row.m_impulse += (step * d.m_direction[i]) * row.m_axes[i];
            d.m_residual[i] -= step * d.m_response[i];
        }
    }
    m_rows.forEachTouchedBody(nullptr, [&](int b) { m_rows.body(b).followProbe(step); });
    std::vector<Obstacle>& obstacles = m_rows.problem().m_obstacles;
    for (std::size_t k = 0; k < obstacles.size(); ++k)
    {
        obstacles[k].m_linearVelocity += step * m_linear[k];
        obstacles[k].m_angularVelocity += step * m_angular[k];
    }
}

}  // namespace bullet_fem
