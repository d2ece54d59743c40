// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>

#include "LinearMath/btScalar.h"
#include "bullet_fem/fem/common/export.h"

/// When a body gets a new factor after its step, masses or pins have changed (BT_FEM_STALE_FACTOR). A new factor pays
/// as soon as the stale one has cost as many iterations of the free motion as factoring costs; both costs are computed
/// from the sizes of mesh and factor, never measured by a clock.
enum class btFemRefactoring
{
    onRequest,    ///< only by refactor(); the step report tells when it pays (BT_FEM_REFACTOR_PAYS)
    synchronous,  ///< also in the step after that report, which takes longer; deterministic
    /// Also after that report, but computed by a separate thread and used from the first step that finds it complete.
    /// **Not deterministic:** results depend, within the tolerance, on when that is. Orderings with METIS, which seeds
    /// and draws from std::rand, run concurrently with the program; a body that is set up meanwhile waits for its turn.
    /// The destructor waits for a factorization in progress.
    background
};

/// Factor that preconditions a body's steps.
enum class btFemFactorChoice
{
    full,             ///< factor of the body's own matrix: one or two iterations per step
    lowMemoryBeyond,  ///< full, or lowMemory where the full factor would exceed m_maxFactorMegabytes
    /// Factor of a scalar Laplacian: about a ninth of the memory, factored far faster; some ten iterations per step or
    /// more. The first contact of a node takes ten to twenty times as long: .1 s for 64 nodes of a body of 10,000
    /// elements, .9 s at 50,000.
    lowMemory
};

/// Settings of a solver, constant for its lifetime.
struct BULLETFEM_API btFemSolverInfo
{
    btScalar m_tolerance = btScalar(1e-3);  ///< relative residual of the linear solves [-], in [1e-8, 0.5]
    /// Numerical damping of the step [-], in [0, 1]: 0 is a second-order step that damps only frequencies that it
    /// cannot resolve; 1 is implicit Euler (docs/theory.md). In between, vibrations of frequency f lose half of their
    /// amplitude in some 1 / (28 m_numericalDamping f^2 h). At 0 a body that should come to rest in the air needs
    /// material damping.
    btScalar m_numericalDamping = 0;
    /// Lower bound of the numerical damping for bodies that are in contact, were so in the step before, or are held by
    /// anchors, joints or springs [-], in [0, 1]. At 1 bodies rest and roll as with implicit Euler, at its cost; at 0
    /// undamped ones rebound with two to four times the speed, and steps in contact take up to three times as long.
    /// Bodies that penetrate (BT_FEM_PENETRATING) or match a pose (kMT) always use 1, with joints at least .05. Factors
    /// are made for the larger of both dampings: if they differ, free motion takes up to 1.6 times as long, and
    /// automatic detail (setInterest) seldom leaves the full solution.
    btScalar m_contactDamping = 1;
    /// Whether bodies that meet at more than 0.2 m/s rebound by their elasticity, as they do in small steps, although
    /// the step damps their impact. A coefficient of restitution that is set replaces it. Not for bodies on the
    /// low-memory path, with pins or joints, nor for rigid bodies on Bullet's constraints.
    bool m_elasticRebound = true;
    int m_maxIterations = 100;  ///< maximum number of conjugate gradient iterations per solve, in [1, 10000]
    /// Minimum number of outer contact iterations, each with a corrective solve, in [1, 10]; the maximum is ten.
    int m_contactRounds = 1;
    int m_contactSweeps = 50;  ///< maximum number of sweeps per outer iteration, in [1, 1000]
    /// Velocity error at which outer contact iterations end, relative to the velocity that gravity gives a body in a
    /// step, or to the initial velocity change by contact if that is larger [-], in [1e-7, 0.1]. Resting contacts
    /// converge to a hundredth of it within a few steps. Stricter tolerances hold for impacts (5e-4 of an element's
    /// edge per step), contacts with restitution (3e-5), joints (1e-3 of the impulses on their bodies), and groups with
    /// multibodies in Bullet's rigid solver (1e-4).
    btScalar m_contactTolerance = btScalar(3e-3);
    int m_maxContacts = 2000;                  ///< maximum number of contact points per body, in [8, 20000]
    btScalar m_erp = btScalar(0.2);            ///< share of a penetration corrected per step [-], in [0, 1]
    btScalar m_maxPushVelocity = btScalar(1);  ///< maximum speed of penetration correction [m/s], in [0, 1000]
    /// Maximum memory of a body's factor [MB, 1e6 bytes], in [0, 1e6]; 0: unlimited. A body that needs more is rejected
    /// before factorization, with the amount in its report's message, unless m_factorChoice allows another factor.
    /// 1,000 elements take about 0.7 MB in a body of 10,000 and 1.3 MB in one of 100,000.
    btScalar m_maxFactorMegabytes = 0;
    /// Factor of the bodies: always the full one, the low-memory one where the full one would exceed the limit, or
    /// always the low-memory one. Both are iterated to m_tolerance. A body whose low-memory factor exceeds the limit is
    /// rejected as well.
    btFemFactorChoice m_factorChoice = btFemFactorChoice::full;
    /// Number of threads that share the bodies of a step, and the work on a body of some thousand tetrahedra, including
    /// the stepping thread, in [0, 256]; 0: as many as the machine has. Results are bitwise equal for all numbers.
    int m_threads = 1;
    /// Whether bodies that share a factor (copies of each other) are solved side by side, which takes some 3 KB per
    /// element and thread. Does not change the bits of the result; turn it off to save memory or to compare times.
    bool m_batchBodies = true;
    /// When stale factors are replaced. A body in contact or held always gets a new factor if its step or masses differ
    /// from the factor's by a factor of 1.5, or after a few steps with other pins or targets.
    btFemRefactoring m_refactoring = btFemRefactoring::onRequest;
    /// Whether Bullet's dispatcher has a btPersistentManifold for every pair of a FEM body and another object in
    /// contact: the four deepest points of the last step with their impulses. The rigid object is the first, the soft
    /// body the second. Bullet's rigid solver ignores these manifolds, but an active kinematic object keeps bodies in
    /// contact with it awake, as it does with rigid bodies. Self contact has none. Bullet's contact callbacks are
    /// called; their changes have no effect. The body's m_worldInfo must have the world's dispatcher, also for
    /// contactTest and contactPairTest, which report the last step's contact points of FEM bodies in any case.
    bool m_manifolds = false;

    /// True if every value is in its range; else `why` (if given) names the value, the range and the remedy.
    bool valid(std::string* why = nullptr) const;
};
