// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>

#include "LinearMath/btScalar.h"
#include "bullet_fem/fem/common/export.h"

/// Who gives a body a new factor when its step, masses or pins are not the factor's any more (BT_FEM_STALE_FACTOR). A
/// new one pays as soon as the stale one has cost as many iterations of the free motion as it takes time; both are
/// counted from the sizes of mesh and factor, never by a clock.
enum class btFemRefactoring
{
    onRequest,    ///< refactor(); the step report says when it pays (BT_FEM_REFACTOR_PAYS)
    synchronous,  ///< also the step after that report, which takes longer then; the same on every machine
    /// Likewise, but it is made by a thread of its own and taken over at the beginning of the first step that finds it
    /// ready. **Not deterministic:** results depend, within the tolerance, on when that is. Orders with METIS, which
    /// seeds and draws from std::rand, while the program runs; a body that is set up meanwhile waits for its turn. The
    /// destructor waits for the factor that is being made.
    background
};

/// Which factor preconditions a body's steps.
enum class btFemFactorChoice
{
    full,             ///< that of its own matrix: one or two iterations a step
    lowMemoryBeyond,  ///< that, or the one below where it would be larger than m_maxFactorMegabytes
    lowMemory         ///< a scalar Laplacian's, about a ninth of the memory and far sooner made; some ten iterations a
               ///< step or more. Nodes that first touch something take ten to twenty times as long: .1 s for 64 of a
               ///< body of 10,000 elements, .9 s at 50,000
};

/// Settings of a solver; fixed for its life.
struct BULLETFEM_API btFemSolverInfo
{
    btScalar m_tolerance = btScalar(1e-3);  ///< relative residual of the linear solves [-], in [1e-8, 0.5]
    /// Damping by the step itself [-], in [0, 1]: 0 is a step of second order, which damps what it cannot resolve and
    /// nothing else; 1 is implicit Euler. In between, vibrations of frequency f lose half of their amplitude in some
    /// 1 / (28 m_numericalDamping f^2 h). At 0 what is to come to rest in the air needs damping of its own.
    btScalar m_numericalDamping = 0;
    /// The same, at least, in the steps of bodies that touch something or did so in the step before, or that anchors,
    /// joints or springs hold [-], in [0, 1]. At 1 bodies rest and roll as by implicit Euler, at its cost; at 0
    /// undamped ones return from impacts with two to four times the speed, and steps in contact take up to three times
    /// as long. What penetrates (BT_FEM_PENETRATING) or matches a pose (kMT) goes by 1 in any case. Factors are made
    /// for the larger of both dampings: where they differ, free motion takes up to 1.6 times as long, and the automatic
    /// detail (setInterest) seldom leaves the full solution.
    btScalar m_contactDamping = 1;
    int m_maxIterations = 100;  ///< conjugate gradient iterations a solve, in [1, 10000]
    int m_contactRounds = 1;    ///< corrective solves after contact at least, in [1, 10]; ten at most
    int m_contactSweeps = 50;   ///< sweeps a round at most, in [1, 1000]
    /// Errors of velocity at which contact ends, as a share of what gravity gives a body in a step, or of what contact
    /// changes at first if that is more [-], in [1e-7, 0.1]. What is at rest is solved to a hundredth of it within a
    /// few steps, impacts to 5e-4 of an element's edge a step, what has restitution to 3e-5, joints to 1e-3 of the
    /// impulses on their bodies; beside rows of Bullet in btFemConstraintSolver all is solved to 1e-4.
    btScalar m_contactTolerance = btScalar(3e-3);
    int m_maxContacts = 2000;                  ///< contact points a body, in [8, 20000]
    btScalar m_erp = btScalar(0.2);            ///< share of a penetration taken back a step [-], in [0, 1]
    btScalar m_maxPushVelocity = btScalar(1);  ///< speed at which penetration is taken back at most [m/s], in [0, 1000]
    /// Memory that the factor of a body may take [MB, 1e6 bytes], in [0, 1e6]; 0 is no limit. A body that needs more is
    /// rejected with the amount in its report's message, before the work is done, unless m_factorChoice says otherwise.
    /// 1,000 elements take about 0.7 MB in a body of 10,000 and 1.3 MB in one of 100,000.
    btScalar m_maxFactorMegabytes = 0;
    /// Which factor bodies get: the full one, the low-memory one where the full one would be larger than the limit, or
    /// always the low-memory one. Both are iterated to m_tolerance. A body whose low-memory factor is larger than the
    /// limit is rejected as well.
    btFemFactorChoice m_factorChoice = btFemFactorChoice::full;
    /// Threads that share the bodies of a step, and the work on a body of some thousand tetrahedra; the stepping one is
    /// among them [-], in [0, 256]; 0: as many as the machine has. The bits of the result are the same for all.
    int m_threads = 1;
    /// Whether bodies that share their factor, copies of each other, are solved side by side, in some 3 KB an
    /// element and thread. The bits of the result are the same; off to save memory, or to compare times.
    bool m_batchBodies = true;
    /// Who renews stale factors. Bodies that touch something or are held get a new one in any case if the old one
    /// is 1.5 times off.
    btFemRefactoring m_refactoring = btFemRefactoring::onRequest;
    /// Whether Bullet's dispatcher shows a btPersistentManifold of every FEM body and other object that touch: the four
    /// deepest points of the last step with their impulses. The rigid object is the first, the soft body the second;
    /// Bullet's rigid solver leaves the manifolds alone, but an active kinematic object keeps awake what touches it, as
    /// it does with rigid bodies. Self contact has none. Bullet's contact callbacks are called; what they change has no
    /// effect. The body's m_worldInfo must have the world's dispatcher, also for contactTest and contactPairTest, which
    /// tell the last step's contact points of FEM bodies in any case.
    bool m_manifolds = false;

    /// True if every value is in its range; else `why` (if given) names the value, the range and the remedy.
    bool valid(std::string* why = nullptr) const;
};
