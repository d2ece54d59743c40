// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "bullet_fem/fem/contact_solver.h"
#include "fem/body_batches.h"
#include "fem/contact/body_ends.h"
#include "fem/contact/sweep_parts.h"
#include "fem/pieces.h"

namespace bullet_fem
{

/// The rows of all contacts and joints of a problem, and sweeps over them. Every row is a triple of impulses between
/// two ends. Grows with the problem, never shrinks.
class ContactRows
{
public:
    /// Ends, frames and compliance of all rows, from free velocities of bodies and present ones of obstacles.
    void assemble(ContactProblem& problem, const ContactSettings& settings);

    /// Gives the obstacles the reactions of the impulses that the rows start with.
    void warmStart();

    /// True if a row starts with an impulse.
    bool hasImpulses() const;

    /// Lets the touches of obstacles answer what the impulses so far do to them.
    void settleTouches();

    /// Brings the ends' velocities up to the bodies' true ones.
    void measure();

    /// What changes are measured against from here on: the speed that the loads give a body in a step, or the largest
    /// that rows have to change now [m/s]; where there are no loads, or that the guesses have changed.
    void setSpeedScale();

    /// One sweep; the velocities of ends and obstacles follow. Gauss-Seidel over the rows that carry something while
    /// all bodies have a dense compliance, with subspace minimizations between, else an accelerated projected gradient
    /// step on all rows at once. True if an impulse changed, or is to change, by more than the tolerance: the speed
    /// that it gives a row's own point over the scale; after a gradient step, of which many short ones make up a way,
    /// what a whole step of every row alone would still change.
    bool sweep(double tolerance);

    /// True if the last sweep changed a velocity by so much that sweeping leads nowhere. The compliance of a body may
    /// be indefinite by its own errors: that of a stiff, light body on the low-memory path.
    bool runsAway() const { return isRunaway(m_lastSpeed); }

    /// Takes back the impulses on all bodies and obstacles that run away, and holds them no more in this step.
    void letGo();

    /// What the last sweep in turn changed, likewise; 0 of one at once, whose short steps need not shrink.
    double lastChange() const { return m_lastChange; }

    /// Rows of others have changed the obstacles' velocities since the last sweep.
    void othersMoved() { m_looked = false; }

    /// A speed as a share of that scale; 1000 if there is none.
    double share(double speed) const;

    /// What a sweep would change after measure(), likewise.
    double error() { return share(largestChange()); }

    /// Solves the bodies' true systems for what is new. `steady`: the impulses are all of a step much like the one
    /// before.
    void apply(const CorrectionGoal& goal, bool steady, ContactReport& report);

    /// True if a body has answered less than its compliance said: rounds go a part of the way only.
    bool isTooSoft() const;

    /// Largest change of an impulse since the last call, over the largest impulse.
    double changeOfRound();

    /// The largest speed [m/s] at which a contact closes faster than allowed, from the bodies' true velocities.
    double worstViolation();

    /// Hands the impulses to the contacts and joints, and the slip of what sticks.
    void store();

    /// True if a penetration exceeds its slop.
    bool needPush() const;

    /// Takes penetration back: the same rows once more, for the velocities of position correction. Returns the sweeps
    /// made.
    int push();

private:
    struct RowEnd
    {
        int m_body = -1, m_end = -1;  // soft
        int m_obstacle = -1;          // rigid
        bool m_angular = false;
        Vec3 m_arm;  // from the obstacle's centre [m]

        bool sharesOwner(const RowEnd& other) const { return m_body == other.m_body && m_obstacle == other.m_obstacle; }
    };
    struct Row  // what every look at a row reads comes first, what only some need last
    {
        bool m_joint = false;
        bool m_touch = false;  // of obstacles
        bool m_idle = false;   // nothing can move: no compliance
        int m_freeAxes = 0;    // that nothing limits: 1: the normal; 3: all
        RowEnd m_a, m_b;
        Vec3 m_impulse;        // on end a
        Vec3 m_target;         // relative velocity along the axes: at least (normal), exactly (joint) [m/s]
        Vec3 m_axes[3];        // normal and tangents; a joint's axes
        Vec3 m_rowCompliance;  // of every axis; a contact's tangents share the largest of their plane
        Vec3 m_yield;          // compliance added along the axes [1/kg]
        double m_friction = 0;
        Mat3 m_compliance;                              // of the relative velocity to the impulse [1/kg]
        Vec3 m_residual, m_direction, m_response;       // of a minimization, along the axes
        Vec3 m_roundImpulse;                            // at the end of the last round
        Vec3 m_lastImpulse, m_lastVelocity, m_pending;  // of the sweeps at once
        Vec3 m_limit;                                   // of a joint's impulses
        double m_most = 0;                              // and of their sum
        double m_softness = 0, m_spring = 0;            // of a joint: as a share of its compliance, and [1/kg]
    };

    struct Subspace  // how sweeps and minimizations take turns
    {
        int m_sweeps = 0;        // since the last minimization
        double m_sweepWork = 0;  // of the last sweep's changes
        double m_work = 0;       // the same before the last minimization
        bool m_tried = false;    // its sweeps have not proved it yet
    };

    struct Swept  // what a sweep in turn over some rows has changed
    {
        double m_largest = 0;  // [m/s]
        double m_work = 0;     // roughly [J]
    };

    static constexpr int kRowsOfPiece = 512;  // shorter pieces would not be worth handing out

    struct Pushed  // a body, by its position corrections
    {
        Vec3 m_gained;                     // angular momentum [kg m2/s]
        double m_total = 0, m_bySoft = 0;  // impulses on it, and those of soft bodies [N s]
    };

