// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/contact/contact_problem.h"
#include "bullet_fem/fem/step/stepping.h"
#include "fem/body/rigid_momentum.h"
#include "fem/contact/compliance/compliance_cache.h"
#include "fem/contact/compliance/point_compliance.h"
#include "fem/contact/compliance/working_set.h"

namespace bullet_fem
{

/// The sides of contacts and joints on one soft body, and their coupled response: velocities u = u_true + W (lambda -
/// applied), with W_ef = J_e P J_f^T for the warped rest factor P. Up to a limit of sides, P between their nodes is a
/// dense matrix, formed from cached columns of A0^-1; beyond it P itself is applied, to all new impulses at once. Grows
/// with the number of sides, never shrinks.
class SoftBodyContacts
{
public:
    /// Begins a problem: then add points, makeRoom(), and groups. Until then the sides are the former ones.
    void clear(const ContactBody& body, const StepSettings& settings);

    /// Adds a surface point, to be followed by makeRoom() and by setting it; returns its index. Points of joints come
    /// last, after beginJoints().
    int addPoint() { return m_added++; }
    void beginJoints() { m_firstJoint = m_added; }
    void makeRoom() { m_ends.resize(m_added); }

    /// True if joints at a node may be points: the node is on the surface, and the body has its columns of A0^-1. An
    /// inner node has columns only from the step on in which it was exposed, and results must not depend on the past.
    bool serves(int node) const;

    /// The node of a side, if it is a single movable node; else -1. Call after form().
    int nodeOf(int e) const;

    /// R of a node, s, and a factor of the blocks (A0^-1) between nodes, three rows per node.
    Mat3 rotation(int node) const;
    double scale() const { return m_scale; }
    std::shared_ptr<const EnvelopeFactor> restFactorOf(const std::vector<int>& nodes) const
    {
        return m_body.m_compliance->factorOf(nodes);
    }

    /// Sets a point; its impulse acts at `at` [m]. May be called by several threads at once, for different points.
    void setPoint(int e, const SurfacePoint& point, const Vec3& at);

    /// Adds a group of nodes, behind all points; returns its index. Its nodes and blocks must live until the step is
    /// over. Its impulse acts at the nodes' positions y, or at those at the beginning of the step.
    int addGroup(const int* nodes, const Mat3* blocks, int count, bool actsAtStart);

    /// Call when all sides are added: prepares request() and form(), which must follow, for a step [s]. The compliance
    /// is dense for at most denseLimit sides, and always between those of joints.
    void assemble(int denseLimit, double step);

    /// Requests the compliance that form() needs from the model's cache. Not concurrently for two bodies of one cache.
    void request(const Threads* threads = nullptr);

    /// Forms the compliance.
    void form();

    int size() const { return static_cast<int>(m_ends.size()); }

    /// True if the last correction changed W, and with it compliance().
    bool hasLearnt() const { return m_learnt; }

    /// True if the body has responded much less than W predicted, in any correction of this problem.
    bool isTooSoft() const { return m_tooSoft; }

    /// Speed that the loads alone would give the body in the step [m/s].
    double loadSpeed() const { return m_loadSpeed; }

    bool isDense() const { return m_dense; }
    const Body& body() const { return *m_body.m_body; }

    /// W_ef; for a body that is not dense, except between sides of joints, only an estimate of W_ee, and zero for e !=
    /// f.
    Mat3 compliance(int e, int f) const;

    /// Mean of the elastic part of W_ee, for a dense body [1/kg].
    double elasticCompliance(int e) const;

    /// Predicted velocity of a side [m/s]; for a dense body outside the working set that of the last refresh().
    Vec3 velocity(int e) const { return m_dense && m_working.has(e) ? m_working.velocity(e) : known(e); }

    /// Motion of a side over the step beyond h times its velocity at the end, by the body's turn in an implicit Euler
    /// step: its nodes go along arcs [m].
    Vec3 arc(int e) const;

    /// Mean velocity of a side over the step, from velocity() and the velocity before [m/s].
    Vec3 meanVelocity(int e) const;

    /// Coefficients of the body's step: see StepCoefficients [-].
    double theta() const { return m_theta; }

    /// Mass of the body [kg]; not set for steps of implicit Euler, which do not need it.
    double mass() const { return m_mass; }

    /// Velocity of a side from the body's true velocities [m/s].
    Vec3 trueVelocity(int e) const;

    /// Adds an impulse to a side. The velocities of the working set follow immediately if the side belongs to it; those
    /// of other sides at refresh(), or flush() if not dense.
    void push(int e, const Vec3& impulse);
    void flush();

    /// Updates all velocities (dense only).
    void refresh();

    /// Chooses another working set (dense only): after a refresh(), call choose, then work(e), repetitions allowed, for
    /// each side in it, and startWork.
    void choose() { m_working.choose(); }
    void work(int e) { m_working.add(e); }
    void startWork() { m_working.pack(m_slotVelocity); }

    /// The working set, for Anderson mixing; pushAlong adds an impulse to a side whose velocities the mix adds.
    WorkingSet& working() { return m_working; }
    void pushAlong(int e, const Vec3& impulse) { m_impulse[e] += impulse; }

