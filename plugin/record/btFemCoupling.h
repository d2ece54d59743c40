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
class btTypedConstraint;
struct btFemBodyRecord;
struct btFemSnapshotScope;

/// Stresses of one body.
struct btFemStressScratch
{
    std::vector<bullet_fem::Stress> m_perElement, m_perNode;
};

/// Objects and constraints that Bullet solves together.
struct btFemIsland
{
    btCollisionObject* const* m_objects = nullptr;
    int m_objectCount = 0;
    btTypedConstraint* const* m_constraints = nullptr;
    int m_constraintCount = 0;
};

/// The internal interface of btFemSoftBodySolver for btFemConstraintSolver, btFemDeformableBodySolver, Bullet's
/// dispatcher and public functions in other files.
struct btFemCoupling
{
    /// See btFemWorldStep::beginGroup.
    static btFemContactGroup* beginGroup(btFemSoftBodySolver& fem, const btFemIsland& island, double step,
                                         bool linksToo);
    /// Sets the bodies among which cloth in contact with FEM bodies is searched, instead of those of optimize(); they
    /// must outlive the solver's use.
    static void setClothBodies(btFemSoftBodySolver& fem, const btAlignedObjectArray<btSoftBody*>& bodies);
    /// The record of a body; null if it is unknown.
    static const btFemBodyRecord* record(const btFemSoftBodySolver& fem, const btSoftBody& body);
    /// The record of a body in its own solver; null if that is no btFemSoftBodySolver, or the body is unknown.
    static const btFemBodyRecord* recordOf(const btSoftBody& body);
    /// Manifolds of a body's own solver; null if that is no btFemSoftBodySolver, or shows none.
    static std::shared_ptr<btFemManifolds> manifoldsOf(const btSoftBody& body);
    /// The record of a FEM body; throws std::invalid_argument, with `caller` in the message, if it is not FEM.
    static btFemBodyRecord& femRecord(btFemSoftBodySolver& fem, const btSoftBody* body, const char* caller);
    static btFemWeldBreaker& welds(const btFemSoftBodySolver& fem);
    static btFemSplitter& splitter(const btFemSoftBodySolver& fem);
    static btFemBodyRegistry& registry(const btFemSoftBodySolver& fem);
    /// Reports why a body, not moved by `fem`, is not FEM.
    static void reportRejection(btFemSoftBodySolver& fem, btSoftBody& body, const std::string& why);
    /// See ArticulatedBodies::assumeForcesGiven.
    static void assumeForcesGiven(btFemSoftBodySolver& fem, const bullet_fem::Vec3& gravity);
    /// Null unless btFemSolverInfo::m_manifolds is set.
    static std::shared_ptr<btFemManifolds> manifolds(const btFemSoftBodySolver& fem);
    static btFemSnapshotScope snapshotScope(const btFemSoftBodySolver& fem);
    /// Scratch for stresses, kept to avoid allocation.
    static btFemStressScratch& stressScratch(const btFemSoftBodySolver& fem);
};
