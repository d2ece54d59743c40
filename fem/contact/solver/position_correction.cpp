// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/solver/position_correction.h"

#include <algorithm>
#include <utility>

#include "fem/contact/contact_tuning.h"

namespace bullet_fem
{
namespace
{

// A tenth of the contact tolerance, within a bound.
double pushTolerance(double contactTolerance)
{
    return std::max(0.1 * contactTolerance, kPushTolerance);
}

// Separation speed that corrects a penetration [m/s].
double pushSpeed(const ContactPoint& contact, const ContactSettings& settings)
{
    const double depth = std::max(0.0, -contact.m_gap - contact.m_slop);
    const double share = std::min(settings.m_pushFraction * contact.m_hardness, 1.0);
    return std::min(share * depth / settings.m_step.m_step, settings.m_maxPushVelocity);
}

// The displacement of a rigid proxy by position correction, h pushLinear, also changes its angular momentum; its spin
// then changes by the sum of all. For articulated proxies the caller, who knows the joints, forms the sum.
void payBackOwn(RigidProxy& rigidProxy, double h)
{
    if (rigidProxy.m_responseCount > 0) return;
    const Vec3& w = rigidProxy.m_inverseMass;
    if (!(w.x > 0 && w.y > 0 && w.z > 0))
    {
        rigidProxy.m_angularImpulse = {};
        return;
    }
    const Vec3 momentum = {rigidProxy.m_linearVelocity.x / w.x, rigidProxy.m_linearVelocity.y / w.y,
                           rigidProxy.m_linearVelocity.z / w.z};
    rigidProxy.m_angularImpulse -= cross(h * rigidProxy.m_pushLinear, momentum);
    rigidProxy.m_angularVelocity += rigidProxy.m_inverseInertia * rigidProxy.m_angularImpulse;
}

}  // namespace

void PositionCorrection::begin()
{
    const ContactProblem& problem = m_rows.problem();
    m_own.reserve(problem.m_rigidProxies.size());
    m_base.reserve(m_rows.rows().size());
    m_step = m_rows.settings().m_step.m_step;
    m_pushed.reserve(problem.m_bodies.size());
}

bool PositionCorrection::isNeeded() const
{
    const std::vector<ContactPoint>& contacts = m_rows.problem().m_contacts;
    const double negligible = pushTolerance(m_rows.settings().m_tolerance) * m_rows.loadSpeed();
    if (lags()) return true;
    return std::any_of(contacts.begin(), contacts.end(),
                       [&](const ContactPoint& c)
                       {
                           return c.m_gap < -c.m_slop && pushSpeed(c, m_rows.settings()) > negligible &&
                                  !(c.m_stiffness > 0 || c.m_damping > 0);
                       });
}

// Nodes move with the mean of the velocities before and after an impulse, but should end where its row requires. True
// if they do not.
bool PositionCorrection::lags() const
{
    const ContactProblem& problem = m_rows.problem();
    const double negligible = pushTolerance(m_rows.settings().m_tolerance) * m_rows.speedScale();
    const std::size_t contacts = problem.m_contacts.size(), joints = problem.m_joints.size();
    for (std::size_t k = 0; k < contacts + joints; ++k)
    {
        const ContactRow& row = m_rows.rows()[k];
        if (row.m_idle || row.m_yield.x > 0 || !(m_rows.theta(row) < 1)) continue;
        const Vec3 mean = m_rows.meanVelocity(row);
        if (k < contacts)
        {
            const double closes = m_rows.closedByArc(row) / m_step;
            if (closes - dot(row.m_axes[0], mean) - std::max(problem.m_contacts[k].m_gap, 0.0) / m_step > negligible)
                return true;
        }
        else if (norm(lagOf(row, problem.m_joints[k - contacts])) > negligible)
            return true;
    }
    return false;
}

// Additional speed along the axes of a rigid joint for its sides to reach their target [m/s].
Vec3 PositionCorrection::lagOf(const ContactRow& row, const Joint& joint) const
{
    Vec3 lag;
    if (!(m_rows.theta(row) < 1) || row.m_yield.x > 0 || joint.m_maxImpulse < Joint::kUnlimited) return lag;
    const Vec3 mean = m_rows.meanVelocity(row);
    for (int i = 0; i < 3; ++i)
        if (joint.m_limit[i] >= Joint::kUnlimited && joint.m_lower[i] <= -Joint::kUnlimited)
            lag[i] = joint.m_wanted[i] - dot(row.m_axes[i], mean);
    return lag;
}

// From here on all velocities are those of the position correction, and impulses are additions to the share that moves
// the nodes anyway.
void PositionCorrection::prepare()
{
    const std::vector<ContactPoint>& contacts = m_rows.problem().m_contacts;
    m_base.assign(m_rows.rows().size(), Vec3());
    m_rows.forEachChunk(
        [&](int, Range rows)
        {
            for (int k = rows.m_begin; k < rows.m_end; ++k)
            {
                ContactRow& row = m_rows.rows()[k];
                const bool isContact = k < static_cast<int>(contacts.size());
                if (isContact)
                    prepareContact(contacts[k], row);
                else
                    row.m_target = {};
                row.m_idle = row.m_idle || row.m_torsion;  // excluded from displacements
                if (isContact) m_base[k] = (1 - m_rows.theta(row)) * row.m_impulse;
                row.m_impulse = m_base[k];
            }
        });
    prepareJoints();
    prepareContacts();
    std::vector<RigidProxy>& rigidProxies = m_rows.problem().m_rigidProxies;
    m_own.assign(rigidProxies.begin(), rigidProxies.end());
    for (RigidProxy& rigidProxy : rigidProxies) rigidProxy.m_linearVelocity = rigidProxy.m_angularVelocity = {};
    m_rows.forEachContactBody(m_rows.threadsForCompliance(), [this](int b) { m_rows.body(b).beginPush(); });
    m_sweeps.reset();
}

// Penetrating points must separate at a share of their depth per step, unless they do so already; the others must not
// close their gap, and joints hold.
void PositionCorrection::prepareContact(const ContactPoint& c, ContactRow& row) const
{
    const double h = m_step;
    const Vec3 mean = m_rows.meanVelocity(row);
    const double moving = dot(c.m_normal, mean);
    const double theta = m_rows.theta(row);
    const double left = theta * std::min(dot(c.m_normal, m_rows.velocity(row)), 0.0);  // for the rows
    const double closes = m_rows.closedByArc(row) / h;
    row.m_target.x =
        closes + (c.m_gap < 0 ? pushSpeed(c, m_rows.settings()) - (moving - left) : -(moving + c.m_gap / h));
    if (theta < 1)
    {
        const Vec3 moves = mean + (1 / h) * (m_rows.arcOf(row) - m_rows.arcOfMean(row));
        for (int i = 1; i < 3; ++i) row.m_target[i] -= dot(row.m_axes[i], moves);
    }
    else
        row.m_target.y = row.m_target.z = row.m_friction = 0;
    row.m_idle = row.m_idle || row.m_yield.x > 0;
}

void PositionCorrection::prepareJoints()
{
    std::size_t k = m_rows.problem().m_contacts.size();
    for (const Joint& joint : m_rows.problem().m_joints)
    {
        ContactRow& row = m_rows.rows()[k++];
        row.m_target = lagOf(row, joint);
    }
}

// A rigid proxy on a floor is not pushed into it: the soft body moves the whole distance. Penetration between rigid
// bodies is corrected by the rigid solver.
void PositionCorrection::prepareContacts()
{
    const ContactProblem& problem = m_rows.problem();
    std::size_t k = problem.m_contacts.size() + problem.m_joints.size();
    for (const RigidContact& touch : problem.m_rigidContacts)
    {
        ContactRow& row = m_rows.rows()[k++];
        const double left = touch.m_gap / m_rows.settings().m_step.m_step +
                            (touch.m_moves ? dot(touch.m_normal, m_rows.velocity(row) - touch.m_otherVelocity) : 0);
        row.m_target.x = -std::max(left, 0.0);
        row.m_friction = 0;
    }
}

int PositionCorrection::push()
{
    m_sweeps.measure();
    prepare();
    m_rows.setSpeedScale(m_sweeps.look().m_wanted);
    int sweeps = 1;
    const double tolerance = pushTolerance(m_rows.settings().m_tolerance);
    for (; m_sweeps.sweep(tolerance) && sweeps < kMaxOtherSweeps; ++sweeps)
        if (m_sweeps.runsAway()) m_sweeps.letGo();
    std::vector<RigidProxy>& rigidProxies = m_rows.problem().m_rigidProxies;
    for (std::size_t k = 0; k < rigidProxies.size(); ++k)
    {
        std::swap(rigidProxies[k], m_own[k]);
        rigidProxies[k].m_pushLinear = m_own[k].m_linearVelocity;
        rigidProxies[k].m_pushAngular = m_own[k].m_angularVelocity;
    }
    sumImpulses();
    const StepSettings& step = m_rows.settings().m_step;
    m_pushed.assign(m_rows.problem().m_bodies.size(), {});
    m_rows.forEachContactBody(step.m_threads,
                              [&](int b) { m_pushed[b].m_gained = m_rows.body(b).applyPositionCorrection(step); });
    payBack();
    for (RigidProxy& rigidProxy : rigidProxies) payBackOwn(rigidProxy, m_step);
    return sweeps;
}

// Articulated proxies receive the impulses of the push, which their joints distribute.
void PositionCorrection::sumImpulses()
{
    const auto add = [this](const ConstraintSide& end, const Vec3& impulse)
    {
        if (end.m_rigidProxy < 0) return;
        RigidProxy& rigidProxy = m_rows.problem().m_rigidProxies[end.m_rigidProxy];
        if (rigidProxy.m_responseCount == 0) return;
        if (!end.m_angular) rigidProxy.m_pushImpulse += impulse;
        rigidProxy.m_pushAngularImpulse += end.m_angular ? impulse : cross(end.m_arm, impulse);
    };
    const std::vector<ContactRow>& rows = m_rows.rows();
    for (std::size_t k = 0; k < rows.size(); ++k)
    {
        add(rows[k].m_a, pushOf(k));
        add(rows[k].m_b, -pushOf(k));
    }
}

// Displacing a moving body changes its angular momentum about the origin. The movable rigid proxies that it was pushed
// off receive the opposite, in proportion to the push; for pushes between soft bodies, its own spin changes.
void PositionCorrection::payBack()
{
    const auto visitBodies = [this](auto visit)
    {
        const std::vector<ContactRow>& rows = m_rows.rows();
        for (std::size_t k = 0; k < rows.size(); ++k)
        {
            const double size = norm(pushOf(k));
            if (size == 0) continue;
            const int a = rows[k].m_a.m_body, b = rows[k].m_b.m_body;
            if (a >= 0) visit(m_pushed[a], rows[k].m_b, size);
            if (b >= 0 && b != a) visit(m_pushed[b], rows[k].m_a, size);
        }
    };
    visitBodies(
        [](Pushed& pushed, const ConstraintSide& other, double size)
        {
            pushed.m_total += size;
            if (other.m_body >= 0) pushed.m_bySoft += size;
        });
    visitBodies(
        [&](const Pushed& pushed, const ConstraintSide& other, double size)
        {
            if (other.m_rigidProxy < 0 || !(pushed.m_total > 0)) return;
            RigidProxy& rigidProxy = m_rows.problem().m_rigidProxies[other.m_rigidProxy];
            if (rigidProxy.canMove()) rigidProxy.m_angularImpulse -= (size / pushed.m_total) * pushed.m_gained;
        });
    m_rows.forEachContactBody(m_rows.threadsForCompliance(),
                              [this](int b)
                              {
                                  const Pushed& p = m_pushed[b];
                                  if (p.m_total > 0)
                                      m_rows.body(b).spin(-(p.m_bySoft / p.m_total) * p.m_gained,
                                                          m_rows.settings().m_step);
                              });
}

}  // namespace bullet_fem
