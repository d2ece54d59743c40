// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <mutex>
#include <vector>

class btDispatcher;
class btFemPairAlgorithm;

/// What FEM bodies touch, as btPersistentManifolds for Bullet's loops and callbacks. The manifold of a pair belongs to
/// the pair's collision algorithm, which Bullet deletes when their bounds part, when one of the two is removed and when
/// the world dies: so a manifold never outlives its objects or its dispatcher, nor needs the solver to do so. Allocates
/// when a pair touches (from Bullet's pool).
class btFemManifolds
{
public:
    /// Makes a dispatcher pair FEM bodies whose solver shows manifolds by algorithms that carry them. Does nothing if
    /// `dispatcher` is null or no btCollisionDispatcher.
    static void showIn(btDispatcher* dispatcher);

    /// After the step: the manifolds of pairs that touch are filled, those of others released.
    void update();

    /// For the pairs' algorithms; may be called by several threads.
    void add(btFemPairAlgorithm* algorithm);
    void remove(btFemPairAlgorithm* algorithm);

private:
    std::mutex m_mutex;
    std::vector<btFemPairAlgorithm*> m_algorithms;  // in the order of their making
};
