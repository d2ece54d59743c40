// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>
#include <cmath>

#include "BulletDynamics/ConstraintSolver/btContactSolverInfo.h"
#include "plugin/coupling/btFemIslands.h"
#include "plugin/record/btFemCoupling.h"
#include "plugin/stages/btFemContactGroup.h"

/// Settings of Bullet's rigid solver for islands with FEM bodies. What rests starts from the last step's impulses,
/// friction included: soft bodies carry far, and the rigid rows must not begin anew every time.
inline btContactSolverInfo settingsWithFem(const btContactSolverInfo& info)
{
    btContactSolverInfo settings = info;
    settings.m_warmstartingFactor = 1;
    settings.m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS | SOLVER_ENABLE_FRICTION_DIRECTION_CACHING |
                             SOLVER_DISABLE_VELOCITY_DEPENDENT_FRICTION_DIRECTION;
    return settings;
}

/// Solves a batch as the world hands it over: by solve(batch, settings), Bullet's own, at once where it has no FEM
/// bodies. Else its islands without them as if they were alone, for Bullet hands small ones over together, and then
/// those with them, while `group` has their contacts. `linksToo`: Bullet's rows include those of multibodies.
template <class Solve>
void solveBatch(btFemSoftBodySolver& fem, btFemIslands& islands, const btFemBatch& all, const btContactSolverInfo& info,
                bool linksToo, btFemContactGroup*& group, const Solve& solve)
{
    islands.select(all, true);
    const std::vector<btCollisionObject*>& together = islands.withSoftBodies();
    btFemContactGroup* begun =
        btFemCoupling::beginGroup(fem, together.data(), static_cast<int>(together.size()), info.m_timeStep, linksToo);
    if (!begun) return solve(all, info);
    for (const bool withFem : {false, true})
    {
        islands.select(all, withFem);
        if (islands.selected().m_bodyCount + islands.selected().m_softBodyCount == 0) continue;
        group = withFem ? begun : nullptr;
        solve(islands.selected(), withFem ? settingsWithFem(info) : info);
    }
    begun->moveRigid();
    group = nullptr;
}

/// Bullet's rows, as three functions.
template <class Sweep, class Note, class RestoreBest>
struct btFemRigidRows
{
    const Sweep& sweep;
    const Note& note;
    const RestoreBest& restoreBest;
};

/// Rounds of sweeps over all rows, the rigid ones first, then the soft ones; after every round the soft bodies' true
/// response. The group has begun. `rows` are Bullet's:
///     sweep(iteration)   sweeps them once; the square of the largest change of a row's velocity
///     note(), restoreBest()   notes their impulses, and returns to those noted last
template <class Rows>
void solveTogether(btFemContactGroup& group, const btContactSolverInfo& info, Rows rows)
{
    const int sweeps = std::max(group.settings().m_sweeps, info.m_numIterations);
    const int last = std::max(0, info.m_numIterations - 1);  // Bullet does not solve contacts in later iterations
    rows.note();
    do
    {
        for (int sweep = 0; sweep < sweeps; ++sweep)
        {
            const btScalar residual = rows.sweep(std::min(sweep, last));
            const bool rigidMoves = residual > info.m_leastSquaresResidualThreshold;
            const bool moves = group.sweep(rigidMoves ? std::sqrt(residual) : 0);
            if (sweep >= last && !moves) break;
        }
        group.correct();
        if (group.isBest()) rows.note();
    } while (group.needsOuterIteration());
    if (group.shouldRollBack())
    {
        rows.restoreBest();
        group.restoreBest();
    }
    group.finish();
}
