// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/btFemConstraintSolver.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "BulletCollision/NarrowPhaseCollision/btPersistentManifold.h"
#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/joints/soft_joints.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "plugin/record/btFemBodyRecord.h"
#include "plugin/record/btFemCoupling.h"
#include "plugin/stages/btFemContactGroup.h"

using namespace bullet_fem;

btFemConstraintSolver::btFemConstraintSolver(btFemSoftBodySolver* fem) : m_fem(fem)
{
    std::string why;
    if (!valid(fem, &why)) throw std::invalid_argument("btFemConstraintSolver: " + why);
}

bool btFemConstraintSolver::valid(const btFemSoftBodySolver* fem, std::string* why)
{
    if (!fem && why) *why = "the FEM solver is null; give the btFemSoftBodySolver of the world";
    return fem != nullptr;
}

btScalar btFemConstraintSolver::solveGroup(btCollisionObject** bodies, int numBodies, btPersistentManifold** manifolds,
                                           int numManifolds, btTypedConstraint** constraints, int numConstraints,
                                           const btContactSolverInfo& info, btIDebugDraw* debugDrawer,
                                           btDispatcher* dispatcher)
{
    const Islands all = {bodies, numBodies, manifolds, numManifolds, constraints, numConstraints};
    select(all, true);
    btFemContactGroup* group =
        btFemCoupling::beginGroup(*m_fem, m_bodies.data(), static_cast<int>(m_bodies.size()), info.m_timeStep);
    if (!group)
        return btSequentialImpulseConstraintSolver::solveGroup(bodies, numBodies, manifolds, numManifolds, constraints,
                                                               numConstraints, info, debugDrawer, dispatcher);
    // Bullet hands small islands over together; those without FEM bodies are solved as if they were alone.
    for (const bool withFem : {false, true})
    {
        select(all, withFem);
        if (m_bodies.empty()) continue;
        btContactSolverInfo settings = info;
        if (withFem)
        {
            // What rests starts from the last step's impulses, friction included: soft bodies carry far, and the rigid
            // rows must not begin anew every time.
            settings.m_warmstartingFactor = 1;
            settings.m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS | SOLVER_ENABLE_FRICTION_DIRECTION_CACHING |
                                     SOLVER_DISABLE_VELOCITY_DEPENDENT_FRICTION_DIRECTION;
            m_group = group;
        }
        btSequentialImpulseConstraintSolver::solveGroup(m_bodies.data(), static_cast<int>(m_bodies.size()),
                                                        m_manifolds.data(), static_cast<int>(m_manifolds.size()),
                                                        m_constraints.data(), static_cast<int>(m_constraints.size()),
                                                        settings, debugDrawer, dispatcher);
    }
    m_group->moveRigid();
    m_group = nullptr;
    return 0;
}

bool btFemConstraintSolver::isTagged(int tag) const
{
    return std::find(m_tags.begin(), m_tags.end(), tag) != m_tags.end();
}

// Bullet's islands know of contacts and its own constraints, not of what soft bodies are anchored and joined to.
void btFemConstraintSolver::tagIslands(const Islands& all)
{
    m_tags.clear();
    for (int k = 0; k < all.m_bodyCount; ++k)
        if (btSoftBody::upcast(all.m_bodies[k]) && !isTagged(all.m_bodies[k]->getIslandTag()))
            m_tags.push_back(all.m_bodies[k]->getIslandTag());
    for (int k = 0; k < all.m_bodyCount; ++k)
    {
        const btSoftBody* soft = btSoftBody::upcast(all.m_bodies[k]);
        const btFemBodyRecord* record = soft ? btFemCoupling::record(*m_fem, *soft) : nullptr;
        const btCollisionObject* last = nullptr;
        if (!record || !record->isFem()) continue;
        forEachRigidEnd(*record->m_model.m_fem,
                        [&](const btCollisionObject* object)
                        {
                            if (object != last) tagJoined(all, object);
                            last = object;
                        });
    }
}

// What is joined may be gone: its address is only compared.
void btFemConstraintSolver::tagJoined(const Islands& all, const btCollisionObject* joined)
{
    btCollisionObject** end = all.m_bodies + all.m_bodyCount;
    btCollisionObject** found = std::find(all.m_bodies, end, joined);
    if (found != end && !isTagged((*found)->getIslandTag())) m_tags.push_back((*found)->getIslandTag());
}

