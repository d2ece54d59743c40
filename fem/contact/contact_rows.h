// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "bullet_fem/fem/batch/body_batches.h"
#include "bullet_fem/fem/contact/contact_problem.h"
#include "fem/common/chunks.h"
#include "fem/contact/contact_row.h"
#include "fem/contact/soft_body_contacts.h"

namespace bullet_fem
{

/// What a look at all rows finds [m/s].
struct RowSurvey
{
    double m_wanted = 0;   ///< by how much a contact alone wants to change the velocity of its point, at most
    double m_guessed = 0;  ///< and one without a rigid proxy that can move
    double m_joints = 0;   ///< and a joint within its limits
    double m_closing = 0;  ///< how much faster than allowed a contact closes, at most
};

/// The rows of all contacts and joints of a problem, and what their impulses do to bodies and rigid proxies. Who sweeps
/// over them is ContactSweeps. Grows with the problem, never shrinks.
class ContactRows
{
public:
    /// Ends, frames and compliance of all rows, from free velocities of bodies and present ones of rigid proxies.
    /// `goal`: how closely bodies are to have solved for the impulses that rows start with. The problem must live until
    /// the step is over.
    void assemble(ContactProblem& problem, const ContactSettings& settings, const CorrectionGoal& goal);

    ContactProblem& problem() const { return *m_problem; }
    const ContactSettings& settings() const { return m_settings; }

    /// Of the contacts, the joints, the touches of rigid proxies and the torsional frictions, in this order.
    std::vector<ContactRow>& rows() { return m_rows; }
    const std::vector<ContactRow>& rows() const { return m_rows; }
    SoftBodyContacts& body(int b) { return m_bodies[b]; }

    /// True if all bodies have a dense compliance: a change of one row is felt by the others at once.
    bool isDense() const { return m_dense; }

    /// Gives the rigid proxies the reactions of the impulses that the rows start with.
    void warmStart();

    /// Takes all impulses back.
    void takeBack();

    /// Notes all impulses; restoreBest() gives those noted last to the rows again, and the velocities follow.
    void keep();
    void restoreBest();

    /// True if a row starts with an impulse.
    bool hasImpulses() const;

    /// Lets the touches of rigid proxies answer what the impulses so far do to them. Returns whether there are any.
    bool settleRigidContacts();

    /// What an impulse on one end of a row does to the velocity of another's [1/kg]; angular ends of rigid proxies have
    /// spins and angular impulses.
    Mat3 compliance(const ConstraintSide& of, const ConstraintSide& from) const;

    /// What impulses on an end move, by number: bodies, then rigid proxies. -1: nothing.
    int mover(const ConstraintSide& end) const;
    std::size_t movers() const { return m_problem->m_bodies.size() + m_problem->m_rigidProxies.size(); }

    /// True if a rigid proxy that can move is at one of its ends.
    bool movesRigid(const ContactRow& row) const;

    /// Where a row other than a joint acts [m].
    Vec3 pointOf(std::size_t row) const;

    /// Relative velocity of a row's ends, as predicted [m/s].
    Vec3 velocity(const ContactRow& row) const { return velocity(row.m_a) - velocity(row.m_b); }

    /// With which its ends move against each other in the step [m/s].
    Vec3 meanVelocity(const ContactRow& row) const { return meanVelocity(row.m_a) - meanVelocity(row.m_b); }

    /// Of what turns with a rigid proxy that nothing moves, less h times its velocity at 1 - theta of the step: what it
    /// goes in theta of it, over theta, and in the whole step [m].
    Vec3 arcOf(const ContactRow& row) const;
    Vec3 arcOfMean(const ContactRow& row) const;

    /// StepCoefficients::theta() of a row's soft body, of two the larger: shares of the step are those of implicit
    /// Euler where one of them goes by it. 1 without soft bodies.
    double theta(const ContactRow& row) const { return theta(row.m_a.m_body, row.m_b.m_body); }
    double theta(int a, int b) const;

    /// Gives a row another impulse; the velocities of its ends follow: of a body that is not dense with flush().
    void change(ContactRow& row, const Vec3& impulse);
    void flush();

    /// Adds to a row's impulse; the velocities of rigid proxies follow, those of bodies are left to whoever mixes them.
    void pushAlong(ContactRow& row, const Vec3& impulse);

    /// Brings the ends' velocities up to the bodies' true ones.
    void measure();

    /// What changes are measured against from here on: the speed that the loads give a body in a step, or what a row
    /// has to change now at most, `wanted` [m/s]; where there are no loads, or what a guess has changed.
    void setSpeedScale(double wanted);
    double speedScale() const { return m_speedScale; }

    /// The shortest mean edge of an element of the bodies that have ends [m].
    double shortestEdge() const { return m_shortestEdge; }

    /// The largest speed that its loads alone would give one of the bodies in a step [m/s].
    double loadSpeed() const { return m_loadSpeed; }

    /// A speed as a share of that scale; 1000 if there is none.
    double share(double speed) const;

    /// True of a speed so much above the scale that sweeping leads nowhere. The compliance of a body may be indefinite
    /// by its own errors: that of a stiff, light body on the low-memory path.
    bool isRunaway(double speed) const;

    /// Looks at all rows when they have just been measured, and notes which of them want something.
    RowSurvey survey();

    /// Only notes it.
    void noteWants();

