// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/solver/rotated_anchor_factor.h"

#include <algorithm>

#include "fem/contact/contact_tuning.h"

namespace bullet_fem
{
void RotatedAnchorFactor::find(int first, const std::vector<unsigned char>& isHeld)
{
    const ContactProblem& problem = m_rows.problem();
    const int count = static_cast<int>(problem.m_joints.size());
    m_first = first;
    dropAll();
    m_runOf.assign(problem.m_joints.size(), -1);
    m_turn.resize(problem.m_joints.size());
    m_nodeOf.resize(problem.m_joints.size());
    m_jointsOf.assign(problem.m_bodies.size(), 0);
    for (int k = 0; k < count; ++k)
    {
        m_nodeOf[k] = nodeOf(k, isHeld);
        for (const ConstraintSide* end : {&row(k).m_a, &row(k).m_b})
            if (end->m_body >= 0) ++m_jointsOf[end->m_body];
    }
    for (Range run = {0, 0}; run.m_begin < count; run.m_begin = run.m_end)
    {
        const int body = row(run.m_begin).m_a.m_body;
        run.m_end = run.m_begin + 1;
        if (m_nodeOf[run.m_begin] < 0) continue;
        while (run.m_end < count && m_nodeOf[run.m_end] >= 0 && row(run.m_end).m_a.m_body == body) ++run.m_end;
        const int length = run.m_end - run.m_begin;
        const double work = EnvelopeFactor::work(length) * length / 3;
        if (length == m_jointsOf[body] && length >= kMinHeldNodes && work <= kMaxJointWork) addRun(run);
    }
}

// The node, if it is all that moves at the joint's sides, and W describes its response; else -1.
int RotatedAnchorFactor::nodeOf(int joint, const std::vector<unsigned char>& isHeld) const
{
    const ContactRow& r = row(joint);
    const unsigned char* held = &isHeld[3 * static_cast<std::size_t>(joint)];
    if (held[0] || held[1] || held[2] || dot(r.m_yield, r.m_yield) > 0) return -1;
    if (r.m_a.m_body < 0 || !standsStill(r.m_b)) return -1;
    return m_rows.body(r.m_a.m_body).nodeOf(r.m_a.m_end);
}

bool RotatedAnchorFactor::isStillOne(int joint) const
{
    const ConstraintSide& end = row(joint).m_a;
    return m_rows.body(end.m_body).nodeOf(end.m_end) >= 0;
}

bool RotatedAnchorFactor::standsStill(const ConstraintSide& end) const
{
    if (end.m_body >= 0) return false;
    if (end.m_rigidProxy < 0) return true;
    const RigidProxy& rigidProxy = m_rows.problem().m_rigidProxies[end.m_rigidProxy];
    return rigidProxy.m_responseCount == 0 && !rigidProxy.canMove();
}

void RotatedAnchorFactor::addRun(Range joints)
{
    Run run;
    run.m_joints = joints;
    run.m_body = row(joints.m_begin).m_a.m_body;
    SoftBodyContacts& body = m_rows.body(run.m_body);
    m_nodes.assign(m_nodeOf.begin() + joints.m_begin, m_nodeOf.begin() + joints.m_end);
    run.m_factor = body.restFactorOf(m_nodes);
    for (int k = joints.m_begin; k < joints.m_end; ++k)
    {
        m_turn[k] = body.rotation(m_nodeOf[k]);
        m_runOf[k] = static_cast<int>(m_runs.size());
    }
    m_left += joints.m_end - joints.m_begin;
    m_runs.push_back(run);
}

void RotatedAnchorFactor::drop(int joint)
{
    Run& run = m_runs[m_runOf[joint]];
    std::fill(m_runOf.begin() + run.m_joints.m_begin, m_runOf.begin() + run.m_joints.m_end, -1);
    m_left -= run.m_joints.m_end - run.m_joints.m_begin;
    run.m_joints = {0, 0};
}

void RotatedAnchorFactor::dropAll()
{
    std::fill(m_runOf.begin(), m_runOf.end(), -1);
    m_runs.clear();
    m_left = 0;
}

// W^-1 = H (A0^-1)^-1 H^T / s, with the joints' axes and the nodes' rotations in H.
void RotatedAnchorFactor::solve(std::vector<double>& x) const
{
    for (const Run& run : m_runs)
    {
        if (run.m_joints.m_begin == run.m_joints.m_end) continue;
        const double inverseScale = 1 / m_rows.body(run.m_body).scale();
        for (int k = run.m_joints.m_begin; k < run.m_joints.m_end; ++k)
        {
            double* values = &x[3 * static_cast<std::size_t>(k)];
            Vec3 world;
            for (int i = 0; i < 3; ++i) world += values[i] * row(k).m_axes[i];
            const Vec3 atRest = transposeTimes(m_turn[k], world);
            for (int i = 0; i < 3; ++i) values[i] = atRest[i];
        }
        run.m_factor->solve(&x[3 * static_cast<std::size_t>(run.m_joints.m_begin)]);
        for (int k = run.m_joints.m_begin; k < run.m_joints.m_end; ++k)
        {
            double* values = &x[3 * static_cast<std::size_t>(k)];
            const Vec3 world = inverseScale * (m_turn[k] * Vec3{values[0], values[1], values[2]});
            for (int i = 0; i < 3; ++i) values[i] = dot(world, row(k).m_axes[i]);
        }
    }
}

}  // namespace bullet_fem