// Picks the islands with soft bodies, or those without. What joins two objects is in the island of the movable one.
void btFemConstraintSolver::select(const Islands& all, bool withFem)
{
    tagIslands(all);
    const auto isSelected = [&](const btCollisionObject& a, const btCollisionObject& b)
    {
        const int tag = a.getIslandTag() >= 0 ? a.getIslandTag() : b.getIslandTag();
        return isTagged(tag) == withFem;
    };
    m_bodies.clear();
    m_manifolds.clear();
    m_constraints.clear();
    for (int k = 0; k < all.m_bodyCount; ++k)
        if (isSelected(*all.m_bodies[k], *all.m_bodies[k])) m_bodies.push_back(all.m_bodies[k]);
    for (int k = 0; k < all.m_manifoldCount; ++k)
        if (isSelected(*all.m_manifolds[k]->getBody0(), *all.m_manifolds[k]->getBody1()))
            m_manifolds.push_back(all.m_manifolds[k]);
    for (int k = 0; k < all.m_constraintCount; ++k)
        if (isSelected(all.m_constraints[k]->getRigidBodyA(), all.m_constraints[k]->getRigidBodyB()))
            m_constraints.push_back(all.m_constraints[k]);
}

// Rounds of sweeps over all rows, the rigid ones first, then the soft ones; after every round the soft bodies' true
// response.
btScalar btFemConstraintSolver::solveGroupCacheFriendlyIterations(btCollisionObject** bodies, int numBodies,
                                                                  btPersistentManifold** manifolds, int numManifolds,
                                                                  btTypedConstraint** constraints, int numConstraints,
                                                                  const btContactSolverInfo& info,
                                                                  btIDebugDraw* debugDrawer)
{
    if (!m_group)
        return btSequentialImpulseConstraintSolver::solveGroupCacheFriendlyIterations(
            bodies, numBodies, manifolds, numManifolds, constraints, numConstraints, info, debugDrawer);

    solveGroupCacheFriendlySplitImpulseIterations(bodies, numBodies, manifolds, numManifolds, constraints,
                                                  numConstraints, info, debugDrawer);
    const ContactSettings& settings = m_group->settings();
    const int sweeps = std::max(settings.m_sweeps, info.m_numIterations);
    const int last = std::max(0, info.m_numIterations - 1);  // Bullet does not solve contacts in later iterations
    m_group->begin(m_tmpSolverBodyPool);
    noteImpulses();
    do
    {
        for (int sweep = 0; sweep < sweeps; ++sweep)
        {
            const btScalar residual =
                solveSingleIteration(std::min(sweep, last), bodies, numBodies, manifolds, numManifolds, constraints,
                                     numConstraints, info, debugDrawer);
            // The residual is the square of the largest change of a row's velocity.
            const bool rigidMoves = residual > info.m_leastSquaresResidualThreshold;
            const bool moves = m_group->sweep(rigidMoves ? std::sqrt(residual) : 0);
            if (sweep >= last && !moves) break;
        }
        m_group->correct();
        if (m_group->isBest()) noteImpulses();
    } while (m_group->wantsRound());
    if (m_group->wantsBack())
    {
        goBackToNoted();
        m_group->goBack();
    }
    m_group->finish();
    return 0;
}

template <class Visit>
void btFemConstraintSolver::forEachRigidRow(Visit visit)
{
    for (btConstraintArray* rows :
         {&m_tmpSolverNonContactConstraintPool, &m_tmpSolverContactConstraintPool,
          &m_tmpSolverContactFrictionConstraintPool, &m_tmpSolverContactRollingFrictionConstraintPool})
        for (int k = 0; k < rows->size(); ++k) visit((*rows)[k]);
}

void btFemConstraintSolver::noteImpulses()
{
    m_noted.clear();
    forEachRigidRow([this](const btSolverConstraint& row) { m_noted.push_back(row.m_appliedImpulse); });
}

// The velocities of the solver bodies follow, as in Bullet's own rows.
void btFemConstraintSolver::goBackToNoted()
{
    auto noted = m_noted.begin();
    forEachRigidRow(
        [&](btSolverConstraint& row)
        {
            const btScalar change = *noted - btScalar(row.m_appliedImpulse);
            row.m_appliedImpulse = *noted++;
            btSolverBody &a = m_tmpSolverBodyPool[row.m_solverBodyIdA], &b = m_tmpSolverBodyPool[row.m_solverBodyIdB];
            a.internalApplyImpulse(row.m_contactNormal1 * a.internalGetInvMass(), row.m_angularComponentA, change);
            b.internalApplyImpulse(row.m_contactNormal2 * b.internalGetInvMass(), row.m_angularComponentB, change);
        });
}