    /// When it was noted last: the row was more than a contact that carries nothing and wants nothing, as most are.
    bool wants(std::size_t k) const { return m_wants[k] != 0; }

    /// By how much a row that is more than that alone wants to change the velocity of its point [m/s].
    double wantedSpeed(const ContactRow& row) const;

    /// The largest of these, but for joints within their limits, as a share of the scale.
    double error();

    /// Solves the bodies' true systems for what is new. `steady`: the impulses are all of a step much like the one
    /// before. Returns whether the rows' compliance has changed.
    bool apply(const CorrectionGoal& goal, bool steady, ContactReport& report);

    /// True if a body has answered less than its compliance said: rounds go a part of the way only.
    bool isTooSoft() const;

    /// The largest speed [m/s] at which a contact closes faster than allowed, from the bodies' true velocities.
    double worstViolation();

    /// See SoftBodyContacts.
    void noteReactions();

    /// Hands the impulses to the contacts and joints, and the slip of what sticks. Returns the worst violation.
    double store();

    /// Those that are worth waking for what W takes; null: none but the caller's.
    const Threads* threadsForCompliance() const;

    /// Calls part(b) for all bodies with ends, on these threads at the same time: it must write to nothing but body b
    /// and its ends.
    template <class Part>
    void forEachContactBody(const Threads* threads, const Part& part)
    {
        runTasks(threads, static_cast<int>(m_problem->m_bodies.size()),
                 [&](int b)
                 {
                     if (m_bodies[b].size() > 0) part(b);
                 });
    }

    /// Calls part(p, rows) for ranges that make up all rows, where they are many on the settings' threads at the same
    /// time: it must write to nothing but these rows.
    template <class Part>
    void forEachChunk(const Part& part)
    {
        const Chunks pieces(static_cast<int>(m_rows.size()), kRowsPerChunk);
        runTasks(pieces.count() > 1 ? m_settings.m_step.m_threads : nullptr, pieces.count(),
                 [&](int p) { part(p, pieces[p]); });
    }

private:
    static constexpr int kRowsPerChunk = 512;  // shorter pieces would not be worth handing out

    static void setAxes(const Vec3& normal, ContactRow& row);
    void addContactRows();
    void setContactRow(ContactRow& row, const ContactPoint& contact);
    Vec3 impulsePoint(const ContactPoint& contact) const;
    void addJointRow(const Joint& joint, const int* points);
    void addRigidContactRow(const RigidContact& touch);
    void addTorsionRow(const TorsionalFriction& torsion);
    void pressOnTorsions();
    void press(const ContactRow& row, const Vec3& impulse)
    {
        if (row.m_pressed >= 0) m_rows[row.m_pressed].m_load += dot(impulse, row.m_axes[0]);
    }
    static void limitContactFriction(ContactRow& row);
    ConstraintSide softEnd(const SurfacePoint& point, const Vec3& at, int end);
    bool isPoint(const JointEnd& end) const;
    void numberJointPoints();
    ConstraintSide jointEnd(const JointEnd& end, int point);
    ConstraintSide rigidEnd(int rigidProxy, const Vec3& point) const;
    void pushStarts(bool expected);
    void finishRows();
    void finishRow(ContactRow& row) const;
    void setContactTarget(ContactRow& row, const ContactPoint& contact) const;

    Vec3 velocity(const ConstraintSide& end) const;
    Vec3 meanVelocity(const ConstraintSide& end) const
    {
        return end.m_body >= 0 ? m_bodies[end.m_body].meanVelocity(end.m_end) : velocity(end);
    }
    Vec3 trueVelocity(const ContactRow& row) const;
    double violation(const ContactRow& row, const Vec3& trueVelocity) const;
    Vec3 newSlip(const ContactRow& row, const ContactPoint& contact) const;
    bool rests(const ContactRow& row) const;
    void react(const ConstraintSide& end, const Vec3& impulse);
    void solveCorrections();

    /// The largest value(k) of all rows, or 0 if none is more.
    template <class Value>
    double largestOfRows(const Value& value)
    {
        std::array<double, Chunks::kMax> largest{};
        forEachChunk(
            [&](int p, Range rows)
            {
                double ofChunk = 0;
                for (int k = rows.m_begin; k < rows.m_end; ++k) ofChunk = std::max(ofChunk, value(k));
                largest[p] = ofChunk;
            });
        return *std::max_element(largest.begin(), largest.end());
    }

    ContactProblem* m_problem = nullptr;
    ContactSettings m_settings;
    std::vector<SoftBodyContacts> m_bodies;
    std::vector<ImpulseResponse> m_corrections;  // of the last corrective solves
    std::vector<ImpulseResponse> m_ordered;      // in the order of the batches
    std::vector<int> m_corrected;                // bodies, one a correction
    std::vector<const Body*> m_correctedBodies;  // likewise
    BodyBatches m_batches;                       // of these
    std::vector<ContactRow> m_rows;
    std::vector<int> m_jointPoints;      // per joint the ends a and b: their points on their bodies, or -1
    std::vector<unsigned char> m_wants;  // per row
    bool m_dense = true;
    double m_shortestEdge = 0;  // [m]
    double m_loadSpeed = 0;     // [m/s]
    double m_speedScale = 0;    // that errors are measured against [m/s]
};

}  // namespace bullet_fem
