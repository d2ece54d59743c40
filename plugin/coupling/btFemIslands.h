// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

class btCollisionObject;
class btFemSoftBodySolver;
class btMultiBodyConstraint;
class btPersistentManifold;
class btTypedConstraint;

/// What Bullet's worlds hand to their rigid solver: the islands of a batch, without the seams between them.
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
    btCollisionObject** m_softBodies = nullptr;  ///< of the deformable world
    int m_softBodyCount = 0;
};

/// Sorts a batch into the islands with soft bodies, which are solved together with these, and those without, which are
/// solved as if they were alone. Scratch only.
class btFemIslands
{
public:
    /// `fem` must outlive it.
    explicit btFemIslands(btFemSoftBodySolver& fem) : m_fem(fem) {}

    /// Picks the islands with soft bodies, or those without. What joins two objects is in the island of the movable
    /// one. Worlds of multibodies leave soft bodies out of the batch: FEM bodies of its islands are found all the same.
    void select(const btFemBatch& all, bool withFem);

    /// What was picked.
    btFemBatch selected();

    /// Its bodies, with the FEM bodies that the batch left out.
    const std::vector<btCollisionObject*>& withSoftBodies() const { return m_together; }

private:
    void tagIslands(const btFemBatch& all);
    void tagJoined(const btFemBatch& all, const btCollisionObject* joined);
    void listLeftOut(const btFemBatch& all);
    template <class Visit>
    void forEachSoft(const btFemBatch& all, const Visit& visit) const;
    bool isTagged(int tag) const;

    btFemSoftBodySolver& m_fem;
    std::vector<int> m_tags;                    // islands with soft bodies, and those that these are joined to
    std::vector<btCollisionObject*> m_leftOut;  // FEM bodies of the batch's islands
    std::vector<btCollisionObject*> m_bodies, m_softBodies, m_together;
    std::vector<btPersistentManifold*> m_manifolds;
    std::vector<btTypedConstraint*> m_constraints;
    std::vector<btMultiBodyConstraint*> m_multiBodyConstraints;
};
