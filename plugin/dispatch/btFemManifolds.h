// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <mutex>
#include <vector>

class btDispatcher;
class btFemPairAlgorithm;

/// Contacts of FEM bodies as btPersistentManifolds for Bullet's loops and callbacks. The manifold of a pair belongs to
/// the pair's collision algorithm, which Bullet deletes when their bounds separate, when one of the two is removed and
/// when the world is destroyed: so a manifold never outlives its objects or its dispatcher, whether or not the solver
/// lives. Allocates when contact begins (from Bullet's pool).
class btFemManifolds
{
public:
    /// Makes a dispatcher create algorithms with manifolds for pairs with FEM bodies whose solver shows manifolds. No
    /// effect if `dispatcher` is null or no btCollisionDispatcher.
    static void showIn(btDispatcher* dispatcher);

    /// Call after the step: fills the manifolds of pairs in contact, and releases the others.
    void update();

    /// In the order of creation.
    const std::vector<btFemPairAlgorithm*>& algorithms() const { return m_algorithms; }

    /// For the pairs' algorithms; may be called by several threads.
    void add(btFemPairAlgorithm* algorithm);
    void remove(btFemPairAlgorithm* algorithm);

private:
    std::mutex m_mutex;
    std::vector<btFemPairAlgorithm*> m_algorithms;
};
