// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <vector>

#include "BulletDynamics/ConstraintSolver/btContactSolverInfo.h"
#include "plugin/coupling/btFemBulletRows.h"
#include "plugin/coupling/btFemIslands.h"
#include "plugin/record/btFemCoupling.h"
#include "plugin/stages/btFemContactGroup.h"

/// Settings of Bullet's rigid solver for islands with FEM bodies: full warm start, of friction as well. Soft bodies
/// spread impulses over many rows, which would not converge from zero within a step. Rows of multibodies start from
/// zero, because MultiBodyRows knows the last impulses.
inline btContactSolverInfo settingsWithFem(const btContactSolverInfo& info)
{
    btContactSolverInfo settings = info;
    settings.m_warmstartingFactor = 1;
    settings.m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS | SOLVER_ENABLE_FRICTION_DIRECTION_CACHING |
                             SOLVER_DISABLE_VELOCITY_DEPENDENT_FRICTION_DIRECTION;
    settings.m_solverMode &= ~(SOLVER_USE_ARTICULATED_WARMSTARTING | SOLVER_DISABLE_IMPLICIT_CONE_FRICTION);
    return settings;
}

/// Solves islands with FEM bodies for the three constraint solvers, which are its friends: Bullet's rows and those of
/// soft contacts and joints in outer iterations.
class btFemIslandSolver
{
public:
    /// `fem` must outlive it.
    explicit btFemIslandSolver(btFemSoftBodySolver& fem) : m_fem(fem), m_islands(fem) {}

    /// True while islands with FEM bodies are solved.
    bool hasFem() const { return m_group != nullptr; }

    /// Solves a batch of islands of Bullet's world. Without FEM bodies solve(batch, settings), Bullet's solver, gets
    /// all of it. Otherwise it gets the islands without FEM bodies (Bullet joins small islands in one batch), then the
    /// others, while hasFem() is true. `linksToo`: Bullet's rows include those of multibodies.
    template <class Solve>
    void solveBatch(const btFemBatch& all, const btContactSolverInfo& info, bool linksToo, const Solve& solve)
    {
        m_islands.select(all, true);
        const std::vector<btCollisionObject*>& together = m_islands.withSoftBodies();
        const btFemIsland island = {together.data(), static_cast<int>(together.size()), all.m_constraints,
                                    all.m_constraintCount};
        btFemContactGroup* begun = btFemCoupling::beginGroup(m_fem, island, info.m_timeStep, linksToo);
        if (!begun) return solve(all, info);
        for (const bool withFem : {false, true})
        {
            m_islands.select(all, withFem);
            const btFemBatch batch = m_islands.selected();
            if (batch.m_bodyCount + batch.m_softBodyCount == 0) continue;
            m_group = withFem ? begun : nullptr;
            solve(batch, withFem ? settingsWithFem(info) : info);
        }
        begun->moveRigid();
        m_group = nullptr;
    }

    /// Removes what is not finite from Bullet's position correction of contacts. Call before its split impulses.
    template <class Solver>
    static void clearBadPushes(Solver& solver)
    {
        btConstraintArray& contacts = solver.m_tmpSolverContactConstraintPool;
        for (int k = 0; k < contacts.size(); ++k)
            if (!std::isfinite(contacts[k].m_rhsPenetration)) contacts[k].m_rhsPenetration = 0;
    }

    /// Solves Bullet's rows of `solver` and the soft rows as one problem. Call while hasFem().
    template <class Solver>
    void solveTogether(Solver& solver)
    {
        const bullet_fem::BulletConstraints rigid = rigidRowsOf(solver);
        if constexpr (std::is_base_of_v<btMultiBodyConstraintSolver, Solver>)
        {
            const bullet_fem::MultiBodyConstraints links = {solver.m_data,
                                                            solver.m_multiBodyNonContactConstraints,
                                                            solver.m_multiBodyNormalContactConstraints,
                                                            solver.m_multiBodyFrictionContactConstraints,
                                                            solver.m_multiBodyTorsionalFrictionContactConstraints,
                                                            solver.m_multiBodySpinningFrictionContactConstraints};
            m_group->solveWith(rigid, &links);
        }
        else
            m_group->solveWith(rigid);
    }

    /// Solves them in turn, with Bullet's own soft bodies: in outer iterations sweeps over Bullet's rows and the soft
    /// rows, then the true response of the soft bodies. sweep(iteration) sweeps Bullet's rows once and returns the
    /// square of the largest change of a row's velocity [m2/s2]. Call while hasFem().
    template <class Solver, class Sweep>
    void solveInTurn(Solver& solver, const btContactSolverInfo& info, const Sweep& sweep)
    {
        const btFemBulletRows rows = rowsOf(solver);
        const int sweeps = std::max(m_group->settings().m_sweeps, info.m_numIterations);
        const int last = std::max(0, info.m_numIterations - 1);  // Bullet does not solve contacts in later iterations
        m_group->begin(rows.m_constraints.m_bodies, rows.m_linkData.m_deltaVelocities);
        rows.note(m_noted);
        do
        {
            for (int k = 0; k < sweeps; ++k)
            {
                const btScalar residual = sweep(std::min(k, last));
                const bool rigidMoves = residual > info.m_leastSquaresResidualThreshold;
                const bool moves = m_group->sweep(rigidMoves ? std::sqrt(residual) : 0);
                if (k >= last && !moves) break;
            }
            m_group->correct();
            if (m_group->isBest()) rows.note(m_noted);
        } while (m_group->needsOuterIteration());
        if (m_group->shouldRollBack())
        {
            rows.restoreBest(m_noted);
            m_group->restoreBest();
        }
        m_group->finish();
    }

private:
    template <class Solver>
    static bullet_fem::BulletConstraints rigidRowsOf(Solver& solver)
    {
        return {solver.m_tmpSolverBodyPool, solver.m_tmpSolverNonContactConstraintPool,
                solver.m_tmpSolverContactConstraintPool, solver.m_tmpSolverContactFrictionConstraintPool,
                solver.m_tmpSolverContactRollingFrictionConstraintPool};
    }

    template <class Solver>
    static btFemBulletRows rowsOf(Solver& solver)
    {
        return {rigidRowsOf(solver),
                solver.m_data,
                {&solver.m_multiBodyNonContactConstraints, &solver.m_multiBodyNormalContactConstraints,
                 &solver.m_multiBodyFrictionContactConstraints, &solver.m_multiBodyTorsionalFrictionContactConstraints,
                 &solver.m_multiBodySpinningFrictionContactConstraints}};
    }

    btFemSoftBodySolver& m_fem;
    btFemIslands m_islands;
    btFemContactGroup* m_group = nullptr;  // FEM bodies of the islands being solved; null if there are none
    std::vector<btScalar> m_noted;         // impulses of Bullet's rows in the best outer iteration [N s]
};
