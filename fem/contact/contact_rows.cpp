// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/contact_rows.h"

#include <algorithm>

#include "bullet_fem/fem/stepping.h"
#include "fem/contact/obstacle_response.h"

namespace bullet_fem
{
namespace
{

constexpr std::size_t kManyBodies = 16;  // of dense compliance, worth waking threads for

}  // namespace

// The normal, a unit vector at a right angle to it, and their cross product.
void ContactRows::setAxes(const Vec3& n, Row& row)
{
    const Vec3 axis = std::fabs(n.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    row.m_axes[0] = n;
    row.m_axes[1] = (1 / norm(cross(axis, n))) * cross(axis, n);
    row.m_axes[2] = cross(n, row.m_axes[1]);
}

void ContactRows::assemble(ContactProblem& problem, const ContactSettings& settings)
{
    m_problem = &problem;
    m_settings = settings;
    m_probeLinear.assign(problem.m_obstacles.size(), Vec3());
    m_probeAngular.assign(problem.m_obstacles.size(), Vec3());
    if (m_bodies.size() < problem.m_bodies.size()) m_bodies.resize(problem.m_bodies.size());
    m_corrections.assign(problem.m_bodies.size(), ImpulseResponse());
    for (std::size_t b = 0; b < problem.m_bodies.size(); ++b) m_bodies[b].clear(problem.m_bodies[b]);
    m_rows.clear();
    for (const ContactPoint& contact : problem.m_contacts) addContactRow(contact);
    for (const Joint& joint : problem.m_joints) addJointRow(joint);
    for (const RigidTouch& touch : problem.m_rigidTouches) addTouchRow(touch);
    m_inTurn = true;
    for (std::size_t b = 0; b < problem.m_bodies.size(); ++b)
    {
        if (m_bodies[b].size() == 0) continue;
        m_bodies[b].assemble(settings.m_denseLimit);
        m_inTurn = m_inTurn && m_bodies[b].isDense();
    }
    forEachTouchedBody(threadsForCompliance(), [this](int b) { m_bodies[b].form(); });
    for (Row& row : m_rows)
    {
        finishRow(row);
        if (row.m_idle && !row.m_joint) row.m_impulse = {};  // a guess that nothing would ever change
    }
    measure();
    for (std::size_t k = 0; k < problem.m_contacts.size(); ++k) setContactTarget(m_rows[k], problem.m_contacts[k]);
    for (Row& row : m_rows)
    {
        if (row.m_a.m_body >= 0) m_bodies[row.m_a.m_body].push(row.m_a.m_end, row.m_impulse);
        if (row.m_b.m_body >= 0) m_bodies[row.m_b.m_body].push(row.m_b.m_end, -row.m_impulse);
    }
    m_gradientStep = 0;
    m_lifeOfSet = -1;
    reserve();
    m_subspace = {};
}

void ContactRows::addContactRow(const ContactPoint& contact)
{
    Row row;
    row.m_a = softEnd(contact.m_soft, contact.m_point);
    row.m_b = contact.m_obstacle >= 0 ? rigidEnd(contact.m_obstacle, contact.m_point + contact.m_approach)
                                      : softEnd(contact.m_other, contact.m_point);
    setAxes(contact.m_normal, row);
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
    row.m_most = joint.m_most;
    row.m_softness = joint.m_softness;
    row.m_spring = joint.m_compliance;
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
    return obstacleCompliance(*m_problem, end.m_obstacle, end.m_arm, end.m_angular);
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
        if (!(row.m_rowCompliance.y > 0)) row.m_rowCompliance.y = row.m_rowCompliance.z = row.m_rowCompliance.x;
    }
    if (!m_inTurn)
    {
        const double largest = std::max({row.m_rowCompliance.x, row.m_rowCompliance.y, row.m_rowCompliance.z});
        row.m_rowCompliance = {largest, largest, largest};
    }
    if (row.m_joint)
        row.m_yield = row.m_softness * row.m_rowCompliance + Vec3{row.m_spring, row.m_spring, row.m_spring};
}

// Relative velocity of a contact as the step began.
Vec3 ContactRows::priorVelocity(const Row& row, const ContactPoint& contact) const
{
    const auto soft = [this](const SurfacePoint& p) { return p.of(m_problem->m_bodies[p.m_body].m_body->m_state.m_v); };
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
    std::vector<Obstacle>& obstacles = m_problem->m_obstacles;
    const auto add = [&obstacles](int k, const Vec3& linear, const Vec3& angular)
    {
        obstacles[k].m_linearVelocity += linear;
        obstacles[k].m_angularVelocity += angular;
    };
    if (end.m_angular)
        respond(*m_problem, end.m_obstacle, {}, impulse, add);
    else
        respond(*m_problem, end.m_obstacle, impulse, cross(end.m_arm, impulse), add);
}

void ContactRows::change(Row& row, const Vec3& impulse)
{
    const Vec3 difference = impulse - row.m_impulse;
    row.m_impulse = impulse;
    react(row.m_a, difference);
    react(row.m_b, -difference);
}

// A dense compliance is over before other threads have woken up.
const Threads* ContactRows::threadsForCompliance() const
{
    return m_inTurn && m_problem->m_bodies.size() < kManyBodies ? nullptr : m_settings.m_step.m_threads;
}

void ContactRows::flush()
{
    forEachTouchedBody(threadsForCompliance(), [this](int b) { m_bodies[b].flush(); });
}

void ContactRows::warmStart()
{
    for (Row& row : m_rows)
    {
        if (row.m_a.m_obstacle >= 0) react(row.m_a, row.m_impulse);
        if (row.m_b.m_obstacle >= 0) react(row.m_b, -row.m_impulse);
    }
}

bool ContactRows::hasImpulses() const
{
    return std::any_of(m_rows.begin(), m_rows.end(),
                       [](const Row& row) { return dot(row.m_impulse, row.m_impulse) > 0; });
}

void ContactRows::measure()
{
    forEachTouchedBody(threadsForCompliance(), [this](int b) { m_bodies[b].measure(); });
    m_subspace.m_tried = false;  // the work of sweeps before is that of another problem
    m_lifeOfSet = -1;
    restart();
}

void ContactRows::setSpeedScale()
{
    const double loads = loadSpeed();
    m_speedScale = std::max(loads, largestChange());
    if (loads > 0) return;
    for (const Row& row : m_rows) m_speedScale = std::max(m_speedScale, speedOf(row, row.m_impulse));
}

// The largest speed that its loads alone would give one of the bodies in a step [m/s].
double ContactRows::loadSpeed() const
{
    double largest = 0;
    for (std::size_t b = 0; b < m_problem->m_bodies.size(); ++b)
    {
        if (m_bodies[b].size() == 0) continue;
        const Body& body = m_bodies[b].body();
        Vec3 force;
        double mass = 0;
        for (std::size_t i = 0; i < body.m_loads.m_force.size(); ++i)
        {
            force += body.m_loads.m_force[i];
            mass += body.m_state.m_mass[i];
        }
        if (mass > 0) largest = std::max(largest, m_settings.m_step.m_step * norm(force) / mass);
    }
    return largest;
}

// Forgets the directions of the last sweeps.
void ContactRows::restart()
{
    m_acceleration = 1;
    if (m_inTurn) return;
    for (Row& row : m_rows)
    {
        row.m_lastImpulse = row.m_impulse;
        row.m_lastVelocity = velocity(row);
    }
}

void ContactRows::apply(double floor, bool steady, ContactReport& report)
{
    forEachTouchedBody(m_settings.m_step.m_threads,
                       [&](int b)
                       {
                           m_corrections[b] = m_bodies[b].beginCorrection(m_settings.m_step, floor);
                           m_corrections[b].m_steady = steady;
                       });
    solveCorrections();
    forEachTouchedBody(m_settings.m_step.m_threads,
                       [this](int b)
                       {
                           if (m_corrections[b].m_body) m_bodies[b].endCorrection();
                       });
    bool learnt = false;
    for (int b : m_corrected)
    {
        const SolveReport& solved = m_corrections[b].m_report;
        report.m_iterations += solved.m_iterations;
        report.m_converged = report.m_converged && solved.m_stop == SolveStop::converged;
        learnt = learnt || m_bodies[b].hasLearnt();
    }
    if (!learnt) return;  // the rows' compliance is what it was
    for (Row& row : m_rows) finishRow(row);
}

// Bodies that share their model several at a time, batches on threads.
void ContactRows::solveCorrections()
{
    const Threads* threads = m_settings.m_step.m_threads;
    m_corrected.clear();
    m_correctedBodies.clear();
    for (std::size_t b = 0; b < m_problem->m_bodies.size(); ++b)
    {
        if (m_bodies[b].size() == 0 || !m_corrections[b].m_body) continue;
        m_corrected.push_back(static_cast<int>(b));
        m_correctedBodies.push_back(m_corrections[b].m_body);
    }
    m_batches.divide(m_correctedBodies, threads ? threads->count() : 1, m_settings.m_batchBodies);
    m_ordered.clear();
    for (int k : m_batches.order()) m_ordered.push_back(m_corrections[m_corrected[k]]);
    const std::vector<Range>& batches = m_batches.batches();
    runTasks(threads, static_cast<int>(batches.size()),
             [&](int k) { applyImpulses(&m_ordered[batches[k].m_begin], batches[k].m_end - batches[k].m_begin); });
    for (std::size_t k = 0; k < m_ordered.size(); ++k)
        m_corrections[m_corrected[m_batches.order()[k]]].m_report = m_ordered[k].m_report;
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
        if (row.m_joint || row.m_touch || row.m_idle) continue;
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

}  // namespace bullet_fem