    static void setAxes(const Vec3& normal, Row& row);
    void addContactRow(const ContactPoint& contact);
    void addJointRow(const Joint& joint);
    void addTouchRow(const RigidTouch& touch);
    void limitTouchFriction(Row& row) const;
    RowEnd softEnd(const SurfacePoint& point, const Vec3& at);
    RowEnd jointEnd(const JointEnd& end);
    RowEnd rigidEnd(int obstacle, const Vec3& point) const;
    void divideRows();
    void finishRows();
    void finishRow(Row& row) const;
    void setContactTarget(Row& row, const ContactPoint& contact) const;
    Vec3 priorVelocity(const Row& row, const ContactPoint& contact) const;

    Vec3 velocity(const RowEnd& end) const;
    Vec3 velocity(const Row& row) const { return velocity(row.m_a) - velocity(row.m_b); }
    Vec3 trueVelocity(const Row& row) const;
    double violation(const Row& row) const;
    Vec3 newSlip(const Row& row, const ContactPoint& contact) const;
    Mat3 compliance(const RowEnd& end) const;
    void react(const RowEnd& end, const Vec3& impulse);
    void change(Row& row, const Vec3& impulse);
    void flush();

    Vec3 solveContact(const Row& row, const Vec3& impulse, Vec3 velocity, double step) const;
    Vec3 solveJoint(const Row& row, const Vec3& impulse, Vec3 velocity, double step) const;
    Vec3 solveRow(const Row& row, const Vec3& impulse, const Vec3& velocity, double step) const;
    void solveCorrections();
    void restart();
    void reserve();
    void forgetWorkingSet();
    void chooseWorkingSet();
    bool rests(const Row& row) const;
    void lookForWork();
    bool restIsDone(double tolerance);
    double largestChange();
    static double speedOf(const Row& row, const Vec3& difference);
    double wantedSpeed(const Row& row) const;
    double loadSpeed() const;
    double sweepInTurn();
    bool isRunaway(double speed) const;
    Swept sweepRows(Range rows);
    Swept sweepOnce(Range rows);
    int endOfPair(int begin, int end) const;
    void searchSubspace();
    void chooseSubspace();
    void minimizeOverSubspace();
    template <class Term>
    double sumOverSubspace(const Term& term);
    void respondToDirections();
    void followDirections(double step);
    double sweepAtOnce();
    void chooseStep();
    /// Calls part(b) for all bodies with ends, on these threads at the same time: it must write to nothing but body b
    /// and its ends.
    template <class Part>
    void forEachTouchedBody(const Threads* threads, const Part& part)
    {
        runTasks(threads, static_cast<int>(m_problem->m_bodies.size()),
                 [&](int b)
                 {
                     if (m_bodies[b].size() > 0) part(b);
                 });
    }
    const Threads* threadsForCompliance() const;
    /// Calls part(p, rows) for ranges that make up all rows, where they are many on these threads at the same time: it
    /// must write to nothing but these rows.
    template <class Part>
    void forEachPieceOfRows(const Part& part)
    {
        const Pieces pieces(static_cast<int>(m_rows.size()), kRowsOfPiece);
        runTasks(pieces.count() > 1 ? m_settings.m_step.m_threads : nullptr, pieces.count(),
                 [&](int p) { part(p, pieces[p]); });
    }
    /// The largest value(row) of all rows, or 0 if none is more.
    template <class Value>
    double largestOfRows(const Value& value)
    {
        std::array<double, Pieces::kMost> largest{};
        forEachPieceOfRows(
            [&](int p, Range rows)
            {
                for (int k = rows.m_begin; k < rows.m_end; ++k) largest[p] = std::max(largest[p], value(m_rows[k]));
            });
        return *std::max_element(largest.begin(), largest.end());
    }
    void preparePush();
    void prepareTouches();
    void sumPushImpulses();
    void payBack();

    ContactProblem* m_problem = nullptr;
    ContactSettings m_settings;
    std::vector<BodyEnds> m_bodies;
    std::vector<ImpulseResponse> m_corrections;     // of the last corrective solves
    std::vector<ImpulseResponse> m_ordered;         // in the order of the batches
    std::vector<int> m_corrected;                   // bodies, one a correction
    std::vector<const Body*> m_correctedBodies;     // likewise
    BodyBatches m_batches;                          // of these
    std::vector<Row> m_rows;                        // of the contacts, then of the joints
    bool m_inTurn = true;                           // Gauss-Seidel
    SweepParts m_parts;                             // of the rows
    std::vector<int> m_working;                     // rows that the sweeps in turn are over, part by part
    std::vector<unsigned char> m_runaways;          // per body, then per obstacle: is being let go
    std::vector<unsigned char> m_works;             // per row: belongs to them
    std::vector<unsigned char> m_wants;             // per row: is to belong to the next, if it has been looked for
    bool m_looked = false;                          // and nothing has changed since
    int m_lifeOfSet = -1;                           // sweeps until another is chosen; -1: there is none
    double m_lastChange = 0;                        // by the last sweep in turn
    double m_lastSpeed = 0;                         // the same, or that of a sweep at once [m/s]
    double m_speedScale = 0;                        // that errors are measured against [m/s]
    double m_gradientStep = 1, m_acceleration = 1;  // of the sweeps at once
    Subspace m_subspace;
    std::vector<std::pair<int, Vec3>> m_saved;        // rows, and their impulses before the last minimization
    std::vector<Vec3> m_probeLinear, m_probeAngular;  // of the obstacles, while their response is asked for
    std::vector<Vec3> m_savedLinear, m_savedAngular;  // of the obstacles, while their pushes are solved for
    std::vector<Pushed> m_pushed;                     // one a body
};

}  // namespace bullet_fem
