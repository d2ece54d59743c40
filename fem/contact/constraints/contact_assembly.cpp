// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <algorithm>
#include <cmath>
#include <limits>

#include "fem/body/step_scratch.h"
#include "fem/contact/constraints/contact_rows.h"
#include "fem/contact/constraints/rigid_response.h"

namespace bullet_fem
{
namespace
{

constexpr double kForgotten = 1e-6;  // share of the slowest speed below which a warm start is dropped [-]

}  // namespace

// The normal, a perpendicular unit vector, and their cross product.
void ContactRows::setAxes(const Vec3& n, ContactRow& row)
{
    const Vec3 tangent = cross(std::fabs(n.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}, n);
    row.m_axes[0] = n;
    row.m_axes[1] = (1 / norm(tangent)) * tangent;
    row.m_axes[2] = cross(n, row.m_axes[1]);
}

void ContactRows::assemble(ContactProblem& problem, const ContactSettings& settings, double floor)
{
    m_problem = &problem;
    m_settings = settings;
    m_dense = true;
    if (m_bodies.size() < problem.m_bodies.size()) m_bodies.resize(problem.m_bodies.size());
    m_corrections.assign(problem.m_bodies.size(), ImpulseResponse());
    for (std::size_t b = 0; b < problem.m_bodies.size(); ++b) m_bodies[b].clear(problem.m_bodies[b], settings.m_step);
    addContactRows();
    for (std::size_t k = 0; k < problem.m_joints.size(); ++k) addJointRow(problem.m_joints[k], &m_jointPoints[2 * k]);
    for (const RigidContact& touch : problem.m_rigidContacts) addRigidContactRow(touch);
    for (const TorsionalFriction& torsion : problem.m_torsions) addTorsionRow(torsion);
    m_wants.assign(m_rows.size(), 0);
    forEachContactBody(threadsForCompliance(),
                       [&](int b) { m_bodies[b].assemble(settings.m_denseLimit, settings.m_step.m_step); });
    m_loadSpeed = 0;
    m_largestWanted = 0;
    m_shortestEdge = std::numeric_limits<double>::max();
    for (std::size_t b = 0; b < problem.m_bodies.size(); ++b)
    {
        if (m_bodies[b].size() == 0) continue;
        m_bodies[b].request(settings.m_step.m_threads);
        m_dense = m_dense && m_bodies[b].isDense();
        m_loadSpeed = std::max(m_loadSpeed, m_bodies[b].loadSpeed());
        m_shortestEdge = std::min(m_shortestEdge, m_bodies[b].body().m_model->mesh().meanEdgeLength());
    }
    forEachContactBody(threadsForCompliance(), [this](int b) { m_bodies[b].form(); });
    finishRows();
    const double least = kForgotten * slowestSpeed();
    for (ContactRow& row : m_rows)  // warm starts that no sweep would ever change
        if (!row.m_joint && (row.m_idle || speedOf(row, row.m_impulse) < least)) row.m_impulse = {};
    pressOnTorsions();
    pushStarts(true);
    runTasks(settings.m_step.m_threads, static_cast<int>(problem.m_bodies.size()),
             [&](int b)
             {
                 if (m_bodies[b].expects()) m_bodies[b].takeExpected(settings.m_step, floor);
             });
    measure();
    forEachChunk(
        [&](int, Range rows)
        {
            const int end = std::min(rows.m_end, static_cast<int>(problem.m_contacts.size()));
            for (int k = rows.m_begin; k < end; ++k) setContactTarget(m_rows[k], problem.m_contacts[k]);
        });
    for (ContactRow& row : m_rows)
        if (row.m_joint) setJointTarget(row);
    pushStarts(false);
}

// Applies the initial impulses to the sides that expect them, or to the others.
void ContactRows::pushStarts(bool expected)
{
    const auto push = [&](const ConstraintSide& end, const Vec3& impulse)
    {
        if (end.m_body < 0) return;
        SoftBodyContacts& body = m_bodies[end.m_body];
        if (body.isExpected(end.m_end) == expected) body.push(end.m_end, impulse);
    };
    for (const ContactRow& row : m_rows)
    {
        push(row.m_a, row.m_impulse);
        push(row.m_b, -row.m_impulse);
    }
}

// Sides are numbered in the order of the contacts; the rest of a row is independent of other rows.
void ContactRows::addContactRows()
{
    const std::vector<ContactPoint>& contacts = m_problem->m_contacts;
    const auto number = [this](const SurfacePoint& point)
    { return point.m_body >= 0 ? m_bodies[point.m_body].addPoint() : -1; };
    m_rows.resize(contacts.size());
    for (std::size_t k = 0; k < contacts.size(); ++k)
    {
        m_rows[k].m_a.m_end = number(contacts[k].m_soft);
        m_rows[k].m_b.m_end = contacts[k].m_rigidProxy >= 0 ? -1 : number(contacts[k].m_other);
    }
    numberJointPoints();
    runTasks(threadsForCompliance(), static_cast<int>(m_problem->m_bodies.size()),
             [this](int b) { m_bodies[b].makeRoom(); });
    forEachChunk(
        [&](int, Range rows)
        {
            for (int k = rows.m_begin; k < rows.m_end; ++k)
            {
                setContactRow(m_rows[k], contacts[k]);
                m_problem->m_contacts[k].m_arm = m_rows[k].m_b.m_arm;
            }
        });
}

// True for joint sides that move as a weighted mean of nodes whose columns the body has, for which it solves.
bool ContactRows::isPoint(const JointEnd& end) const
{
    if (end.m_body < 0 || end.m_count > SurfacePoint::kMaxNodes) return false;
    for (int k = end.m_first; k < end.m_first + end.m_count; ++k)
    {
        const Mat3& block = m_problem->m_handleBlocks[k];
        if (!m_bodies[end.m_body].serves(m_problem->m_handleNodes[k])) return false;
        if (squaredNorm(block - Mat3::diagonal(block(0, 0))) > 0) return false;
    }
    return true;
}

void ContactRows::numberJointPoints()
{
    for (std::size_t b = 0; b < m_problem->m_bodies.size(); ++b) m_bodies[b].beginJoints();
    m_jointPoints.clear();
    for (const Joint& joint : m_problem->m_joints)
        for (const JointEnd* end : {&joint.m_a, &joint.m_b})
            m_jointPoints.push_back(isPoint(*end) ? m_bodies[end->m_body].addPoint() : -1);
}

// A movable rigid proxy and the soft side have one point of action: the soft side's distance to it becomes a spin
// (SoftBodyContacts::addLevers).
void ContactRows::setContactRow(ContactRow& row, const ContactPoint& contact)
{
    const Vec3 at = impulsePoint(contact, contact.m_patch);
    const bool moves = contact.m_rigidProxy >= 0 && m_problem->m_rigidProxies[contact.m_rigidProxy].canMove();
    const Vec3 ofRigid = moves ? at : impulsePoint(contact, Vec3());
    const Vec3 atRigid = (contact.m_isMetLater ? contact.m_point + contact.m_patch : ofRigid) + contact.m_approach;
    const ConstraintSide a = softEnd(contact.m_soft, moves ? atRigid : at, row.m_a.m_end);
    const ConstraintSide b = contact.m_rigidProxy >= 0 ? rigidEnd(contact.m_rigidProxy, atRigid)
                                                       : softEnd(contact.m_other, at, row.m_b.m_end);
    row = ContactRow();
    row.m_a = a;
    row.m_b = b;
    setAxes(contact.m_normal, row);
    row.m_friction = contact.m_friction;
    row.m_impulse = contact.m_impulse;
}

// Point of action of the impulse on both sides, such that total angular momentum is conserved. With implicit Euler the
// impulse represents the forces at the end of the step, and the patch's origin is given by m_patch; otherwise the
// forces at a share theta of the step, at the nodes' positions then, or, for contacts that begin at the end of the
// step, those at its end. Soft bodies measure lever arms from their positions y at 1 - theta, rigid ones from their
// initial positions: the point is nearer to the choice of the lighter side.
Vec3 ContactRows::impulsePoint(const ContactPoint& contact, const Vec3& patch) const
{
    const double theta = this->theta(contact.m_soft.m_body, contact.m_rigidProxy < 0 ? contact.m_other.m_body : -1);
    const double ahead = (1 - theta) * m_settings.m_step.m_step;
    const bool isNew = contact.m_gap > contact.m_slop;
    const Vec3 at = contact.m_point + (isNew ? theta : 2 * theta - 1) * patch;
    if (!(ahead > 0)) return at;
    const auto velocity = [this](const SurfacePoint& p)
    { return p.of(m_problem->m_bodies[p.m_body].m_body->m_state.m_v); };
    if (contact.m_rigidProxy < 0) return at + 0.5 * ahead * (velocity(contact.m_soft) + velocity(contact.m_other));
    const Vec3& w = m_problem->m_rigidProxies[contact.m_rigidProxy].m_inverseMass;
    const double share = 1 / (1 + m_bodies[contact.m_soft.m_body].mass() * std::max({w.x, w.y, w.z}));
    return at + share * ahead * velocity(contact.m_soft);
}

void ContactRows::addJointRow(const Joint& joint, const int* points)
{
    ContactRow row;
    row.m_joint = true;
    row.m_a = jointEnd(joint.m_a, actsAtStart(joint.m_a, joint.m_b), points[0]);
    row.m_b = jointEnd(joint.m_b, actsAtStart(joint.m_b, joint.m_a), points[1]);
    for (int i = 0; i < 3; ++i) row.m_axes[i] = joint.m_axes[i];
    row.m_target = joint.m_wanted;
    row.m_limit = joint.m_limit;
    for (int i = 0; i < 3; ++i) row.m_lower[i] = std::max(-joint.m_limit[i], joint.m_lower[i]);
    row.m_maxImpulse = joint.m_maxImpulse;
    row.m_softness = joint.m_softness;
    row.m_spring = joint.m_compliance;
    for (int i = 0; i < 3 && isFinite(joint.m_impulse); ++i)
        row.m_impulse +=
            std::clamp(dot(joint.m_impulse, row.m_axes[i]), row.m_lower[i], row.m_limit[i]) * row.m_axes[i];
    m_rows.push_back(row);
}

ConstraintSide ContactRows::softEnd(const SurfacePoint& point, const Vec3& at, int end)
{
    ConstraintSide row;
    row.m_body = point.m_body;
    row.m_end = end;
    if (point.m_body >= 0) m_bodies[point.m_body].setPoint(end, point, at);
    return row;
}

// An impulse does no work in a joint that acts at the positions y, which the velocities refer to. Two soft bodies of
// one theta have these in common. Movable proxies, and soft bodies of another theta, measure levers elsewhere; only
// their position at the beginning of the step is common to both, so that momentum requires it.
bool ContactRows::actsAtStart(const JointEnd& end, const JointEnd& other) const
{
    if (end.m_body < 0) return false;
    if (other.m_body >= 0) return m_bodies[other.m_body].theta() != m_bodies[end.m_body].theta();
    return other.m_rigidProxy >= 0 && m_problem->m_rigidProxies[other.m_rigidProxy].canMove();
}

ConstraintSide ContactRows::jointEnd(const JointEnd& joint, bool actsAtStart, int number)
{
    if (joint.m_body < 0)
    {
        ConstraintSide end = rigidEnd(joint.m_rigidProxy, joint.m_point);
        end.m_angular = joint.m_angular;
        end.m_jacobian = joint.m_jacobian;
        return end;
    }
    m_problem->m_bodies[joint.m_body].m_body->m_workspace.scratch().m_isJoined = true;
    if (number >= 0)
    {
        SurfacePoint point;
        point.m_body = joint.m_body;
        point.m_count = joint.m_count;
        for (int k = 0; k < joint.m_count; ++k)
        {
            point.m_nodes[k] = m_problem->m_handleNodes[joint.m_first + k];
            point.m_weights[k] = m_problem->m_handleBlocks[joint.m_first + k](0, 0);
        }
        const Body& body = *m_problem->m_bodies[joint.m_body].m_body;
        const std::vector<Vec3>& x = actsAtStart ? body.m_state.m_x : body.m_workspace.scratch().m_kickPosition;
        return softEnd(point, point.of(x), number);
    }
    ConstraintSide end;
    end.m_body = joint.m_body;
    end.m_end =
        m_bodies[joint.m_body].addGroup(m_problem->m_handleNodes.data() + joint.m_first,
                                        m_problem->m_handleBlocks.data() + joint.m_first, joint.m_count, actsAtStart);
    return end;
}

ConstraintSide ContactRows::rigidEnd(int rigidProxy, const Vec3& point) const
{
    ConstraintSide end;
    end.m_rigidProxy = rigidProxy;
    if (rigidProxy >= 0) end.m_arm = point - m_problem->m_rigidProxies[rigidProxy].m_center;
    return end;
}

Mat3 ContactRows::compliance(const ConstraintSide& of, const ConstraintSide& from) const
{
    if (from.m_body >= 0)
        return of.m_body == from.m_body ? m_bodies[of.m_body].compliance(of.m_end, from.m_end) : Mat3();
    if (from.m_rigidProxy < 0 || of.m_rigidProxy < 0) return {};
    return rigidCompliance(*m_problem, of, from);
}

void ContactRows::finishRows()
{
    forEachChunk(
        [this](int, Range rows)
        {
            for (int k = rows.m_begin; k < rows.m_end; ++k) finishRow(m_rows[k]);
        });
}

void ContactRows::finishRow(ContactRow& row) const
{
    row.m_compliance = compliance(row.m_a, row.m_a) + compliance(row.m_b, row.m_b);
    if (row.m_a.m_body >= 0 && row.m_a.m_body == row.m_b.m_body)
    {
        const Mat3 between = compliance(row.m_a, row.m_b);
        row.m_compliance -= between + transpose(between);
    }
    Vec3 w[3];
    for (int i = 0; i < 3; ++i) w[i] = row.m_compliance * row.m_axes[i];
    for (int i = 0; i < 3; ++i) row.m_rowCompliance[i] = dot(row.m_axes[i], w[i]);
    row.m_idle = !(row.m_rowCompliance.x > 0);
    if (row.m_joint || row.m_torsion)
        row.m_idle = !(trace(row.m_compliance) > 0);
    else
    {
        // A compliance that is isotropic in the tangent plane makes friction opposite to the sliding velocity.
        const double a = row.m_rowCompliance.y, b = row.m_rowCompliance.z, c = dot(row.m_axes[1], w[2]);
        row.m_rowCompliance.y = row.m_rowCompliance.z = 0.5 * (a + b) + std::sqrt(0.25 * (a - b) * (a - b) + c * c);
        if (!(row.m_rowCompliance.y > 0)) row.m_rowCompliance.y = row.m_rowCompliance.z = row.m_rowCompliance.x;
        if (row.m_touch) limitContactFriction(row);
    }
    if (!m_dense && !row.m_joint)
    {
        const double largest = std::max({row.m_rowCompliance.x, row.m_rowCompliance.y, row.m_rowCompliance.z});
        row.m_rowCompliance = {largest, largest, largest};
    }
    if (row.m_joint)
        row.m_yield = row.m_softness * row.m_rowCompliance + Vec3{row.m_spring, row.m_spring, row.m_spring};
}

// Joints want a displacement, of which the arcs of turning bodies are a part.
void ContactRows::setJointTarget(ContactRow& row) const
{
    const Vec3 arc = (1 / m_settings.m_step.m_step) * softArc(row);
    for (int i = 0; i < 3; ++i) row.m_target[i] -= dot(arc, row.m_axes[i]);
}

void ContactRows::setContactTarget(ContactRow& row, const ContactPoint& contact) const
{
    const double h = m_settings.m_step.m_step;
    const Vec3 soft = softArc(row), arc = arcOf(row) - soft;
    const double closes = closedByArc(row);
    row.m_target.x = (closes - std::max(contact.m_gap + dot(soft, row.m_axes[0]), 0.0)) / h;
    for (int i = 1; i < 3; ++i)
        row.m_target[i] =
            (dot(arc, row.m_axes[i]) - m_settings.m_slipFraction * dot(contact.m_slip, row.m_axes[i])) / h;
    if (contact.m_stiffness > 0 || contact.m_damping > 0)
    {
        // Implicit spring and damper: lambda = h (-k (gap + h v) - d v).
        const double k = contact.m_stiffness, s = h * k + contact.m_damping;
        row.m_yield.x = 1 / (h * s);
        if (contact.m_gap < closes) row.m_target.x = k * (closes - contact.m_gap) / s;
    }
}

}  // namespace bullet_fem
