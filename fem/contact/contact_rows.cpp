// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/contact_rows.h"

#include <algorithm>

#include "bullet_fem/fem/stepping.h"

namespace bullet_fem
{
namespace
{

// A unit vector at a right angle to n, and n x it.
void makeTangents(const Vec3& n, Vec3& first, Vec3& second)
{
    const Vec3 axis = std::fabs(n.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    first = cross(axis, n);
    first *= 1 / norm(first);
    second = cross(n, first);
}

Vec3 scaled(const Vec3& a, const Vec3& b)
{
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}

bool canMove(const Obstacle& obstacle)
{
    return dot(obstacle.m_inverseMass, obstacle.m_inverseMass) > 0 || squaredNorm(obstacle.m_inverseInertia) > 0;
}

constexpr int kMaxSweepsOfPush = 200;
constexpr double kPushTolerance = 1e-4;

}  // namespace

void ContactRows::assemble(ContactProblem& problem, const ContactSettings& settings)
{
    m_problem = &problem;
    m_settings = settings;
    if (m_bodies.size() < problem.m_bodies.size()) m_bodies.resize(problem.m_bodies.size());
    for (std::size_t b = 0; b < problem.m_bodies.size(); ++b) m_bodies[b].clear(problem.m_bodies[b]);
    m_rows.clear();
    for (const ContactPoint& contact : problem.m_contacts) addContactRow(contact);
    for (const Joint& joint : problem.m_joints) addJointRow(joint);
    m_inTurn = true;
    for (std::size_t b = 0; b < problem.m_bodies.size(); ++b)
    {
        if (m_bodies[b].size() == 0) continue;
        m_bodies[b].assemble(settings.m_step.m_warp, settings.m_denseLimit);
        m_inTurn = m_inTurn && m_bodies[b].isDense();
    }
    for (Row& row : m_rows) finishRow(row);
    measure();
    for (std::size_t k = 0; k < problem.m_contacts.size(); ++k) setContactTarget(m_rows[k], problem.m_contacts[k]);
    for (Row& row : m_rows)
    {
        if (row.m_a.m_body >= 0) m_bodies[row.m_a.m_body].push(row.m_a.m_end, row.m_impulse);
        if (row.m_b.m_body >= 0) m_bodies[row.m_b.m_body].push(row.m_b.m_end, -row.m_impulse);
    }
    m_gradientStep = 0;
}

void ContactRows::addContactRow(const ContactPoint& contact)
{
    Row row;
    row.m_a = softEnd(contact.m_soft, contact.m_point);
    row.m_b = contact.m_obstacle >= 0 ? rigidEnd(contact.m_obstacle, contact.m_point + contact.m_approach)
                                      : softEnd(contact.m_other, contact.m_point);
    row.m_axes[0] = contact.m_normal;
    makeTangents(contact.m_normal, row.m_axes[1], row.m_axes[2]);
    row.m_friction = contact.m_friction;
    row.m_impulse = contact.m_impulse;
    m_rows.push_back(row);
}

void ContactRows::addJointRow(const Joint& joint)
{
    Row row;
    row.m_joint = true;
    row.m_a = jointEnd(joint.m_a);
    row.m_b = jointEnd(joint.m_b);
    for (int i = 0; i < 3; ++i) row.m_axes[i] = joint.m_axes[i];
    row.m_target = joint.m_wanted;
    row.m_limit = joint.m_limit;
    row.m_softness = joint.m_softness;
    row.m_impulse = joint.m_impulse;
    m_rows.push_back(row);
}

ContactRows::RowEnd ContactRows::softEnd(const SurfacePoint& point, const Vec3& at)
{
    RowEnd end;
    end.m_body = point.m_body;
    if (point.m_body >= 0) end.m_end = m_bodies[point.m_body].addPoint(point, at);
    return end;
}

ContactRows::RowEnd ContactRows::jointEnd(const JointEnd& joint)
{
    if (joint.m_body < 0)
    {
        RowEnd end = rigidEnd(joint.m_obstacle, joint.m_point);
        end.m_angular = joint.m_angular;
        return end;
    }
    RowEnd end;
    end.m_body = joint.m_body;
    end.m_end = m_bodies[joint.m_body].addGroup(&m_problem->m_handleNodes[joint.m_first],
                                                &m_problem->m_handleBlocks[joint.m_first], joint.m_count);
    return end;
}

ContactRows::RowEnd ContactRows::rigidEnd(int obstacle, const Vec3& point) const
{
    RowEnd end;
    end.m_obstacle = obstacle;
    if (obstacle >= 0) end.m_arm = point - m_problem->m_obstacles[obstacle].m_center;
    return end;
}

Vec3 ContactRows::velocity(const RowEnd& end) const
{
    if (end.m_body >= 0) return m_bodies[end.m_body].velocity(end.m_end);
    if (end.m_obstacle < 0) return {};
    const Obstacle& o = m_problem->m_obstacles[end.m_obstacle];
    return end.m_angular ? o.m_angularVelocity : o.m_linearVelocity + cross(o.m_angularVelocity, end.m_arm);
}

Mat3 ContactRows::compliance(const RowEnd& end) const
{
    if (end.m_body >= 0) return m_bodies[end.m_body].compliance(end.m_end, end.m_end);
    if (end.m_obstacle < 0) return {};
    const Obstacle& o = m_problem->m_obstacles[end.m_obstacle];
    if (end.m_angular) return o.m_inverseInertia;
    const Mat3 arm = crossMatrix(end.m_arm);
    Mat3 w = Mat3::fromColumns({o.m_inverseMass.x, 0, 0}, {0, o.m_inverseMass.y, 0}, {0, 0, o.m_inverseMass.z});
    w -= arm * o.m_inverseInertia * arm;
    return w;
}

void ContactRows::finishRow(Row& row) const
{
    row.m_compliance = compliance(row.m_a) + compliance(row.m_b);
    if (row.m_a.m_body >= 0 && row.m_a.m_body == row.m_b.m_body)
    {
        const Mat3 between = m_bodies[row.m_a.m_body].compliance(row.m_a.m_end, row.m_b.m_end);
        row.m_compliance -= between + transpose(between);
    }
    Vec3 w[3];
    for (int i = 0; i < 3; ++i) w[i] = row.m_compliance * row.m_axes[i];
    for (int i = 0; i < 3; ++i) row.m_rowCompliance[i] = dot(row.m_axes[i], w[i]);
    row.m_idle = !(row.m_rowCompliance.x > 0);
    if (row.m_joint)
        row.m_idle = !(trace(row.m_compliance) > 0);
    else
    {
        // A compliance that is the same for all tangents makes friction opposite to the velocity where it slides.
        const double a = row.m_rowCompliance.y, b = row.m_rowCompliance.z, c = dot(row.m_axes[1], w[2]);
        row.m_rowCompliance.y = row.m_rowCompliance.z = 0.5 * (a + b) + std::sqrt(0.25 * (a - b) * (a - b) + c * c);
    }
    if (!m_inTurn)
    {
        const double largest = std::max({row.m_rowCompliance.x, row.m_rowCompliance.y, row.m_rowCompliance.z});
        row.m_rowCompliance = {largest, largest, largest};
    }
    if (row.m_joint) row.m_yield = row.m_softness * row.m_rowCompliance;
}

// Relative velocity of a contact as the step began.
Vec3 ContactRows::priorVelocity(const Row& row, const ContactPoint& contact) const
{
    const auto soft = [this](const SurfacePoint& p)
    {
        const std::vector<Vec3>& v = m_problem->m_bodies[p.m_body].m_body->m_state.m_v;
        return p.m_weights[0] * v[p.m_nodes[0]] + p.m_weights[1] * v[p.m_nodes[1]] + p.m_weights[2] * v[p.m_nodes[2]];
    };
    return soft(contact.m_soft) - (row.m_b.m_body >= 0 ? soft(contact.m_other) : velocity(row.m_b));
}

void ContactRows::setContactTarget(Row& row, const ContactPoint& contact) const
{
    const double h = m_settings.m_step.m_step;
    const Vec3 n = contact.m_normal;
    const double allowed = -std::max(contact.m_gap, 0.0) / h;
    row.m_target.x = allowed;
    for (int i = 1; i < 3; ++i) row.m_target[i] = -m_settings.m_slipFraction / h * dot(contact.m_slip, row.m_axes[i]);
    if (contact.m_restitution > 0 && dot(n, velocity(row)) < allowed)
    {
        const double closing = -dot(n, priorVelocity(row, contact));
        if (closing > m_settings.m_restitutionVelocity) row.m_target.x = contact.m_restitution * closing;
    }
    if (contact.m_stiffness > 0 || contact.m_damping > 0)
    {
        // Implicit spring and damper: lambda = h (-k (gap + h v) - d v).
        const double k = contact.m_stiffness, s = h * k + contact.m_damping;
        row.m_yield.x = 1 / (h * s);
        if (contact.m_gap < 0) row.m_target.x = -k * contact.m_gap / s;
    }
}

void ContactRows::react(const RowEnd& end, const Vec3& impulse)
{
    if (end.m_body >= 0) m_bodies[end.m_body].push(end.m_end, impulse);
    if (end.m_obstacle < 0) return;
    Obstacle& o = m_problem->m_obstacles[end.m_obstacle];
    if (!end.m_angular) o.m_linearVelocity += scaled(o.m_inverseMass, impulse);
    o.m_angularVelocity += o.m_inverseInertia * (end.m_angular ? impulse : cross(end.m_arm, impulse));
}

void ContactRows::change(Row& row, const Vec3& impulse)
{
    const Vec3 difference = impulse - row.m_impulse;
    row.m_impulse = impulse;
    react(row.m_a, difference);
    react(row.m_b, -difference);
}

void ContactRows::flush()
{
    for (std::size_t b = 0; b < m_problem->m_bodies.size(); ++b) m_bodies[b].flush();
}

void ContactRows::warmStart()
{
    for (Row& row : m_rows)
    {
        if (row.m_a.m_obstacle >= 0) react(row.m_a, row.m_impulse);
        if (row.m_b.m_obstacle >= 0) react(row.m_b, -row.m_impulse);
    }
}

void ContactRows::measure()
{
    for (std::size_t b = 0; b < m_problem->m_bodies.size(); ++b)
        if (m_bodies[b].size() > 0) m_bodies[b].measure();
    restart();
}

// Forgets the directions of the last sweeps.
void ContactRows::restart()
{
    m_acceleration = 1;
    for (Row& row : m_rows)
    {
        row.m_lastImpulse = row.m_impulse;
        row.m_lastVelocity = velocity(row);
    }
}

void ContactRows::apply(ContactReport& report)
{
    for (std::size_t b = 0; b < m_problem->m_bodies.size(); ++b)
    {
        if (m_bodies[b].size() == 0) continue;
        const SolveReport solved = m_bodies[b].apply(m_settings.m_step);
        report.m_iterations += solved.m_iterations;
        report.m_converged = report.m_converged && solved.m_stop == SolveStop::converged;
    }
    for (Row& row : m_rows) finishRow(row);
}

double ContactRows::changeOfRound()
{
    double change = 0, largest = 0;
    for (Row& row : m_rows)
    {
        const Vec3 difference = row.m_impulse - row.m_roundImpulse;
        change = std::max(change, dot(difference, difference));
        largest = std::max(largest, dot(row.m_impulse, row.m_impulse));
        row.m_roundImpulse = row.m_impulse;
    }
    return largest > 0 ? std::sqrt(change / largest) : 0;
}

Vec3 ContactRows::trueVelocity(const Row& row) const
{
    const auto ofEnd = [this](const RowEnd& end)
    { return end.m_body >= 0 ? m_bodies[end.m_body].trueVelocity(end.m_end) : velocity(end); };
    return ofEnd(row.m_a) - ofEnd(row.m_b);
}

// A point that sticks remembers how far it crept; one that slides or hangs free starts anew.
Vec3 ContactRows::newSlip(const Row& row, const ContactPoint& contact) const
{
    constexpr double kSticks = 0.999;  // share of the friction that it could have
    const double normal = dot(row.m_impulse, contact.m_normal);
    const Vec3 friction = row.m_impulse - normal * contact.m_normal;
    if (!(norm(friction) < kSticks * row.m_friction * normal)) return {};
    const Vec3 slip = contact.m_slip + m_settings.m_step.m_step * trueVelocity(row);
    return slip - dot(slip, contact.m_normal) * contact.m_normal;
}

double ContactRows::worstViolation() const
{
    double worst = 0;
    for (const Row& row : m_rows)
    {
        if (row.m_joint || row.m_idle) continue;
        const double separating = dot(row.m_axes[0], trueVelocity(row));
        const double yields = row.m_yield.x * dot(row.m_axes[0], row.m_impulse);
        worst = std::max(worst, row.m_target.x - separating - yields);
    }
    return worst;
}

void ContactRows::store()
{
    std::size_t k = 0;
    for (ContactPoint& contact : m_problem->m_contacts)
    {
        contact.m_impulse = m_rows[k].m_impulse;
        contact.m_slip = newSlip(m_rows[k++], contact);
    }
    for (Joint& joint : m_problem->m_joints) joint.m_impulse = m_rows[k++].m_impulse;
}

// The impulse that a contact wants for a relative velocity it has at another impulse; step: share of the way.
Vec3 ContactRows::solveContact(const Row& row, const Vec3& impulse, Vec3 v, double step) const
{
    // Normal: n . v + yield lambda >= target.
    const Vec3 n = row.m_axes[0];
    const double old = dot(impulse, n);
    const double missing = row.m_target.x - dot(n, v) - row.m_yield.x * old;
    const double normal = std::max(0.0, old + step * missing / (row.m_rowCompliance.x + row.m_yield.x));
    if (step == 1) v += row.m_compliance * ((normal - old) * n);

    // Friction: a step along the sliding velocity, projected to the disc of radius mu lambda_n.
    Vec3 tangential;
    for (int i = 1; i < 3; ++i)
        tangential +=
            (dot(impulse, row.m_axes[i]) + step * (row.m_target[i] - dot(v, row.m_axes[i])) / row.m_rowCompliance[i]) *
            row.m_axes[i];
    const double radius = row.m_friction * normal, length = norm(tangential);
    if (length > radius) tangential *= length > 0 ? radius / length : 0;
    return normal * n + tangential;
}

Vec3 ContactRows::solveJoint(const Row& row, const Vec3& impulse, Vec3 v, double step) const
{
    Vec3 result;
    for (int i = 0; i < 3; ++i)
    {
        const Vec3& axis = row.m_axes[i];
        const double w = row.m_rowCompliance[i], old = dot(impulse, axis), yield = row.m_yield[i];
        double wanted = 0;
        if (w > 0)
        {
            const double missing = row.m_target[i] - dot(axis, v) - yield * old;
            wanted = std::clamp(old + step * missing / (w + yield), -row.m_limit[i], row.m_limit[i]);
        }
        result += wanted * axis;
        if (step == 1) v += row.m_compliance * ((wanted - old) * axis);
    }
    return result;
}

Vec3 ContactRows::solveRow(const Row& row, const Vec3& impulse, const Vec3& v, double step) const
{
    if (row.m_idle) return impulse;
    return row.m_joint ? solveJoint(row, impulse, v, step) : solveContact(row, impulse, v, step);
}

double ContactRows::sweep()
{
    return m_inTurn ? sweepInTurn() : sweepAtOnce();
}

double ContactRows::sweepInTurn()
{
    double largestChange = 0, largest = 0;
    for (Row& row : m_rows)
    {
        const Vec3 wanted = solveRow(row, row.m_impulse, velocity(row), 1);
        const Vec3 difference = wanted - row.m_impulse;
        const double change2 = dot(difference, difference);
        largest = std::max(largest, dot(wanted, wanted));
        if (change2 == 0) continue;
        largestChange = std::max(largestChange, change2);
        change(row, wanted);
    }
    return largest > 0 ? std::sqrt(largestChange / largest) : 0;
}

// The gradient step: one over the largest eigenvalue of the compliance, scaled by that of every row, by some power
// iterations from the present impulses.
void ContactRows::chooseStep()
{
    constexpr int kIterations = 8;
    constexpr double kSafety = 1.2;
    double eigenvalue = 1;
    for (Row& row : m_rows)  // probes: added to the impulses and taken back at the end
    {
        row.m_roundImpulse = row.m_impulse;
        row.m_lastVelocity = velocity(row);
        const double length = norm(row.m_impulse);
        row.m_lastImpulse = length > 0 ? (1 / length) * row.m_impulse : row.m_axes[0];
        row.m_lastImpulse *= 1 / std::sqrt(std::max(row.m_rowCompliance.x, 1e-300));
    }
    for (int k = 0; k < kIterations; ++k)
    {
        double sum = 0, sum2 = 0;
        for (const Row& row : m_rows)
            if (!row.m_idle) sum += row.m_rowCompliance.x * dot(row.m_lastImpulse, row.m_lastImpulse);
        const double unit = sum > 0 ? 1 / std::sqrt(sum) : 0;
        for (Row& row : m_rows)
            if (!row.m_idle) change(row, row.m_roundImpulse + unit * row.m_lastImpulse);
        flush();
        for (Row& row : m_rows)
        {
            if (row.m_idle) continue;
            row.m_lastImpulse = (1 / row.m_rowCompliance.x) * (velocity(row) - row.m_lastVelocity);
            sum2 += row.m_rowCompliance.x * dot(row.m_lastImpulse, row.m_lastImpulse);
        }
        eigenvalue = std::max(eigenvalue, std::sqrt(sum2));
    }
    for (Row& row : m_rows) change(row, row.m_roundImpulse);
    flush();
    m_gradientStep = 1 / (kSafety * eigenvalue);
    for (Row& row : m_rows)
    {
        row.m_lastImpulse = row.m_impulse;
        row.m_lastVelocity = velocity(row);
    }
}

double ContactRows::sweepAtOnce()
{
    if (!(m_gradientStep > 0)) chooseStep();
    // Nesterov's extrapolation from the last two points, with restart where it points uphill [O'Donoghue, Candes 2015].
    const double next = 0.5 * (1 + std::sqrt(1 + 4 * m_acceleration * m_acceleration));
    const double beta = (m_acceleration - 1) / next;
    double largestChange = 0, largest = 0, uphill = 0;
    for (Row& row : m_rows)
    {
        const Vec3 v = velocity(row), before = row.m_impulse;
        const Vec3 from = before + beta * (before - row.m_lastImpulse);
        const Vec3 wanted = solveRow(row, from, v + beta * (v - row.m_lastVelocity), m_gradientStep);
        uphill += row.m_rowCompliance.x * dot(from - wanted, wanted - before);
        row.m_lastImpulse = before;
        row.m_lastVelocity = v;
        const Vec3 difference = wanted - before;
        largest = std::max(largest, dot(wanted, wanted));
        largestChange = std::max(largestChange, dot(difference, difference));
        row.m_pending = wanted;
    }
    for (Row& row : m_rows) change(row, row.m_pending);
    flush();
    m_acceleration = uphill > 0 ? 1 : next;
    return largest > 0 ? std::sqrt(largestChange / largest) : 0;
}

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
    for (std::size_t k = 0; k < m_rows.size(); ++k)
    {
        Row& row = m_rows[k];
        row.m_impulse = row.m_roundImpulse = row.m_target = {};
        if (row.m_joint) continue;
        const ContactPoint& c = m_problem->m_contacts[k];
        const double moving = dot(c.m_normal, velocity(row));
        const double depth = std::max(0.0, -c.m_gap - c.m_slop);
        const double wanted = std::min(m_settings.m_pushFraction * depth / h, m_settings.m_maxPushVelocity);
        row.m_target.x = c.m_gap < 0 ? wanted - std::max(moving, 0.0) : -(moving + c.m_gap / h);
        row.m_friction = 0;
        row.m_idle = row.m_idle || row.m_yield.x > 0;
    }
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
    int sweeps = 0;
    for (double change = 1; sweeps < kMaxSweepsOfPush && change > kPushTolerance; ++sweeps) change = sweep();
    for (std::size_t k = 0; k < m_problem->m_obstacles.size(); ++k)
    {
        Obstacle& obstacle = m_problem->m_obstacles[k];
        obstacle.m_pushLinear = obstacle.m_linearVelocity;
        obstacle.m_pushAngular = obstacle.m_angularVelocity;
        obstacle.m_linearVelocity = m_savedLinear[k];
        obstacle.m_angularVelocity = m_savedAngular[k];
    }
    for (std::size_t b = 0; b < m_problem->m_bodies.size(); ++b)
    {
        if (m_bodies[b].size() == 0) continue;
        const Vec3 gained = m_bodies[b].applyPush(m_settings.m_step);
        if (dot(gained, gained) > 0) payBack(b, gained);
    }
    return sweeps;
}

// Displacing a moving body changes its angular momentum about the origin. The movable obstacles that it was pushed off
// take the opposite, in proportion to the push; where it was pushed off soft ones it spins itself.
void ContactRows::payBack(std::size_t body, const Vec3& gained)
{
    const int b = static_cast<int>(body);
    double total = 0, soft = 0;
    for (const Row& row : m_rows)
    {
        if (row.m_a.m_body != b && row.m_b.m_body != b) continue;
        total += norm(row.m_impulse);
        if (row.m_a.m_body >= 0 && row.m_b.m_body >= 0) soft += norm(row.m_impulse);
    }
    if (!(total > 0)) return;
    for (const Row& row : m_rows)
    {
        if (row.m_a.m_body != b && row.m_b.m_body != b) continue;
        const int o = row.m_a.m_body == b ? row.m_b.m_obstacle : row.m_a.m_obstacle;
        if (o >= 0 && canMove(m_problem->m_obstacles[o]))
            m_problem->m_obstacles[o].m_angularImpulse -= (norm(row.m_impulse) / total) * gained;
    }
    m_bodies[body].spin(-(soft / total) * gained, m_settings.m_step);
}

}  // namespace bullet_fem
