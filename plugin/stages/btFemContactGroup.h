// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/contact/cloth/cloth_contacts.h"
#include "bullet_bridge/contact/rigid/rigid_search.h"
#include "bullet_bridge/contact/rigid/torsional_patches.h"
#include "bullet_bridge/contact/soft/soft_pair_search.h"
#include "bullet_bridge/joints/soft_joints.h"
#include "bullet_bridge/rigid/rebounds.h"
#include "bullet_bridge/rigid/rigid_touches.h"
#include "bullet_bridge/rigid/solver_bodies.h"
#include "bullet_fem/btFemSolverInfo.h"
#include "plugin/joints/btFemWeldBreaker.h"
#include "plugin/record/btFemBodyRecord.h"
#include "plugin/record/btFemTouches.h"

/// FEM bodies that are solved together: what they touch, what holds them, and their reports. Scratch only.
class btFemContactGroup
{
public:
    /// `threads` share the searches and the corrective solves, these in `memory`, if given; both must live as long as
    /// the group.
    btFemContactGroup(const btFemSolverInfo& info, const bullet_fem::Threads& threads, bullet_fem::BatchMemory* memory)
        : m_info(info), m_rigidSearch(threads), m_softPairs(threads)
    {
        m_settings.m_step.m_threads = &threads;
        m_settings.m_step.m_batchMemory = memory;
    }

    /// What is solved together, when, and all bodies that are known.
    struct Scope
    {
        const std::vector<btFemBodyRecord*>& m_records;
        const btFemRecords& m_all;
        double m_step;  ///< of the world [s]
        bullet_fem::RigidPhase m_phase;
    };

    /// At the start of a step of the world [s].
    void beginStep(double step);

    /// Remembers a rigid body as it is before Bullet's rigid solver. May be called by several threads at once.
    void noteBeforeSolve(const btCollisionObject& object) { m_rigid.noteBeforeSolve(object); }

    /// See ArticulatedBodies::assumeForcesGiven.
    void assumeForcesGiven(const bullet_fem::Vec3& gravity) { m_rigid.assumeForcesGiven(gravity); }

    /// Finds contacts and joints of bodies that have had their free motion.
    void collect(const Scope& scope);

    /// True if there is nothing to solve.
    bool isEmpty() const { return m_problem.m_contacts.empty() && m_problem.m_joints.empty(); }

    /// The bodies that contacts were found of.
    const std::vector<btFemBodyRecord*>& touching() const { return m_touching; }

    /// True if every rigid body that the group can move is one of `bodies`, likewise every multibody's link, of which
    /// there are none unless `linksToo`, and no joint joins it to other soft bodies that are awake.
    bool holdsOnly(btCollisionObject* const* bodies, int count, bool linksToo) const;

    /// After Bullet's rigid solver: solves and hands the reactions to the rigid bodies.
    void solve();

    /// Within Bullet's rigid solver, on its solver bodies: begin, then while wantsRound sweep ... sweep, correct, then
    /// if wantsBack goBack, and at the end finish; after the rigid solver has written its bodies back, moveRigid.
    /// `linkDeltas`: see ArticulatedBodies::beginSolve; null for a solver without multibodies.
    void begin(btAlignedObjectArray<btSolverBody>& pool, btAlignedObjectArray<btScalar>* linkDeltas = nullptr);
    bool sweep(double others);
    bool wantsRound() const { return m_solver.wantsRound(); }
    void correct();
    bool isBest() const { return m_solver.isBest(); }
    bool wantsBack() const { return m_solver.wantsBack(); }
    void goBack();
    void finish();
    void moveRigid();

    /// As the step ends: what impacts have to give back. `records` are all whose contact was solved in this step.
    void giveRebounds(const std::vector<btFemBodyRecord*>& records, bullet_fem::WorldObjects& world, double step);

    const bullet_fem::ContactSettings& settings() const { return m_settings; }

    /// What lasts from step to step.
    bullet_fem::RigidProxies& rigid() { return m_rigid; }
    const bullet_fem::RigidProxies& rigid() const { return m_rigid; }
    /// Pairs with cloth are noted there.
    bullet_fem::ClothContacts& cloth() { return m_cloth; }

    btFemWeldBreaker& welds() { return m_welds; }

    bullet_fem::SoftPairMemory& softPairs() { return m_softPairs.memory(); }
    const bullet_fem::SoftPairMemory& softPairs() const { return m_softPairs.memory(); }

private:
    /// Beside Bullet's rows, which answer to what is left, at most [-]. At 3e-3 heavy soft bodies on light rigid ones
    /// shook by 3 cm.
    static constexpr double kToleranceWithRows = 1e-4;

    void clearProblem();
    void findRigid();
    void findSoft();
    void findCloth();
    void collectContacts();
    void listTouching();
    void alignLinks(std::vector<bullet_fem::ContactPoint>& contacts) const;
    void collectJoints(const Scope& scope);
    template <class Part>
    void onSolverBodies(const Part& part);
    void report(const bullet_fem::ContactReport& report);
    void makeRoomForReports();
    void reportCloth(std::size_t b);
    void reportBody(std::size_t b, const bullet_fem::ContactReport& report);

    btFemSolverInfo m_info;
    double m_step = 0;  // [s]
    std::vector<btFemBodyRecord*> m_records;
    std::vector<btFemBodyRecord*> m_touching;
    bullet_fem::ContactSettings m_settings;
    bullet_fem::RigidSearch m_rigidSearch;
    bullet_fem::RigidTouchFinder m_touchFinder;
    bullet_fem::TorsionalPatches m_torsionalPatches;
    bullet_fem::SoftPairSearch m_softPairs;
    bullet_fem::ClothContacts m_cloth;
    std::vector<std::size_t>
        m_firstRigid;  // per body and the end, in the problem; then come those between soft bodies, then cloth
    std::vector<std::size_t> m_firstSoft;     // per body and the end, in m_softContacts
    std::vector<std::size_t> m_softContacts;  // in the problem, body by body
    bullet_fem::SoftJoints m_joints;
    std::vector<bullet_fem::FemSoftBody*> m_bodies, m_outside;
    bool m_reachesOut = false;  // joined to soft bodies that should be in the group
    std::vector<bullet_fem::JointFlags> m_jointFlags;
    btFemWeldBreaker m_welds;
    bullet_fem::RigidProxies m_rigid;
    bullet_fem::SolverBodies m_solverBodies;
    bullet_fem::Rebounds m_rebounds;
    bullet_fem::ContactProblem m_problem;
    bullet_fem::ContactSolver m_solver;
    btFemTogether m_together;
    std::vector<unsigned char> m_touches;       // per body: it has contacts
    std::vector<unsigned char> m_touchesBegin;  // per body: it touches what it did not
    double m_milliseconds = 0;                  // spent so far on the group
};
