// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/contact_rows.h"

#include <algorithm>

namespace bullet_fem
{
namespace
{

constexpr int kMaxSweepsOfPush = 200;
constexpr double kPushTolerance = 1e-4;       // share of the speed scale, as of contact
constexpr double kLoosePushTolerance = 1e-3;  // at most: 1e-3 g h^2 of displacement, at 60 Hz 3e-6 m

// A tenth of what contact is solved to, within bounds.
double pushTolerance(double contactTolerance)
{
    return std::clamp(0.1 * contactTolerance, kPushTolerance, kLoosePushTolerance);
}

}  // namespace

bool ContactRows::needPush() const
{
    return std::any_of(m_problem->m_contacts.begin(), m_problem->m_contacts.end(),
                       [](const ContactPoint& c)
                       { return c.m_gap < -c.m_slop && !(c.m_stiffness > 0 || c.m_damping > 0); });
}

// Penetrating points shall separate at a share of their depth a step, unless they do so already; the others shall not
// close their gap, and joints hold. From here on all velocities are those of the push.
void ContactRows::preparePush()
{
    const double h = m_settings.m_step.m_step;
    m_subspace = {};
    forgetWorkingSet();
    for (std::size_t k = 0; k < m_rows.size(); ++k)
    {
        Row& row = m_rows[k];
        row.m_impulse = row.m_roundImpulse = row.m_target = {};
        if (row.m_joint || row.m_touch) continue;
        const ContactPoint& c = m_problem->m_contacts[k];
        const double moving = dot(c.m_normal, velocity(row));
        const double depth = std::max(0.0, -c.m_gap - c.m_slop);
        const double share = std::min(m_settings.m_pushFraction * c.m_hardness, 1.0);
        const double wanted = std::min(share * depth / h, m_settings.m_maxPushVelocity);
        row.m_target.x = c.m_gap < 0 ? wanted - std::max(moving, 0.0) : -(moving + c.m_gap / h);
        row.m_friction = 0;
        row.m_idle = row.m_idle || row.m_yield.x > 0;
    }
    prepareTouches();
    m_savedLinear.resize(m_problem->m_obstacles.size());
    m_savedAngular.resize(m_problem->m_obstacles.size());
    for (std::size_t k = 0; k < m_problem->m_obstacles.size(); ++k)
    {
        Obstacle& obstacle = m_problem->m_obstacles[k];
        m_savedLinear[k] = obstacle.m_linearVelocity;
        m_savedAngular[k] = obstacle.m_angularVelocity;
        obstacle.m_linearVelocity = obstacle.m_angularVelocity = {};
    }
    for (std::size_t b = 0; b < m_problem->m_bodies.size(); ++b) m_bodies[b].beginPush();
    restart();
}

int ContactRows::push()
{
    measure();
    preparePush();
    setSpeedScale();
    int sweeps = 1;
    const double tolerance = pushTolerance(m_settings.m_tolerance);
    for (; sweep(tolerance) && sweeps < kMaxSweepsOfPush; ++sweeps)
        if (runsAway()) letGo();
    sumPushImpulses();
    for (std::size_t k = 0; k < m_problem->m_obstacles.size(); ++k)
    {
        Obstacle& obstacle = m_problem->m_obstacles[k];
        obstacle.m_pushLinear = obstacle.m_linearVelocity;
        obstacle.m_pushAngular = obstacle.m_angularVelocity;
        obstacle.m_linearVelocity = m_savedLinear[k];
        obstacle.m_angularVelocity = m_savedAngular[k];
    }
    m_pushed.assign(m_problem->m_bodies.size(), {});
    forEachTouchedBody(m_settings.m_step.m_threads,
                       [this](int b) { m_pushed[b].m_gained = m_bodies[b].applyPush(m_settings.m_step); });
    payBack();
    return sweeps;
}

// Whose joints share out the push is told its impulses.
void ContactRows::sumPushImpulses()
{
    const auto add = [this](const RowEnd& end, const Vec3& impulse)
    {
        if (end.m_obstacle < 0) return;
        Obstacle& obstacle = m_problem->m_obstacles[end.m_obstacle];
        if (obstacle.m_responseCount == 0) return;
        if (!end.m_angular) obstacle.m_pushImpulse += impulse;
        obstacle.m_pushAngularImpulse += end.m_angular ? impulse : cross(end.m_arm, impulse);
    };
    for (const Row& row : m_rows)
    {
        add(row.m_a, row.m_impulse);
        add(row.m_b, -row.m_impulse);
    }
}

// Displacing a moving body changes its angular momentum about the origin. The movable obstacles that it was pushed off
// take the opposite, in proportion to the push; where it was pushed off soft ones it spins itself.
void ContactRows::payBack()
{
    const auto visitBodies = [this](const Row& row, auto visit)
    {
        const int a = row.m_a.m_body, b = row.m_b.m_body;
        if (a >= 0) visit(m_pushed[a], row.m_b);
        if (b >= 0 && b != a) visit(m_pushed[b], row.m_a);
    };
    for (const Row& row : m_rows)
        visitBodies(row,
                    [&row](Pushed& pushed, const RowEnd& other)
                    {
                        pushed.m_total += norm(row.m_impulse);
                        if (other.m_body >= 0) pushed.m_bySoft += norm(row.m_impulse);
                    });
    for (const Row& row : m_rows)
        visitBodies(row,
                    [&](const Pushed& pushed, const RowEnd& other)
                    {
                        if (other.m_obstacle < 0 || !(pushed.m_total > 0)) return;
                        Obstacle& obstacle = m_problem->m_obstacles[other.m_obstacle];
                        if (obstacle.canMove())
                            obstacle.m_angularImpulse -= (norm(row.m_impulse) / pushed.m_total) * pushed.m_gained;
                    });
    for (std::size_t b = 0; b < m_pushed.size(); ++b)
        if (m_pushed[b].m_total > 0)
            m_bodies[b].spin(-(m_pushed[b].m_bySoft / m_pushed[b].m_total) * m_pushed[b].m_gained, m_settings.m_step);
}

}  // namespace bullet_fem
