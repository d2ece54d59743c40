// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>

#include "BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h"
#include "plugin/dispatch/btFemManifolds.h"

struct btFemPair;

/// Bullet's collision algorithm for a FEM body and another object of any shape: passes the pair to the soft body
/// solver, and owns the manifold of their contact. Bullet creates and deletes it with the pair.
class btFemPairAlgorithm : public btCollisionAlgorithm
{
public:
    struct Objects
    {
        const btCollisionObject *m_first, *m_second;
    };

    btFemPairAlgorithm(const btCollisionAlgorithmConstructionInfo& info, const Objects& objects,
                       std::shared_ptr<btFemManifolds> manifolds);
    ~btFemPairAlgorithm() override;

    /// Fills the manifold with the deepest points of the last step, or releases it without contact; unchanged while the
    /// FEM body sleeps or another world is stepped.
    void update();

    /// The manifold, made if there is none, for contacts that a saved state has; null if Bullet's pool is full.
    btPersistentManifold* begin();

    void processCollision(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b, const btDispatcherInfo&,
                          btManifoldResult*) override;
    btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                   btManifoldResult*) override
    {
        return 1;
    }
    void getAllContactManifolds(btManifoldArray& manifolds) override;

private:
    void show(const btFemPair& pair);
    void release();

    Objects m_objects;
    std::shared_ptr<btFemManifolds> m_manifolds;
    btPersistentManifold* m_manifold = nullptr;
};
