// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/solver/joint_system.h"

#include <algorithm>
#include <cmath>

#include "fem/contact/contact_tuning.h"

namespace bullet_fem
{
namespace
{

constexpr double kNothing = 1e-7;      // negligible share of the speed scale
constexpr double kAtLimit = 1 - 1e-9;  // share of a limit that counts as the limit

double along(const ContactRow& row, int axis)
{
    return dot(row.m_impulse, row.m_axes[axis]);
}

// True if an impulse is at its maximum or minimum. 0 as minimum is reached exactly, as limits hold by clamping.
bool isAtLimit(const ContactRow& joint, int axis)
{
    const double component = along(joint, axis), lower = joint.m_lower[axis];
    return component >= kAtLimit * joint.m_limit[axis] || component <= (lower < 0 ? kAtLimit : 2 - kAtLimit) * lower;
}

// Clamps a joint's impulse to its limits, and marks the axes at a limit.
Vec3 withinLimits(const ContactRow& joint, Vec3 impulse, unsigned char* held)
{
    for (int i = 0; i < 3; ++i)
    {
        const double component = dot(impulse, joint.m_axes[i]);
        const double limited = std::clamp(component, joint.m_lower[i], joint.m_limit[i]);
        if (limited == component) continue;
        impulse += (limited - component) * joint.m_axes[i];
        held[i] = 1;
    }
    const double length = norm(impulse);
    if (!(length > joint.m_maxImpulse)) return impulse;
    std::fill_n(held, 3, static_cast<unsigned char>(1));
    return (joint.m_maxImpulse / length) * impulse;
}

}  // namespace

void JointSystem::begin()
{
    m_first = static_cast<int>(m_rows.problem().m_contacts.size());
    m_count = static_cast<int>(m_rows.problem().m_joints.size());
    m_partCount = 0;
    m_work = false;
    m_isLinear = false;
    m_turned.dropAll();
    if (isEmpty()) return;
    for (std::vector<double>* values : {&m_shift, &m_change}) values->assign(unknowns(), 0);
    m_isHeld.assign(unknowns(), 0);
    m_isIdle.assign(unknowns(), 0);
    m_patience = kPatience;
    ++m_changes;
    for (int k = 0; k < m_count; ++k)
    {
        ContactRow& joint = row(k);
        const bool atMost = norm(joint.m_impulse) >= kAtLimit * joint.m_maxImpulse;
        for (int i = 0; i < 3; ++i)
        {
            m_isIdle[3 * k + i] = joint.m_idle || !(joint.m_rowCompliance[i] > 0) ||
                                  !(joint.m_limit[i] > joint.m_lower[i]) ||
                                  !isFinite(joint.m_target);  // NaN is never applied
            m_isHeld[3 * k + i] = m_isIdle[3 * k + i] || atMost || isAtLimit(joint, i);
            joint.m_held = joint.m_held || (m_isHeld[3 * k + i] && !m_isIdle[3 * k + i]);
        }
    }
    m_turned.find(m_first, m_isHeld);
    chooseParts();
    m_isLinear = m_partCount == 1 && !m_turned.hasAny();
    for (int i = 0; i < unknowns(); ++i) m_isLinear = m_isLinear && !m_isHeld[i] && !isLimited(i / 3, i % 3);
    reform();
}

void JointSystem::reform()
{
    ++m_changes;  // records of the former system are obsolete
    for (int p = 0; p < m_partCount; ++p)
    {
        for (int k = m_parts[p].m_begin; k < m_parts[p].m_end; ++k)
            if (m_turned.has(k) && !m_turned.isStillOne(k)) dropTurned(m_parts[p], k);
        form(m_parts[p]);
    }
}

// The first joint with that owner: a body, or a movable rigid proxy with all that moves with it.
int JointSystem::firstWithOwner(const ConstraintSide& end, int joint)
{
    const ContactProblem& problem = m_rows.problem();
    int owner = end.m_body;
    if (end.m_body < 0)
    {
        if (end.m_rigidProxy < 0) return joint;
        const RigidProxy& rigidProxy = problem.m_rigidProxies[end.m_rigidProxy];
        if (rigidProxy.m_responseCount == 0 && !rigidProxy.canMove()) return joint;
        owner = end.m_rigidProxy;
        for (int k = 0; k < rigidProxy.m_responseCount; ++k)
            owner = std::min(owner, problem.m_responses[rigidProxy.m_firstResponse + k].m_rigidProxy);
        owner += static_cast<int>(problem.m_bodies.size());
    }
    int& first = m_firstOfOwner[owner];
    if (first < 0) first = joint;
    return first;
}

void JointSystem::chooseParts()
{
    const ContactProblem& problem = m_rows.problem();
    m_firstOfOwner.assign(problem.m_bodies.size() + problem.m_rigidProxies.size(), -1);
    m_profile.resize(m_count);
    double work = 0;
    for (int k = 0; k < m_count; ++k)
    {
        m_profile[k] = std::min(firstWithOwner(row(k).m_a, k), firstWithOwner(row(k).m_b, k));
        if (!m_turned.has(k)) work += EnvelopeFactor::work(k - m_profile[k] + 1);
    }
    if (work > kMaxJointWork) m_turned.dropAll();
    const int length = work > kMaxJointWork ? kJointsOfPart : m_count;
    for (int k = 0; k < m_count; k += length) addPart(k, std::min(k + length, m_count));
}

void JointSystem::addPart(int begin, int end)
{
    if (m_partCount == static_cast<int>(m_parts.size())) m_parts.emplace_back();
    Part& part = m_parts[m_partCount++];
    part.m_begin = begin;
    part.m_end = end;
    addRows(part);
}

void JointSystem::addRows(Part& part)
{
    part.m_factor.clear();
    for (int k = part.m_begin; k < part.m_end; ++k)
        part.m_factor.addRow(m_turned.has(k) ? k - part.m_begin : std::max(m_profile[k] - part.m_begin, 0));
}

// The body's other joints are dropped with it: records of the former system are obsolete.
void JointSystem::dropTurned(Part& part, int joint)
{
    m_turned.drop(joint);
    ++m_changes;
    addRows(part);
    form(part);
}

Mat3 JointSystem::between(const ContactRow& a, const ContactRow& b) const
{
    return m_rows.compliance(a.m_a, b.m_a) + m_rows.compliance(a.m_b, b.m_b) - m_rows.compliance(a.m_a, b.m_b) -
           m_rows.compliance(a.m_b, b.m_a);
}

void JointSystem::form(Part& part)
{
    for (int k = part.m_begin; k < part.m_end; ++k)
        for (int j = part.m_begin + part.m_factor.first(k - part.m_begin); j <= k; ++j)
        {
            Mat3 block = Mat3::identity();
            if (m_turned.has(k))
            {
                part.m_factor.set(k - part.m_begin, j - part.m_begin, block);
                continue;
            }
            const ContactRow &a = row(k), &b = row(j);
            const Mat3 w = between(a, b);
            for (int i = 0; i < 3; ++i)
                for (int l = 0; l < 3; ++l) block(i, l) = dot(a.m_axes[i], w * b.m_axes[l]);
            for (int i = 0; j == k && i < 3; ++i) block(i, i) += a.m_yield[i];
            part.m_factor.set(k - part.m_begin, j - part.m_begin, block);
        }
    part.m_stale = true;
}

double JointSystem::residual(int joint, int axis, const Vec3& velocity) const
{
    const ContactRow& r = row(joint);
    return r.m_target[axis] + m_shift[3 * joint + axis] - dot(r.m_axes[axis], velocity) -
           r.m_yield[axis] * along(r, axis);
}

void JointSystem::residual(std::vector<double>& e) const
{
    for (int k = 0; k < m_count; ++k)
    {
        const Vec3 v = m_rows.velocity(row(k));
        for (int i = 0; i < 3; ++i) e[3 * k + i] = m_isHeld[3 * k + i] ? 0 : residual(k, i, v);
    }
}

void JointSystem::answer(std::vector<double>& x)
{
    for (int p = 0; p < m_partCount; ++p) answer(m_parts[p], x);
}

void JointSystem::answer(Part& part, std::vector<double>& x)
{
    const std::size_t first = 3 * static_cast<std::size_t>(part.m_begin);
    if (part.m_stale) part.m_factor.factor(&m_isHeld[first]);
    part.m_stale = false;
    part.m_factor.solve(&x[first]);
    if (m_turned.hasAny()) m_turned.solve(x);
}

void JointSystem::shift(const std::vector<double>* by)
{
    if (by)
        m_shift.assign(by->begin(), by->end());
    else
        m_shift.assign(unknowns(), 0);
}

double JointSystem::solve()
{
    double left = 0;
    for (int p = 0; p < m_partCount; ++p) left = std::max(left, solvePart(m_parts[p]));
    return left;
}

// Sweeps held joints once, then solves the others at once, repeatedly while one of them exceeds its limit.
double JointSystem::solvePart(Part& part)
{
    double held = 0, missed = 0;
    for (int k = part.m_begin; k < part.m_end; ++k) held = std::max(held, sweepHeld(part, k));
    do
    {
        follow();
        missed = missBy(part);
        if (!(missed > kNothing * m_rows.speedScale())) return held;
        answer(part, m_change);
    } while (holdBeyondLimits(part, held));
    double largest = takeChanges(part);
    follow();
    if (m_turned.hasAny()) largest = std::max(largest, refine(part, missed));
    return m_partCount > 1 ? std::max(held, largest) : held;
}

// Computes the residual of the sides' velocities, and returns its maximum [m/s].
double JointSystem::missBy(const Part& part)
{
    double largest = 0;
    for (int k = part.m_begin; k < part.m_end; ++k)
    {
        const Vec3 v = m_rows.velocity(row(k));
        for (int i = 0; i < 3; ++i)
        {
            m_change[3 * k + i] = m_isHeld[3 * k + i] ? 0 : residual(k, i, v);
            largest = std::max(largest, std::fabs(m_change[3 * k + i]));
        }
    }
    return largest;
}

// A factor of an earlier step leaves the single-precision error of the rotated W, for the next sweep; if it leaves
// more, as for a nearly singular system, it is not used again in this step.
double JointSystem::refine(Part& part, double missed)
{
    const double left = missBy(part);
    if (!(left > std::max(kNothing * m_rows.speedScale(), kMisleads * missed))) return 0;
    for (int k = part.m_begin; k < part.m_end; ++k)
        if (m_turned.has(k)) dropTurned(part, k);
    answer(part, m_change);
    const double largest = takeChanges(part);
    follow();
    return largest;
}

// Velocities of dense bodies follow immediately at sides in the working set.
void JointSystem::follow()
{
    if (!m_rows.isDense() || !m_work) m_rows.flush();
}

double JointSystem::sweepHeld(Part& part, int joint)
{
    const auto isSwept = [&](int i) { return m_isHeld[3 * joint + i] && !m_isIdle[3 * joint + i]; };
    if (!isSwept(0) && !isSwept(1) && !isSwept(2)) return 0;
    ContactRow& r = row(joint);
    const Vec3 wanted = wantedImpulse(r, r.m_impulse, m_rows.velocity(r), 1);
    Vec3 impulse = r.m_impulse;
    for (int i = 0; i < 3; ++i)
        if (isSwept(i)) impulse += (dot(wanted, r.m_axes[i]) - along(r, i)) * r.m_axes[i];
    const double change = speedOf(r, impulse - r.m_impulse);
    m_rows.change(r, impulse);
    const bool isWithin = norm(impulse) < kAtLimit * r.m_maxImpulse;
    for (int i = 0; i < 3; ++i)
    {
        if (!isSwept(i) || m_patience == 0) continue;
        if (!isWithin || isAtLimit(r, i)) continue;
        m_isHeld[3 * joint + i] = 0;
        part.m_stale = true;
        --m_patience;
        ++m_changes;
    }
    r.m_held = false;
    for (int i = 3 * joint; i < 3 * joint + 3; ++i) r.m_held = r.m_held || (m_isHeld[i] && !m_isIdle[i]);
    return change;
}

Vec3 JointSystem::changeOf(int joint) const
{
    Vec3 change;
    for (int i = 0; i < 3; ++i) change += m_change[3 * joint + i] * row(joint).m_axes[i];
    return change;
}

bool JointSystem::isBeyondLimits(const ContactRow& joint, const Vec3& impulse) const
{
    bool isBeyond = norm(impulse) > joint.m_maxImpulse;
    for (int i = 0; i < 3; ++i)
    {
        const double component = dot(impulse, joint.m_axes[i]);
        isBeyond = isBeyond || component > joint.m_limit[i] || component < joint.m_lower[i];
    }
    return isBeyond;
}

// Clamps joints whose changes would exceed their limits, and holds them. True if there are any, and all must be solved
// again.
bool JointSystem::holdBeyondLimits(Part& part, double& largest)
{
    bool any = false;
    for (int k = part.m_begin; k < part.m_end && m_patience > 0; ++k)
    {
        ContactRow& r = row(k);
        Vec3 impulse = r.m_impulse + changeOf(k);
        unsigned char* held = &m_isHeld[3 * static_cast<std::size_t>(k)];
        if ((held[0] && held[1] && held[2]) || !isBeyondLimits(r, impulse)) continue;
        any = r.m_held = true;
        impulse = withinLimits(r, impulse, held);
        largest = std::max(largest, speedOf(r, impulse - r.m_impulse));
        m_rows.change(r, impulse);
        if (m_turned.has(k)) dropTurned(part, k);
        --m_patience;
        ++m_changes;
    }
    if (m_patience == 0) any = holdLimited(part) || any;
    part.m_stale = part.m_stale || any;
    return any;
}

// Clamping unknowns that were solved at once may diverge: from here on, all that have limits are swept. True if one was
// not.
bool JointSystem::holdLimited(const Part& part)
{
    bool any = false;
    for (int k = part.m_begin; k < part.m_end; ++k)
    {
        for (int i = 0; i < 3; ++i)
        {
            if (!isLimited(k, i) || m_isHeld[3 * k + i]) continue;
            m_isHeld[3 * k + i] = 1;
            any = row(k).m_held = true;
        }
    }
    if (any) ++m_changes;
    return any;
}

bool JointSystem::isLimited(int joint, int axis) const
{
    const ContactRow& r = row(joint);
    return r.m_maxImpulse < Joint::kUnlimited || r.m_limit[axis] < Joint::kUnlimited ||
           r.m_lower[axis] > -Joint::kUnlimited;
}

// Limits are enforced even if m_patience is used up.
double JointSystem::takeChanges(const Part& part)
{
    double largest = 0;
    for (int k = part.m_begin; k < part.m_end; ++k)
    {
        ContactRow& r = row(k);
        unsigned char held[3];
        const Vec3 impulse = withinLimits(r, r.m_impulse + changeOf(k), held);
        if (!isFinite(impulse)) continue;
        largest = std::max(largest, speedOf(r, impulse - r.m_impulse));
        m_rows.change(r, impulse);
    }
    return largest;
}

}  // namespace bullet_fem
