// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/constraints/contact_rows.h"

#include <algorithm>
#include <cmath>

#include "bullet_fem/fem/step/stepping.h"
#include "fem/contact/constraints/rigid_response.h"
#include "fem/contact/contact_tuning.h"

namespace bullet_fem
{
namespace
{

constexpr std::size_t kManyBodies = 16;  // minimum number of bodies with dense compliance for which threads pay

// Largest rotation of a movable proxy within a step whose arcs sticking points follow [rad]. Its spin is unknown before
// the solve, and counts only if it is about the normal, by this cosine [-]: arcs threw jams of tumbling bodies apart.
constexpr double kMaxMovableTurn = 0.1;
constexpr double kMinAxisCosine = 0.98;

}  // namespace

Vec3 ContactRows::velocity(const ConstraintSide& end) const
{
    if (end.m_body >= 0) return m_bodies[end.m_body].velocity(end.m_end);
    if (end.m_rigidProxy < 0) return {};
    const RigidProxy& o = m_problem->m_rigidProxies[end.m_rigidProxy];
    if (end.m_jacobian >= 0)
    {
        const RigidJacobian& jacobian = m_problem->m_jacobians[end.m_jacobian];
        return jacobian.m_linear * o.m_linearVelocity + jacobian.m_angular * o.m_angularVelocity;
    }
    return end.m_angular ? o.m_angularVelocity : o.m_linearVelocity + cross(o.m_angularVelocity, end.m_arm);
}

void ContactRows::react(const ConstraintSide& end, const Vec3& impulse)
{
    if (end.m_body >= 0) m_bodies[end.m_body].push(end.m_end, impulse);
    if (end.m_rigidProxy < 0) return;
    std::vector<RigidProxy>& rigidProxies = m_problem->m_rigidProxies;
    const RigidProxy& rigidProxy = rigidProxies[end.m_rigidProxy];
    if (rigidProxy.m_responseCount == 0 && !rigidProxy.canMove()) return;  // other threads read its velocity
    const auto add = [&rigidProxies](int k, const Vec3& linear, const Vec3& angular)
    {
        rigidProxies[k].m_linearVelocity += linear;
        rigidProxies[k].m_angularVelocity += angular;
    };
    Vec3 linear = end.m_angular ? Vec3() : impulse, angular = end.m_angular ? impulse : cross(end.m_arm, impulse);
    if (end.m_jacobian >= 0)
    {
        linear = transposeTimes(m_problem->m_jacobians[end.m_jacobian].m_linear, impulse);
        angular = transposeTimes(m_problem->m_jacobians[end.m_jacobian].m_angular, impulse);
    }
    respond(*m_problem, end.m_rigidProxy, linear, angular, add);
    if (rigidProxy.m_responseCount == 0) return;
    rigidProxies[end.m_rigidProxy].m_accumulatedImpulse += linear;
    rigidProxies[end.m_rigidProxy].m_accumulatedAngularImpulse += angular;
}

void ContactRows::change(ContactRow& row, const Vec3& impulse)
{
    const Vec3 difference = impulse - row.m_impulse;
    row.m_impulse = impulse;
    press(row, difference);
    react(row.m_a, difference);
    react(row.m_b, -difference);
}

void ContactRows::pushAlong(ContactRow& row, const Vec3& impulse)
{
    row.m_impulse += impulse;
    press(row, impulse);
    const auto push = [this](const ConstraintSide& end, const Vec3& on)
    {
        if (end.m_body >= 0)
            m_bodies[end.m_body].pushAlong(end.m_end, on);
        else
            react(end, on);
    };
    push(row.m_a, impulse);
    push(row.m_b, -impulse);
}

int ContactRows::mover(const ConstraintSide& end) const
{
    if (end.m_body >= 0) return end.m_body;
    if (end.m_rigidProxy < 0 || !m_problem->m_rigidProxies[end.m_rigidProxy].canMove()) return -1;
    return static_cast<int>(m_problem->m_bodies.size()) + end.m_rigidProxy;
}

bool ContactRows::movesRigid(const ContactRow& row) const
{
    return std::max(mover(row.m_a), mover(row.m_b)) >= static_cast<int>(m_problem->m_bodies.size());
}

Vec3 ContactRows::pointOf(std::size_t row) const
{
    if (row < m_problem->m_contacts.size()) return m_problem->m_contacts[row].m_point;
    const ConstraintSide& end = m_rows[row].m_a.m_rigidProxy >= 0 ? m_rows[row].m_a : m_rows[row].m_b;
    return m_problem->m_rigidProxies[end.m_rigidProxy].m_center + end.m_arm;
}

// A dense compliance is finished before other threads wake up.
const Threads* ContactRows::threadsForCompliance() const
{
    return m_dense && m_problem->m_bodies.size() < kManyBodies ? nullptr : m_settings.m_step.m_threads;
}

void ContactRows::flush()
{
    forEachContactBody(threadsForCompliance(), [this](int b) { m_bodies[b].flush(); });
}

void ContactRows::warmStart()
{
    for (ContactRow& row : m_rows)
    {
        if (row.m_a.m_rigidProxy >= 0) react(row.m_a, row.m_impulse);
        if (row.m_b.m_rigidProxy >= 0) react(row.m_b, -row.m_impulse);
    }
}

void ContactRows::takeBack()
{
    for (ContactRow& row : m_rows) change(row, {});
    flush();
}

void ContactRows::keep()
{
    for (ContactRow& row : m_rows) row.m_bestImpulse = row.m_impulse;
}

void ContactRows::restoreBest()
{
    for (ContactRow& row : m_rows) change(row, row.m_bestImpulse);
    flush();
}

bool ContactRows::hasImpulses() const
{
    return std::any_of(m_rows.begin(), m_rows.end(),
                       [](const ContactRow& row) { return dot(row.m_impulse, row.m_impulse) > 0; });
}

void ContactRows::measure()
{
    forEachContactBody(threadsForCompliance(), [this](int b) { m_bodies[b].measure(); });
}

void ContactRows::setSpeedScale(double missing)
{
    m_speedScale = std::max({slowestSpeed(), m_loadSpeed, missing});
}

double ContactRows::missingSpeed()
{
    return largestOfRows([this](int k) { return missingSpeed(m_rows[k]); });
}

double ContactRows::missingSpeed(const ContactRow& row) const
{
    const Vec3 v = trueVelocity(row);
    if (!row.m_joint) return violation(row, v);
    const Vec3 missing = row.m_target - Vec3{dot(row.m_axes[0], v), dot(row.m_axes[1], v), dot(row.m_axes[2], v)};
    return std::min(norm(missing), speedOf(row, wantedImpulse(row, {}, v, 1)));  // a weak motor cannot do more
}

double ContactRows::share(double speed) const
{
    return speed > 0 ? speed / std::max(m_speedScale, 1e-3 * speed) : 0;
}

bool ContactRows::isRunaway(double speed) const
{
    return !(speed <= kRunaway * std::max(m_speedScale, m_largestWanted));
}

bool ContactRows::rests(const ContactRow& row) const
{
    if (row.m_joint || dot(row.m_impulse, row.m_impulse) > 0) return false;
    if (row.m_torsion) return row.m_idle || !(row.m_load > 0);
    return row.m_idle || !(row.m_target.x > dot(row.m_axes[0], velocity(row)));
}

double ContactRows::wantedSpeed(const ContactRow& row) const
{
    return speedOf(row, wantedImpulse(row, row.m_impulse, velocity(row), 1) - row.m_impulse);
}

void ContactRows::noteWants()
{
    forEachChunk(
        [this](int, Range rows)
        {
            for (int k = rows.m_begin; k < rows.m_end; ++k) m_wants[k] = !rests(m_rows[k]);
        });
}

double ContactRows::error()
{
    return share(largestOfRows([this](int k)
                               { return isSolvedAtOnce(m_rows[k]) || rests(m_rows[k]) ? 0 : wantedSpeed(m_rows[k]); }));
}

// A resting contact closes no faster than allowed: its velocity has just been measured.
RowSurvey ContactRows::survey()
{
    std::array<RowSurvey, Chunks::kMax> found{};
    forEachChunk(
        [&](int p, Range rows)
        {
            RowSurvey ofChunk;
            for (int k = rows.m_begin; k < rows.m_end; ++k)
            {
                const ContactRow& row = m_rows[k];
                m_wants[k] = !rests(row);
                if (!m_wants[k]) continue;
                ofChunk.m_closing = std::max(ofChunk.m_closing, violation(row, trueVelocity(row)));
                if (isSolvedAtOnce(row)) continue;
                const double wanted = wantedSpeed(row);
                ofChunk.m_wanted = std::max(ofChunk.m_wanted, wanted);
                if (!movesRigid(row)) ofChunk.m_guessed = std::max(ofChunk.m_guessed, wanted);
            }
            found[p] = ofChunk;
        });
    RowSurvey all;
    for (const RowSurvey& piece : found)
        all = {std::max(all.m_wanted, piece.m_wanted), std::max(all.m_guessed, piece.m_guessed),
               std::max(all.m_closing, piece.m_closing)};
    m_largestWanted = all.m_wanted;
    return all;
}

bool ContactRows::apply(double floor, bool steady, ContactReport& report)
{
    forEachContactBody(m_settings.m_step.m_threads,
                       [&](int b)
                       {
                           m_corrections[b] = m_bodies[b].beginCorrection(m_settings.m_step, floor);
                           m_corrections[b].m_steady = steady;
                       });
    solveCorrections();
    forEachContactBody(m_settings.m_step.m_threads,
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
    if (learnt) finishRows();
    return learnt;
}

// Solves bodies with a common model in batches, on several threads.
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
    m_batches.divide(m_correctedBodies, threads ? threads->count() : 1, m_settings.m_step.m_batchMemory != nullptr);
    m_ordered.clear();
    for (int k : m_batches.order()) m_ordered.push_back(m_corrections[m_corrected[k]]);
    const std::vector<Range>& batches = m_batches.batches();
    runTasks(threads, static_cast<int>(batches.size()),
             [&](int k) { applyImpulses(&m_ordered[batches[k].m_begin], batches[k].m_end - batches[k].m_begin); });
    for (std::size_t k = 0; k < m_ordered.size(); ++k)
        m_corrections[m_corrected[m_batches.order()[k]]].m_report = m_ordered[k].m_report;
}

Vec3 ContactRows::trueVelocity(const ContactRow& row) const
{
    const auto ofEnd = [this](const ConstraintSide& end)
    { return end.m_body >= 0 ? m_bodies[end.m_body].trueVelocity(end.m_end) : velocity(end); };
    return ofEnd(row.m_a) - ofEnd(row.m_b);
}

double ContactRows::theta(int a, int b) const
{
    const double ofA = a >= 0 ? m_bodies[a].theta() : 0, ofB = b >= 0 ? m_bodies[b].theta() : 0;
    return a >= 0 || b >= 0 ? std::max(ofA, ofB) : 1;
}

// Difference between the arc of a point of a rigid proxy within the step and h times its velocity: h^2/2 w x (w x arm)
// [m], with the spin before the solve. Sticking points follow the arc; without it a body on a turntable would drift
// outward. Not used for fast rotation, where contact points change within the step. Movable proxies are
// turntables if they spin about the normal, by which the point stays on its surface.
Vec3 ContactRows::arcOf(const ContactRow& row) const
{
    const ConstraintSide& end = row.m_b;
    if (end.m_rigidProxy < 0 || end.m_angular) return {};
    const RigidProxy& rigidProxy = m_problem->m_rigidProxies[end.m_rigidProxy];
    const Vec3 spin = m_settings.m_step.m_step * rigidProxy.m_angularVelocity;
    const double maxTurn = rigidProxy.canMove() ? kMaxMovableTurn : RigidProxy::kMaxTurn;
    if (dot(spin, spin) > maxTurn * maxTurn) return {};
    if (rigidProxy.canMove() && std::fabs(dot(spin, row.m_axes[0])) < kMinAxisCosine * norm(spin)) return {};
    return 0.5 * cross(spin, cross(spin, end.m_arm));
}

// Movable proxies have arcs about the normal alone.
double ContactRows::closedByArc(const ContactRow& row) const
{
    const bool isLed = row.m_b.m_rigidProxy >= 0 && !m_problem->m_rigidProxies[row.m_b.m_rigidProxy].canMove();
    return isLed ? dot(row.m_axes[0], arcOf(row)) : 0;
}

Vec3 ContactRows::arcOfMean(const ContactRow& row) const
{
    return (2 * theta(row) - 1) * arcOf(row);
}

// A sticking point accumulates its slip; a sliding or unloaded one starts from zero.
Vec3 ContactRows::newSlip(const ContactRow& row, const ContactPoint& contact) const
{
    if (!sticks(row)) return {};
    const Vec3 slip = contact.m_slip + m_settings.m_step.m_step * meanVelocity(row) - arcOfMean(row);
    return slip - dot(slip, contact.m_normal) * contact.m_normal;
}

bool ContactRows::isTooSoft() const
{
    const auto isSoft = [](const SoftBodyContacts& body) { return body.size() > 0 && body.isTooSoft(); };
    return std::any_of(m_bodies.begin(), m_bodies.begin() + static_cast<std::ptrdiff_t>(m_problem->m_bodies.size()),
                       isSoft);
}

double ContactRows::violation(const ContactRow& row, const Vec3& trueVelocity) const
{
    if (row.m_joint || row.m_touch || row.m_torsion || row.m_idle) return 0;
    const double separating = dot(row.m_axes[0], trueVelocity);
    const double yields = row.m_yield.x * dot(row.m_axes[0], row.m_impulse);
    return row.m_target.x - separating - yields;
}

void ContactRows::noteReactions()
{
    forEachContactBody(nullptr, [this](int b) { m_bodies[b].noteReactions(); });
}

double ContactRows::store()
{
    std::vector<ContactPoint>& contacts = m_problem->m_contacts;
    const double worst = largestOfRows(
        [&](int k)
        {
            if (k >= static_cast<int>(contacts.size())) return 0.0;
            const ContactRow& row = m_rows[k];
            const Vec3 v = trueVelocity(row);
            contacts[k].m_impulse = row.m_impulse;
            contacts[k].m_slip = newSlip(row, contacts[k]);
            return violation(row, v);
        });
    std::size_t k = contacts.size();
    for (Joint& joint : m_problem->m_joints) joint.m_impulse = m_rows[k++].m_impulse;
    for (RigidContact& contact : m_problem->m_rigidContacts) contact.m_impulse = m_rows[k++].m_impulse;
    for (TorsionalFriction& torsion : m_problem->m_torsions) torsion.m_impulse = m_rows[k++].m_impulse;
    return worst;
}

}  // namespace bullet_fem
