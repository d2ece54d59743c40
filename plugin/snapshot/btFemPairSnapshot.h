// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "BulletCollision/NarrowPhaseCollision/btManifoldPoint.h"
#include "BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h"
#include "plugin/snapshot/btFemRecordSnapshot.h"

class btFemManifolds;

/// A pair of the broad phase. Objects are those of the world, by index.
struct btFemPairOfObjects
{
    int m_first = 0, m_second = 0;
    bool m_hasAlgorithm = false;
};

/// A btPersistentManifold.
struct btFemManifoldSnapshot
{
    int m_pair = 0, m_place = 0;  ///< index of its pair, and among the manifolds of that pair
    btScalar m_breakingThreshold = 0, m_processingThreshold = 0;
    std::vector<btManifoldPoint> m_points;  ///< without user pointers
};

/// Pairs and contacts of a world, each in Bullet's order, on which the order of solving depends.
struct btFemPairsSnapshot
{
    std::vector<btFemPairOfObjects> m_pairs;
    std::vector<int> m_femPairs;  ///< pairs with a btFemPairAlgorithm, in the order of creation
    std::vector<btFemManifoldSnapshot> m_manifolds;
};

/// `shown`: manifolds of FEM bodies; null if there are none. Throws std::invalid_argument if the world's dispatcher is
/// no btCollisionDispatcher.
btFemPairsSnapshot pairsSnapshotOf(btDiscreteDynamicsWorld& world, const btFemManifolds* shown);

/// Throws std::invalid_argument, naming the value, unless the snapshot is consistent with the world.
void check(const btFemPairsSnapshot& snapshot, btDiscreteDynamicsWorld& world);

/// Removes the world's pairs. The objects' places must be those of the pairs that restore() will make.
void removePairs(btDiscreteDynamicsWorld& world);

/// Call after check(), removePairs(), and after the objects and the broad phase were restored.
void restore(const btFemPairsSnapshot& snapshot, btDiscreteDynamicsWorld& world);

template <class Bytes>
void transfer(Bytes& bytes, btFemPairOfObjects& s)
{
    bytes(s.m_first, s.m_second, s.m_hasAlgorithm);
}

template <class Bytes>
void transfer(Bytes& bytes, btManifoldPoint& p)
{
    bytes(p.m_localPointA, p.m_localPointB, p.m_positionWorldOnA, p.m_positionWorldOnB, p.m_normalWorldOnB,
          p.m_distance1, p.m_combinedFriction, p.m_combinedRollingFriction, p.m_combinedSpinningFriction,
          p.m_combinedRestitution, p.m_partId0, p.m_partId1, p.m_index0, p.m_index1, p.m_contactPointFlags,
          p.m_appliedImpulse, p.m_prevRHS, p.m_appliedImpulseLateral1, p.m_appliedImpulseLateral2, p.m_contactMotion1,
          p.m_contactMotion2, p.m_contactCFM, p.m_contactERP, p.m_frictionCFM, p.m_lifeTime, p.m_lateralFrictionDir1,
          p.m_lateralFrictionDir2);
}

template <class Bytes>
void transfer(Bytes& bytes, btFemManifoldSnapshot& s)
{
    bytes(s.m_pair, s.m_place, s.m_breakingThreshold, s.m_processingThreshold, s.m_points);
}

template <class Bytes>
void transfer(Bytes& bytes, btFemPairsSnapshot& s)
{
    bytes(s.m_pairs, s.m_femPairs, s.m_manifolds);
}
