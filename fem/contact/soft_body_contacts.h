// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/contact/contact_problem.h"
#include "bullet_fem/fem/step/stepping.h"
#include "fem/body/rigid_momentum.h"
#include "fem/contact/compliance_cache.h"
#include "fem/contact/point_compliance.h"
#include "fem/contact/working_set.h"

namespace bullet_fem
{

/// How closely a corrective solve is made: until its residual is below the tolerance of the step, of the right-hand
/// side or of this floor, or below a share of the right-hand side.
struct CorrectionGoal
{
    double m_floor = 0;  ///< share of all impulses on the body [-], >= 0
    double m_share = 0;  ///< [-], in [0, 1)
};

/// The places of one soft body where contacts and joints pull, and how all of them move when one is pushed: velocities
/// u = u_true + W (lambda - applied), with W_ef = J_e P J_f^T for the warped rest factor P. Up to a limit of ends, P
/// between the nodes that they are on is a dense matrix, formed from cached columns of A0^-1; beyond it P itself is
/// applied, to all new impulses at once. Grows with the number of ends, never shrinks.
class SoftBodyContacts
{
public:
    /// Another problem: points, then makeRoom(), then groups are to be added. Until then the ends are those of before.
    void clear(const ContactBody& body, const StepSettings& settings);

    /// Adds a point of the surface, for which room is to be made, and which is to be set; returns its index. Those of
    /// joints come last, after beginJoints().
    int addPoint() { return m_added++; }
    void beginJoints() { m_firstJoint = m_added; }
    void makeRoom() { m_ends.resize(m_added); }

    /// True if the body has the columns of A0^-1 at a node: joints at such nodes may be points.
    bool serves(int node) const { return m_body.m_compliance->serves(node); }

    /// The node that an end is, if it is one that can move and whose W is s R (A0^-1) R^T; else -1. After form().
    int nodeOf(int e) const;

    /// R of a node, s, and a factor of the blocks (A0^-1) between nodes, three rows a node.
    Mat3 rotation(int node) const;
    double scale() const { return m_scale; }
    std::shared_ptr<const EnvelopeFactor> restFactorOf(const std::vector<int>& nodes) const
    {
        return m_body.m_compliance->factorOf(nodes);
    }

    /// Sets it: its impulse counts as acting at `at` [m]. May be called by several threads at once, for different ones.
    void setPoint(int e, const SurfacePoint& point, const Vec3& at);

    /// Adds a group of nodes, behind all points; returns its index. Its nodes and blocks must live until the step is
    /// over.
    int addGroup(const int* nodes, const Mat3* blocks, int count);

    /// When all ends are added: makes ready for request() and form(), which are to follow, for a step [s]. The
    /// compliance is dense for at most denseLimit ends, and between those of joints always.
    void assemble(int denseLimit, double step);

    /// Asks for what form() needs of the model's compliance. Not for two bodies of one cache at a time.
    void request(const Threads* threads = nullptr);

    /// Forms the compliance.
    void form();

    int size() const { return static_cast<int>(m_ends.size()); }

    /// True if the last correction scaled W up; compliance() has grown then.
    bool hasLearnt() const { return m_learnt; }

    /// True if the body has answered much less than W said, in any correction of this problem.
    bool isTooSoft() const { return m_tooSoft; }

    /// The speed [m/s] that its loads alone would give the body in the step.
    double loadSpeed() const { return m_loadSpeed; }

    bool isDense() const { return m_dense; }
    const Body& body() const { return *m_body.m_body; }

    /// W_ef; of a body that is not dense, but for ends of joints, only an estimate of W_ee, and zero for e != f.
    Mat3 compliance(int e, int f) const;

    /// As predicted [m/s]; of a dense body that of an end which does not work is that of the last refresh().
    Vec3 velocity(int e) const { return m_dense && m_working.has(e) ? m_working.velocity(e) : known(e); }

    /// With which the end moves in the step, by velocity() and what was before [m/s].
    Vec3 meanVelocity(int e) const;

    /// Of the body's step: see StepCoefficients [-].
    double theta() const { return m_theta; }

    /// Of the body [kg]; not there in steps of implicit Euler, which do not ask.
    double mass() const { return m_mass; }

    /// From the true velocities of the body [m/s].
    Vec3 trueVelocity(int e) const;

    /// Adds an impulse to an end. The velocities of the working set follow at once if the end belongs to it; those of
    /// other ends with refresh(), or flush() if not dense.
    void push(int e, const Vec3& impulse);
    void flush();

    /// Brings all velocities up to date (dense only).
    void refresh();

    /// Chooses another working set (dense only): after a refresh(), choose, work(e) once or again for each end of it,
    /// and startWork.
    void choose() { m_working.choose(); }
    void work(int e) { m_working.add(e); }
    void startWork() { m_working.pack(m_points, m_slotVelocity); }

    /// The working set, for mixes; pushAlong adds an impulse to an end whose velocities a mix adds.
    WorkingSet& working() { return m_working; }
    void pushAlong(int e, const Vec3& impulse) { m_impulse[e] += impulse; }

