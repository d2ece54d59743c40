// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

class btCollisionObject;
class btFemSoftBodySolver;
class btMultiBodyConstraint;
class btPersistentManifold;
class btTypedConstraint;

/// A batch of islands that Bullet's worlds pass to their rigid solver, concatenated.
struct btFemBatch
{
    btCollisionObject** m_bodies;
    int m_bodyCount;
    btPersistentManifold** m_manifolds;
    int m_manifoldCount;
    btTypedConstraint** m_constraints;
    int m_constraintCount;
    btMultiBodyConstraint** m_multiBodyConstraints = nullptr;
    int m_multiBodyConstraintCount = 0;
    btCollisionObject** m_softBodies = nullptr;  ///< soft bodies of a deformable world
    int m_softBodyCount = 0;
};

/// Divides a batch into islands with soft bodies, which are solved together with these, and islands without, which are
/// solved separately. Scratch only.
class btFemIslands
{
public:
    /// `fem` must outlive it.
    explicit btFemIslands(btFemSoftBodySolver& fem) : m_fem(fem) {}

    /// Selects the islands with soft bodies, or those without. A joint between two objects belongs to the island of the
    /// movable one. Multibody worlds omit soft bodies from the batch: FEM bodies of its islands are found nevertheless.
    void select(const btFemBatch& all, bool withFem);

    /// The selection.
    btFemBatch selected();

    /// The bodies of the batch, with the FEM bodies that it omits.
    const std::vector<btCollisionObject*>& withSoftBodies() const { return m_together; }

private:
    void tagIslands(const btFemBatch& all);
    void tagJoined(const btFemBatch& all, const btCollisionObject* joined);
    void listLeftOut(const btFemBatch& all);
    template <class Visit>
    void forEachSoft(const btFemBatch& all, const Visit& visit) const;
    bool isTagged(int tag) const;

    btFemSoftBodySolver& m_fem;
    std::vector<int> m_tags;                    // tags of islands with soft bodies, and of islands joined to these
    std::vector<btCollisionObject*> m_leftOut;  // FEM bodies of the batch's islands that the batch omits
    std::vector<btCollisionObject*> m_bodies, m_softBodies, m_together;
    std::vector<btPersistentManifold*> m_manifolds;
    std::vector<btTypedConstraint*> m_constraints;
    std::vector<btMultiBodyConstraint*> m_multiBodyConstraints;
};
