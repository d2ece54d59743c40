// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/contact/cloth/cloth_contacts.h"
#include "bullet_bridge/contact/rigid/rigid_search.h"
#include "bullet_bridge/contact/rigid/torsional_patches.h"
#include "bullet_bridge/contact/soft/soft_pair_search.h"
#include "bullet_bridge/joints/soft_joints.h"
#include "bullet_bridge/rigid/bullet_rows.h"
#include "bullet_bridge/rigid/multibody_rows.h"
#include "bullet_bridge/rigid/rebounds.h"
#include "bullet_bridge/rigid/rigid_contacts.h"
#include "bullet_bridge/rigid/rigid_rewind.h"
#include "bullet_bridge/rigid/solver_bodies.h"
#include "bullet_fem/btFemSolverInfo.h"
#include "plugin/joints/btFemWeldBreaker.h"
#include "plugin/record/btFemBodyRecord.h"
#include "plugin/record/btFemCoupling.h"
#include "plugin/record/btFemTouches.h"

/// FEM bodies that are solved together: collects their contacts and joints, solves them, and writes the reports. Keeps
/// scratch, and the contact state from step to step.
class btFemContactGroup
{
public:
    /// `threads` share the searches and the corrective solves, which use `memory` if it is not null. Both must outlive
    /// the group.
    btFemContactGroup(const btFemSolverInfo& info, const bullet_fem::Threads& threads, bullet_fem::BatchMemory* memory)
        : m_info(info),
          m_rigidSearch(threads, info.m_contactDamping == 1),
          m_softPairs(threads),
          m_rebounds(info.m_elasticRebound)
    {
        m_settings.m_step.m_threads = &threads;
        m_settings.m_step.m_batchMemory = memory;
    }

    /// The bodies to be solved together, all known bodies, and the step.
    struct Scope
    {
        const std::vector<btFemBodyRecord*>& m_records;
        const btFemRecords& m_all;
        double m_step;  ///< time step of the world [s]
        bullet_fem::RigidPhase m_phase;
        const btFemIsland* m_island = nullptr;        ///< phase `solving`: that of Bullet
        bullet_fem::RigidRewind* m_rewind = nullptr;  ///< instead of them: islands put back; those in contact stay so
    };

    /// Call at the start of a step of `step` [s].
    void beginStep(double step);

    /// Notes the velocity of a rigid body before Bullet's rigid solver. May be called by several threads at once.
    void noteBeforeSolve(const btCollisionObject& object) { m_rigid.noteBeforeSolve(object); }

    /// See ArticulatedBodies::assumeForcesGiven.
    void assumeForcesGiven(const bullet_fem::Vec3& gravity) { m_rigid.links().assumeForcesGiven(gravity); }

    /// Finds contacts and joints of the bodies after their free motion.
    void collect(const Scope& scope);

    /// True if there are neither contacts nor joints.
    bool isEmpty() const { return m_problem.m_contacts.empty() && m_problem.m_joints.empty(); }

    /// The bodies that have contacts.
    const std::vector<btFemBodyRecord*>& touching() const { return m_overlapping; }

    /// True if every movable rigid body of the group is in `island`, as is every movable link of a multibody (none
    /// is permitted unless `linksToo`), and no joint connects the group to other active soft bodies.
    bool holdsOnly(const btFemIsland& island, bool linksToo) const;

    /// Solves after Bullet's rigid solver, and applies the reactions to the rigid bodies.
    void solve();

    /// Solves within Bullet's rigid solver, after its set-up, the group's problem with Bullet's constraints in it, and
    /// writes all velocities and impulses back. moveRigid follows after the rigid solver has written its bodies back.
    /// `links`: constraints of multibodies; null for a solver without them.
    void solveWith(const bullet_fem::BulletConstraints& bullet,
                   const bullet_fem::MultiBodyConstraints* links = nullptr);

    /// Solves in turn with Bullet's rigid solver, on its solver bodies, by the functions of ContactSolver: begin; while
    /// needsOuterIteration, one outer iteration of sweep (repeatedly) and correct; restoreBest if shouldRollBack;
    /// finally finish; and moveRigid after the rigid solver has written its bodies back. `others`: largest velocity
    /// change by Bullet's rows since the last sweep [m/s]. `linkDeltas`: see LinkDeltas::begin.
    void begin(btAlignedObjectArray<btSolverBody>& pool, btAlignedObjectArray<btScalar>& linkDeltas);
    bool sweep(double others);
    bool needsOuterIteration() const { return m_solver.needsOuterIteration(); }
    void correct();
    bool isBest() const { return m_solver.isBest(); }
    bool shouldRollBack() const { return m_solver.shouldRollBack(); }
    void restoreBest();
    void finish();
    void moveRigid();