    /// True of an end whose impulse the body's free motion may have been solved with: takeExpected() is to be called
    /// once these have been pushed.
    bool isExpected(int e) const { return m_body.m_predicted && e < m_firstJoint && !isGroup(m_ends[e]); }
    bool expects() const { return m_body.m_predicted != nullptr; }

    /// The impulses so far of such ends count as applied; what they are other than expected is left to the next
    /// correction, at once if it is much, but for the momentum. Without ends all is taken back.
    void takeExpected(const StepSettings& settings, const CorrectionGoal& goal);

    /// Takes the velocities from the body, which holds the impulses applied so far, and adds W times the rest.
    void measure();

    /// What is to be solved of the body's true system for the impulses that are not applied yet, and what the last
    /// correction left; without a body if there is nothing. After that is solved, endCorrection: W learns from it, and
    /// where it was too stiff, it is scaled up; not from velocities that are lost in the rounding of the body's own.
    ImpulseResponse beginCorrection(const StepSettings& settings, const CorrectionGoal& goal);
    void endCorrection();

    /// Tells the body's supports what contacts and joints have given it.
    void noteReactions();

    /// Forgets velocities and impulses, to solve for position corrections; applyPositionCorrection then makes them.
    /// Returns the angular momentum that the body gained by being elsewhere [kg m2/s].
    void beginPush();
    Vec3 applyPositionCorrection(const StepSettings& settings);

    /// Changes the body's angular momentum by a rigid spin, where it is free [N m s].
    void spin(const Vec3& angularImpulse, const StepSettings& settings);

private:
    struct End
    {
        SurfacePoint m_point;
        const int* m_nodes = nullptr;  // of a group
        const Mat3* m_blocks = nullptr;
        int m_count = 0;
        Vec3 m_offset;  // from where the nodes feel the impulse to where it acts [m]
    };

    // What a correction showed of W: the work of its impulses on the velocities that they made, and their sum [N s].
    struct Lesson
    {
        double m_trueWork, m_predictedWork, m_impulses;
    };

    bool hasContacts() const { return m_firstJoint > 0; }
    bool isGroup(const End& end) const { return end.m_nodes != nullptr; }
    Vec3 read(const End& end, const std::vector<Vec3>& nodeValues) const;
    void scatter(const End& end, const Vec3& impulse, std::vector<Vec3>& nodeImpulses) const;
    Vec3 known(int e) const { return m_dense ? m_points.read(e, m_slotVelocity) : m_velocity[e]; }
    Vec3 before(int e) const { return m_dense ? m_points.read(e, m_slotBefore) : m_before[e]; }
    void formGroup(int e);
    void measureSlots();
    void estimateDiagonal();
    bool gatherBeyond(const std::vector<Vec3>& known);
    double floorOf(const CorrectionGoal& goal) const;
    void addLevers(const StepSettings& settings);
    Vec3 groupLever(const End& end, const Vec3& impulse) const;
    void giveUpExpected(const StepSettings& settings);
    void formOwn();
    void see(int e);
    bool isAboveRounding(const Lesson& lesson) const;
    void learn(const Lesson& lesson);
    void learnRigid(const Lesson& lesson);
    void addRigid(double share);

    ContactBody m_body;
    bool m_dense = true;
    double m_loadSpeed = 0;  // [m/s]
    double m_theta = 1;      // see StepCoefficients
    double m_mass = 0;       // [kg]
    bool m_formed = false;
    int m_added = 0;       // points
    int m_firstJoint = 0;  // first end of a joint
    int m_firstPoint = 0;  // first end that m_points has: of a dense body all, else those of joints
    std::vector<End> m_ends;
    std::vector<Vec3> m_impulse;                       // per end, all
    std::vector<Vec3> m_applied;                       // per end, in the body's true velocities
    std::vector<Vec3> m_seen;                          // per end, in the velocities
    std::vector<Vec3> m_velocity, m_before;            // per end, not dense: now, and before this round's impulses
    std::vector<double> m_slotVelocity, m_slotBefore;  // dense: the same of the slots of m_points
    PointCompliance m_points;
    WorkingSet m_working;
    std::vector<Mat3> m_own;            // dense: W_ee
    bool m_pushedAtRest = false;        // dense: an end outside the working set has an impulse that that has not seen
    std::vector<Response> m_responses;  // of a refresh
    std::vector<Vec3> m_nodeIn, m_nodeOut;       // impulses and velocities of all nodes
    Mat3 m_meanDiagonal;                         // not dense: estimate of W_ee, without the learnt scale
    double m_scale = 1;                          // learnt
    double m_rigid = 0;                          // learnt: share of the rigid answer in W, in [0, 1]
    std::vector<RigidMomentum::Share> m_shares;  // per slot
    bool m_learnt = false;                       // in the last correction
    bool m_tooSoft = false;                      // in any of this problem
    bool m_leftMuch = false;                     // the last correction did, of its right-hand side
    bool m_mixed = false;  // the next one also solves for what was expected in vain: W learns nothing
    double m_allWork = 0;  // of the impulses so far, roughly [J]
};

}  // namespace bullet_fem
