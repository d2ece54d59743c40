// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "LinearMath/btAlignedObjectArray.h"
#include "bullet_fem/fem/step/stress.h"

class btCollisionObject;
class btFemBodyRegistry;
class btFemContactGroup;
class btFemManifolds;
class btFemSoftBodySolver;
class btFemSplitter;
class btFemWeldBreaker;
class btSoftBody;
struct btFemBodyRecord;
struct btFemSnapshotScope;

/// Stresses of one body.
struct btFemStressScratch
{
    std::vector<bullet_fem::Stress> m_perElement, m_perNode;
};

/// What btFemConstraintSolver, btFemDeformableBodySolver, Bullet's dispatcher and those parts of btFemSoftBodySolver's
/// interface that stand in other files may do with it, and nobody else.
struct btFemCoupling
{
    /// See btFemWorldStep::beginGroup.
    static btFemContactGroup* beginGroup(btFemSoftBodySolver& fem, btCollisionObject* const* bodies, int count,
                                         double step, bool linksToo);
    /// The bodies among which cloth is that FEM bodies touch, in place of those of optimize(); must live as long.
    static void setClothBodies(btFemSoftBodySolver& fem, const btAlignedObjectArray<btSoftBody*>& bodies);
    /// All that is known of a body; null if nothing is.
    static const btFemBodyRecord* record(const btFemSoftBodySolver& fem, const btSoftBody& body);
    /// The record that the body's own solver has of it; null if that is not a btFemSoftBodySolver, or knows nothing.
    static const btFemBodyRecord* recordOf(const btSoftBody& body);
    /// Manifolds of a body's own solver; null if that is not a btFemSoftBodySolver, or shows none.
    static std::shared_ptr<btFemManifolds> manifoldsOf(const btSoftBody& body);
    /// Of a body that is FEM; throws std::invalid_argument, in the name of `caller`, if it is not.
    static btFemBodyRecord& femRecord(btFemSoftBodySolver& fem, const btSoftBody* body, const char* caller);
    static btFemWeldBreaker& welds(const btFemSoftBodySolver& fem);
    static btFemSplitter& splitter(const btFemSoftBodySolver& fem);
    static btFemBodyRegistry& registry(const btFemSoftBodySolver& fem);
    /// Shows in this step's report of a body that `fem` does not move why it is not FEM.
    static void reportRejection(btFemSoftBodySolver& fem, btSoftBody& body, const std::string& why);
    /// See ArticulatedBodies::assumeForcesGiven.
    static void assumeForcesGiven(btFemSoftBodySolver& fem, const bullet_fem::Vec3& gravity);
    /// Null unless btFemSolverInfo::m_manifolds is set.
    static std::shared_ptr<btFemManifolds> manifolds(const btFemSoftBodySolver& fem);
    static btFemSnapshotScope snapshotScope(const btFemSoftBodySolver& fem);
    /// What stresses are computed in; kept, so that it grows once.
    static btFemStressScratch& stressScratch(const btFemSoftBodySolver& fem);
};
