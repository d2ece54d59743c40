// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "bullet_fem/fem/batch/body_batches.h"
#include "bullet_fem/fem/contact/contact_problem.h"
#include "fem/common/chunks.h"
#include "fem/contact/compliance/soft_body_contacts.h"
#include "fem/contact/constraints/contact_row.h"

namespace bullet_fem
{

/// Result of a survey of all rows [m/s].
struct RowSurvey
{
    double m_wanted = 0;   ///< maximum velocity change of a contact's point by its local solution
    double m_guessed = 0;  ///< that maximum over contacts without a movable rigid proxy
    double m_closing = 0;  ///< maximum excess of a contact's approach speed over the allowed one
};

/// The rows of all contacts and joints of a problem, and the response of bodies and rigid proxies to their impulses.
/// ContactSweeps sweeps over them. Grows with the problem, never shrinks.
class ContactRows
{
public:
    /// Computes sides, frames and compliance of all rows, from free velocities of bodies and present ones of rigid
    /// proxies. `floor`: see SoftBodyContacts::beginCorrection(), for the initial impulses. The problem must live until
    /// the step is over.
    void assemble(ContactProblem& problem, const ContactSettings& settings, double floor);

    ContactProblem& problem() const { return *m_problem; }
    const ContactSettings& settings() const { return m_settings; }

    /// The rows of the contacts, the joints, the contacts between rigid proxies and the torsional frictions, in this
    /// order.
    std::vector<ContactRow>& rows() { return m_rows; }
    const std::vector<ContactRow>& rows() const { return m_rows; }
    SoftBodyContacts& body(int b) { return m_bodies[b]; }

    /// True if all bodies have a dense compliance: a change of one row changes the velocities of the others
    /// immediately.
    bool isDense() const { return m_dense; }

    /// Applies the initial impulses of the rows to the rigid proxies.
    void warmStart();

    /// Removes all impulses.
    void takeBack();

    /// Saves all impulses; restoreBest() restores those saved last, and the velocities follow.
    void keep();
    void restoreBest();

    /// True if a row starts with an impulse.
    bool hasImpulses() const;

    /// Solves the contacts between rigid proxies for the impulses so far. Returns whether there are any.
    bool settleRigidContacts();

    /// Velocity response of one side to an impulse on another [1/kg]; angular sides of rigid proxies have spins and
    /// angular impulses.
    Mat3 compliance(const ConstraintSide& of, const ConstraintSide& from) const;

    /// Mean compliance of a row's own sides by the elastic response of dense bodies, which has the rounding of single
    /// precision [1/kg].
    double elasticCompliance(const ContactRow& row) const
    {
        const auto ofSide = [this](const ConstraintSide& side)
        { return side.m_body >= 0 ? m_bodies[side.m_body].elasticCompliance(side.m_end) : 0; };
        return ofSide(row.m_a) + ofSide(row.m_b);
    }

    /// Index of the object that impulses on a side move: bodies, then rigid proxies; -1: none.
    int mover(const ConstraintSide& end) const;
    std::size_t movers() const { return m_problem->m_bodies.size() + m_problem->m_rigidProxies.size(); }

    /// True if one of its sides is a movable rigid proxy.
    bool movesRigid(const ContactRow& row) const;

    /// Position of a row other than a joint [m].
    Vec3 pointOf(std::size_t row) const;

    /// Predicted relative velocity of a row's sides [m/s].
    Vec3 velocity(const ContactRow& row) const { return velocity(row.m_a) - velocity(row.m_b); }

    /// Mean relative velocity of a row's sides over the step [m/s].
    Vec3 meanVelocity(const ContactRow& row) const { return meanVelocity(row.m_a) - meanVelocity(row.m_b); }

    /// Correction for the arc of a point on a turning rigid proxy, beyond h times its velocity at 1 - theta of the
    /// step: over a share theta of the step, divided by theta, and over the whole step [m].
    Vec3 arcOf(const ContactRow& row) const;

    /// Part of the gap that the arc of an immovable rigid proxy closes within the step, beyond its velocity [m].
    double closedByArc(const ContactRow& row) const;

    /// The motion of side a relative to side b beyond h times their velocities, as soft bodies turn [m].
    Vec3 softArc(const ContactRow& row) const
    {
        const auto ofSide = [this](const ConstraintSide& side)
        { return side.m_body >= 0 ? m_bodies[side.m_body].arc(side.m_end) : Vec3(); };
        return ofSide(row.m_a) - ofSide(row.m_b);
    }
    Vec3 arcOfMean(const ContactRow& row) const;

    /// StepCoefficients::theta() of a row's soft body, of two bodies the maximum, which is 1 if one uses implicit
    /// Euler. 1 without soft bodies.
    double theta(const ContactRow& row) const { return theta(row.m_a.m_body, row.m_b.m_body); }
    double theta(int a, int b) const;

    /// Changes a row's impulse; the velocities of its sides follow, for a body that is not dense at flush().
    void change(ContactRow& row, const Vec3& impulse);
    void flush();

    /// Adds to a row's impulse; the velocities of rigid proxies follow, those of bodies are combined by the caller.
    void pushAlong(ContactRow& row, const Vec3& impulse);

    /// Updates the sides' velocities from the bodies' true ones.
    void measure();