    /// Call at the end of the step: applies restitution. `records` are all bodies whose contact was solved in this
    /// step; `step` [s].
    void giveRebounds(const std::vector<btFemBodyRecord*>& records, bullet_fem::WorldObjects& world, double step);

    const bullet_fem::ContactSettings& settings() const { return m_settings; }

    /// State that persists from step to step.
    bullet_fem::RigidProxies& rigid() { return m_rigid; }
    const bullet_fem::RigidProxies& rigid() const { return m_rigid; }
    /// The cloth contacts, in which pairs are noted.
    bullet_fem::ClothContacts& cloth() { return m_cloth; }

    btFemWeldBreaker& welds() { return m_welds; }

    bullet_fem::SoftPairMemory& softPairs() { return m_softPairs.memory(); }
    const bullet_fem::SoftPairMemory& softPairs() const { return m_softPairs.memory(); }

private:
    /// Largest tolerance in turn with Bullet's rows, which respond to the remaining error, and with rows of multibodies
    /// [-]. At 3e-3, heavy soft bodies on light rigid ones shook by 3 cm, and fingers moved at .3 mm/s while they held.
    static constexpr double kToleranceWithRows = 1e-4;

    void clearProblem();
    void findRigid();
    void findSoft();
    void findCloth();
    void findRigidContacts();
    void addIsland(const Scope& scope);
    void collectContacts();
    void listOverlaps();
    void alignLinks(std::vector<bullet_fem::ContactPoint>& contacts) const;
    void collectJoints(const Scope& scope);
    template <class Part>
    void onSolverBodies(const Part& part);
    void noteImpacts();
    void report(const bullet_fem::ContactReport& report);
    void makeRoomForReports();
    void reportCloth(std::size_t b);
    void reportBody(std::size_t b, const bullet_fem::ContactReport& report);
    void reportRebound(const bullet_fem::GivenRebound& given, const std::vector<btFemBodyRecord*>& records);

    btFemSolverInfo m_info;
    double m_step = 0;  // [s]
    std::vector<btFemBodyRecord*> m_records;
    std::vector<btFemBodyRecord*> m_overlapping;
    bullet_fem::ContactSettings m_settings;
    bullet_fem::RigidSearch m_rigidSearch;
    bullet_fem::RigidContactFinder m_rigidContactFinder;
    bullet_fem::TorsionalPatches m_torsionalPatches;
    bullet_fem::SoftPairSearch m_softPairs;
    bullet_fem::ClothContacts m_cloth;
    std::vector<std::size_t>
        m_firstRigid;  // per body, index in the problem, and the end; contacts of soft pairs and of cloth follow
    std::vector<std::size_t> m_firstSoft;     // per body, start in m_softContacts, and the end
    std::vector<std::size_t> m_softContacts;  // indices in the problem, body by body
    bullet_fem::SoftJoints m_joints;
    std::vector<bullet_fem::FemSoftBody*> m_bodies, m_outside;
    bool m_reachesOut = false;  // joined to active soft bodies outside of the group
    std::vector<bullet_fem::JointFlags> m_jointFlags;
    btFemWeldBreaker m_welds;
    bullet_fem::RigidProxies m_rigid;
    bullet_fem::SolverBodies m_solverBodies;
    bullet_fem::BulletRows m_bulletRows;
    bullet_fem::MultiBodyRows m_multiBodyRows;
    std::vector<const btCollisionObject*> m_met;  // scratch: rigid objects in contact or held
    bullet_fem::Rebounds m_rebounds;
    bullet_fem::ContactProblem m_problem;
    bullet_fem::ContactSolver m_solver;
    btFemTogether m_together;
    std::vector<unsigned char> m_touches;       // per body: it has contacts
    std::vector<unsigned char> m_touchesBegin;  // per body: it has a contact with an object that it had none with
                                                // before
    double m_milliseconds = 0;                  // time spent on the group so far
};