    /// True for a side whose impulse may be included in the body's free motion: call takeExpected() once these have
    /// been pushed.
    bool isExpected(int e) const { return m_body.m_predicted && e < m_firstJoint && !isGroup(m_ends[e]); }
    bool expects() const { return m_body.m_predicted != nullptr; }

    /// Counts the impulses so far of such sides as applied. Their difference from the expected ones joins the residual
    /// of the next correction, which is due even without new impulses if it is large; momentum is corrected
    /// immediately. Without sides, all expected impulses are removed.
    void takeExpected(const StepSettings& settings, double floor);

    /// Computes the velocities from those of the body, which include the impulses applied so far, plus W times the
    /// rest.
    void measure();

    /// The right-hand side of the body's next correction: the impulses not applied yet; without a body if there is
    /// nothing to solve. It ends when its residual is below the step's tolerance of the right-hand side, or of `floor`,
    /// a share of all impulses on the body [-], >= 0. Call endCorrection after the solve: it compares the
    /// result with W, and scales W up if it was too stiff, unless the velocities are lost in rounding. For small bodies
    /// with contacts and joints, W is formed from A itself if it was too stiff or too soft, now and in the next steps.
    ImpulseResponse beginCorrection(const StepSettings& settings, double floor);
    void endCorrection();

    /// Adds the impulses of contacts and joints to the body's support reactions.
    void noteReactions();

    /// Clears velocities and impulses, to solve for position corrections, which applyPositionCorrection then applies.
    /// Returns the angular momentum gained by the displacement [kg m2/s].
    void beginPush();
    Vec3 applyPositionCorrection(const StepSettings& settings);

    /// Changes the body's angular momentum by a rigid spin, if it is free [N m s].
    void spin(const Vec3& angularImpulse, const StepSettings& settings);

private:
    struct End
    {
        SurfacePoint m_point;
        const int* m_nodes = nullptr;  // nodes of a group
        const Mat3* m_blocks = nullptr;
        int m_count = 0;
        bool m_actsAtStart = false;  // of groups: see addGroup()
        Vec3 m_offset;               // from the nodes' point of action to the impulse's [m]
    };

    // Statistics of a correction for W: the work of its impulses on the resulting velocities, and their sum [N s].
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
    void findShares();
    bool mayBePresent() const;
    void formPresent();
    void formGroups();
    void formGroup(int e);
    void measureSlots();
    void estimateDiagonal();
    bool gatherBeyond(const std::vector<Vec3>& known);
    double normOfFloor(double floor) const;
    void addLevers(const StepSettings& settings);
    Vec3 groupLever(const End& end, const Vec3& impulse) const;
    void giveUpExpected(const StepSettings& settings);
    void formOwn();
    void see(int e);
    double rigidWork();
    bool isAboveRounding(const Lesson& lesson) const;
    void learn(const Lesson& lesson);
    void judge(const Lesson& lesson, double rigidWork);
    void followCompliance();

    ContactBody m_body;
    bool m_dense = true;
    double m_loadSpeed = 0;  // [m/s]
    StepSettings m_settings;
    double m_step = 0;   // h [s]
    double m_theta = 1;  // see StepCoefficients
    double m_mass = 0;   // [kg]
    bool m_formed = false;
    bool m_isPresent = false;  // W is that of A
    int m_added = 0;           // number of points
    int m_firstJoint = 0;      // first side of a joint
    int m_firstPoint = 0;      // first side in m_points: for a dense body all, else those of joints
    std::vector<End> m_ends;
    std::vector<Vec3> m_impulse;  // per side: total impulse
    std::vector<Vec3> m_applied;  // per side: impulse included in the body's true velocities
    std::vector<Vec3> m_seen;     // per side: impulse included in the predicted velocities
    // per side, not dense: now, and before the impulses of this outer iteration
    std::vector<Vec3> m_velocity, m_before;
    std::vector<double> m_slotVelocity, m_slotBefore;  // dense: velocities of the slots of m_points, now and before
    PointCompliance m_points;
    WorkingSet m_working;
    std::vector<Mat3> m_own;  // dense: W_ee
    // dense: a side outside the working set has an impulse that the set's velocities do not include
    bool m_pushedAtRest = false;
    std::vector<Vec3> m_slotImpulse;             // impulses of a refresh on the slots
    std::vector<Response> m_responses;           // their elastic responses
    std::vector<RigidMotion> m_motions;          // and the rigid ones, per component
    std::vector<Vec3> m_nodeIn, m_nodeOut;       // impulses and velocities of all nodes
    Mat3 m_meanDiagonal;                         // not dense: estimate of W_ee
    double m_scale = 1;                          // learnt scale of the elastic part of W
    std::vector<RigidMomentum::Share> m_shares;  // per slot
    bool m_learnt = false;                       // the last correction changed the scale
    bool m_tooSoft = false;                      // W was too soft in a correction of this problem
    bool m_mixed = false;  // the next correction also removes wrong expected impulses: W learns nothing from it
    double m_allWork = 0;  // approximate work of the impulses so far [J]
};

}  // namespace bullet_fem