    /// Sets the scale of errors: the speed that the loads give a body in a step, or a missing speed [m/s].
    void setSpeedScale(double missing);
    double speedScale() const { return m_speedScale; }

    /// Lower bound of the scale: a motion per step of 1e-4 element edges [m/s].
    double slowestSpeed() const { return 1e-4 * m_shortestEdge / m_settings.m_step.m_step; }

    /// Minimum of the mean element edges of the bodies with sides [m].
    double shortestEdge() const { return m_shortestEdge; }

    /// Maximum speed that the loads alone would give a body in a step [m/s].
    double loadSpeed() const { return m_loadSpeed; }

    /// A speed divided by that scale; 1000 if the scale is 0.
    double share(double speed) const;

    /// True for a speed so far above the scale that sweeps diverge. The compliance of a body may be indefinite by its
    /// own errors, as for a stiff, light body on the low-memory path.
    bool isRunaway(double speed) const;

    /// Surveys all rows after measure(), and marks those that require a change.
    RowSurvey survey();

    /// Only marks them.
    void noteWants();

    /// True if, at the last marking, the row carried an impulse or required one, or was not a contact; most rows do
    /// not.
    bool wants(std::size_t k) const { return m_wants[k] != 0; }

    /// Velocity change of its point that such a row requires [m/s].
    double wantedSpeed(const ContactRow& row) const;

    /// Maximum of these, without joints within their limits, relative to the scale.
    double error();

    /// Solves the bodies' true systems for the new impulses; `floor` as in assemble(). `steady`: all impulses are those
    /// of a step similar to the previous one. Returns whether the rows' compliance has changed.
    bool apply(double floor, bool steady, ContactReport& report);

    /// True if a body has responded less than its compliance predicted: each outer iteration then removes only part of
    /// the error.
    bool isTooSoft() const;

    /// Maximum excess of a contact's true approach speed over the allowed one, and of the speeds that joints must
    /// change from zero impulses [m/s].
    double missingSpeed();

    /// See SoftBodyContacts.
    void noteReactions();

    /// Writes the impulses to the contacts and joints, and the slip of sticking points. Returns the maximum violation.
    double store();

    /// Threads for the computation of W; null: the caller's alone suffices.
    const Threads* threadsForCompliance() const;

    /// Calls part(b) for all bodies with sides, concurrently on these threads: it must write only to body b and its
    /// sides.
    template <class Part>
    void forEachContactBody(const Threads* threads, const Part& part)
    {
        runTasks(threads, static_cast<int>(m_problem->m_bodies.size()),
                 [&](int b)
                 {
                     if (m_bodies[b].size() > 0) part(b);
                 });
    }

    /// Calls part(p, rows) for ranges that cover all rows, concurrently on the settings' threads if there are many: it
    /// must write only to these rows.
    template <class Part>
    void forEachChunk(const Part& part)
    {
        const Chunks pieces(static_cast<int>(m_rows.size()), kRowsPerChunk);
        runTasks(pieces.count() > 1 ? m_settings.m_step.m_threads : nullptr, pieces.count(),
                 [&](int p) { part(p, pieces[p]); });
    }

private:
    static constexpr int kRowsPerChunk = 512;  // shorter chunks would not pay

    static void setAxes(const Vec3& normal, ContactRow& row);
    void addContactRows();
    void setContactRow(ContactRow& row, const ContactPoint& contact);
    Vec3 impulsePoint(const ContactPoint& contact, const Vec3& patch) const;
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
    bool actsAtStart(const JointEnd& end, const JointEnd& other) const;
    ConstraintSide jointEnd(const JointEnd& end, bool actsAtStart, int point);
    ConstraintSide rigidEnd(int rigidProxy, const Vec3& point) const;
    void pushStarts(bool expected);
    void finishRows();
    void finishRow(ContactRow& row) const;
    void setJointTarget(ContactRow& row) const;
    void setContactTarget(ContactRow& row, const ContactPoint& contact) const;

    Vec3 velocity(const ConstraintSide& end) const;
    Vec3 meanVelocity(const ConstraintSide& end) const
    {
        return end.m_body >= 0 ? m_bodies[end.m_body].meanVelocity(end.m_end) : velocity(end);
    }
    Vec3 trueVelocity(const ContactRow& row) const;
    double violation(const ContactRow& row, const Vec3& trueVelocity) const;
    double missingSpeed(const ContactRow& row) const;
    Vec3 newSlip(const ContactRow& row, const ContactPoint& contact) const;
    bool rests(const ContactRow& row) const;
    void react(const ConstraintSide& end, const Vec3& impulse);
    void solveCorrections();

    /// Maximum of value(k) over all rows, at least 0.
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
    std::vector<int> m_corrected;                // indices of bodies, one per correction
    std::vector<const Body*> m_correctedBodies;  // bodies, one per correction
    BodyBatches m_batches;                       // batches of m_correctedBodies
    std::vector<ContactRow> m_rows;
    std::vector<int> m_jointPoints;      // per joint, for sides a and b: their points on their bodies, or -1
    std::vector<unsigned char> m_wants;  // per row
    bool m_dense = true;
    double m_shortestEdge = 0;   // [m]
    double m_loadSpeed = 0;      // [m/s]
    double m_speedScale = 0;     // scale of errors [m/s]
    double m_largestWanted = 0;  // at the last survey [m/s]
};

}  // namespace bullet_fem
