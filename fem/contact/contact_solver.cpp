// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/contact_solver.h"

#include <algorithm>

#include "bullet_fem/fem/stepping.h"
#include "fem/contact/contact_rows.h"

namespace bullet_fem
{

std::shared_ptr<ComplianceCache> makeComplianceCache(std::shared_ptr<const BodyModel> model)
{
    return std::make_shared<ComplianceCache>(std::move(model));
}

struct ContactSolver::Scratch
{
    ContactRows m_rows;
    std::vector<Vec3> m_applied;       // per contact: what the bodies' velocities already hold [N s]
    std::vector<Vec3> m_news;          // per contact: what a round adds [N s]
    std::vector<Vec3> m_nodeImpulses;  // of one body [N s]
};

namespace
{

// Node impulses J^T lambda of one body's contacts.
void gatherNodeImpulses(const std::vector<ContactPoint>& contacts, const std::vector<Vec3>& impulse, int body,
                        std::vector<Vec3>& nodeImpulses)
{
    std::fill(nodeImpulses.begin(), nodeImpulses.end(), Vec3());
    for (std::size_t k = 0; k < contacts.size(); ++k)
        if (contacts[k].m_body == body)
            for (int a = 0; a < 3; ++a) nodeImpulses[contacts[k].m_nodes[a]] += contacts[k].m_weights[a] * impulse[k];
}

// Largest change of an impulse, relative to the largest impulse.
double relativeChange(const std::vector<ContactPoint>& contacts, const std::vector<Vec3>& applied)
{
    double change = 0, largest = 0;
    for (std::size_t k = 0; k < contacts.size(); ++k)
    {
        change = std::max(change, norm(contacts[k].m_impulse - applied[k]));
        largest = std::max(largest, norm(contacts[k].m_impulse));
    }
    return largest > 0 ? change / largest : 0;
}

bool isZero(const std::vector<Vec3>& values)
{
    return std::all_of(values.begin(), values.end(), [](const Vec3& v) { return dot(v, v) == 0; });
}

// Displacing a moving body changes its angular momentum about the origin. The obstacles that it was pushed off take the
// opposite, in proportion to the push.
void payBack(const Vec3& gained, int body, const std::vector<ContactPoint>& contacts, const std::vector<Vec3>& push,
             std::vector<Obstacle>& obstacles)
{
    double total = 0;
    for (std::size_t k = 0; k < contacts.size(); ++k)
        if (contacts[k].m_body == body) total += norm(push[k]);
    for (std::size_t k = 0; k < contacts.size(); ++k)
        if (contacts[k].m_body == body)
            obstacles[contacts[k].m_obstacle].m_angularImpulse -= (norm(push[k]) / total) * gained;
}

// The same for an obstacle's own displacement, h pushLinear x m v; then its spin changes by the sum of all.
void payBackOwn(Obstacle& obstacle, double h)
{
    const Vec3& w = obstacle.m_inverseMass;
    if (!(w.x > 0 && w.y > 0 && w.z > 0))
    {
        obstacle.m_angularImpulse = {};
        return;
    }
    const Vec3 momentum = {obstacle.m_linearVelocity.x / w.x, obstacle.m_linearVelocity.y / w.y,
                           obstacle.m_linearVelocity.z / w.z};
    obstacle.m_angularImpulse -= cross(h * obstacle.m_pushLinear, momentum);
    obstacle.m_angularVelocity += obstacle.m_inverseInertia * obstacle.m_angularImpulse;
}

}  // namespace

ContactSolver::ContactSolver() : m_scratch(std::make_unique<Scratch>()) {}
ContactSolver::~ContactSolver() = default;

ContactReport ContactSolver::solve(const std::vector<ContactBody>& bodies, std::vector<Obstacle>& obstacles,
                                   std::vector<ContactPoint>& contacts, const ContactSettings& settings)
{
    ContactReport report;
    report.m_contacts = static_cast<int>(contacts.size());
    for (Obstacle& obstacle : obstacles) obstacle.m_pushLinear = obstacle.m_pushAngular = {};
    if (contacts.empty()) return report;
    ContactRows& rows = m_scratch->m_rows;
    std::vector<Vec3>&applied = m_scratch->m_applied, &news = m_scratch->m_news,
    &nodeImpulses = m_scratch->m_nodeImpulses;
    const int bodyCount = static_cast<int>(bodies.size());

    rows.assemble(bodies, obstacles, contacts, settings.m_step);
    applied.assign(contacts.size(), Vec3());
    news.resize(contacts.size());
    rows.warmStart(contacts, obstacles);
    for (double change = 1; report.m_rounds < settings.m_rounds ||
                            (report.m_rounds < settings.m_maxRounds && change > settings.m_roundTolerance);
         ++report.m_rounds)
    {
        rows.measureVelocities(bodies, contacts, applied);
        report.m_sweeps += rows.sweep(obstacles, contacts, settings);
        change = relativeChange(contacts, applied);
        for (std::size_t k = 0; k < contacts.size(); ++k) news[k] = contacts[k].m_impulse - applied[k];
        for (int b = 0; b < bodyCount; ++b)
        {
            nodeImpulses.resize(bodies[b].m_body->m_state.m_x.size());
            gatherNodeImpulses(contacts, news, b, nodeImpulses);
            if (isZero(nodeImpulses)) continue;
            const SolveReport solved = applyImpulses(*bodies[b].m_body, nodeImpulses, settings.m_step);
            report.m_iterations += solved.m_iterations;
            report.m_converged = report.m_converged && solved.m_stop == SolveStop::converged;
        }
        rows.learnCompliance(bodies, obstacles, contacts, applied);
        for (std::size_t k = 0; k < contacts.size(); ++k) applied[k] = contacts[k].m_impulse;
    }

    report.m_violation = rows.worstViolation(bodies, obstacles, contacts);
    if (!rows.needPush(contacts)) return report;
    rows.measureVelocities(bodies, contacts, applied);
    report.m_sweeps += rows.sweepPush(obstacles, contacts, settings, applied);
    for (int b = 0; b < bodyCount; ++b)
    {
        nodeImpulses.resize(bodies[b].m_body->m_state.m_x.size());
        gatherNodeImpulses(contacts, applied, b, nodeImpulses);
        if (isZero(nodeImpulses)) continue;
        const Vec3 gained = applyPush(*bodies[b].m_body, nodeImpulses, settings.m_step);
        payBack(gained, b, contacts, applied, obstacles);
    }
    for (Obstacle& obstacle : obstacles) payBackOwn(obstacle, settings.m_step.m_step);
    return report;
}

}  // namespace bullet_fem
