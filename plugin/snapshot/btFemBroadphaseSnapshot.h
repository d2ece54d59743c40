// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <vector>

#include "BulletCollision/BroadphaseCollision/btDbvtBroadphase.h"
#include "BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h"
#include "plugin/snapshot/btFemRecordSnapshot.h"

/// A node of a tree of bounds.
struct btFemTreeNodeSnapshot
{
    btVector3 m_low{0, 0, 0}, m_high{0, 0, 0};  ///< bounds [m]
    int m_object = -1;                          ///< index of the object of a leaf; -1: it has two children
    int m_rank = 0;                             ///< place of its address among the tree's: Bullet compares addresses
};

/// A btDbvt.
struct btFemTreeSnapshot
{
    std::vector<btFemTreeNodeSnapshot> m_nodes;  ///< each before its children
    int m_freeRank = -1;                         ///< rank of the node in reserve; -1: none
    int m_lookAhead = -1;
    unsigned m_path = 0;
};

/// Bounds of an object [m].
struct btFemBoundsSnapshot
{
    btVector3 m_low{0, 0, 0}, m_high{0, 0, 0};
};

/// A btDbvtBroadphase without its pairs. Objects are those of the world, by index.
struct btFemBroadphaseSnapshot
{
    std::vector<btFemBoundsSnapshot> m_bounds;
    std::array<btFemTreeSnapshot, 2> m_trees;
    std::array<std::vector<int>, btDbvtBroadphase::STAGECOUNT + 1> m_stages;
    int m_stage = 0, m_newPairs = 0, m_fixedLeft = 0, m_parseId = 0, m_cleanUpAt = 0, m_lastId = 0;
    unsigned m_updateCalls = 0, m_updatesDone = 0;
    btScalar m_updateRatio = 0;
    bool m_needsCleanUp = false;
};

/// The world's broad phase. Throws std::invalid_argument if it is of another class.
btDbvtBroadphase& treesOf(btDiscreteDynamicsWorld& world);

/// Throws std::invalid_argument if the broad phase has objects that are not in the world.
btFemBroadphaseSnapshot broadphaseSnapshotOf(btDiscreteDynamicsWorld& world);

/// Throws std::invalid_argument unless every object of the world is in one tree and in one stage, and once.
void check(const btFemBroadphaseSnapshot& snapshot, btDiscreteDynamicsWorld& world);

/// Call after check().
void restore(const btFemBroadphaseSnapshot& snapshot, btDiscreteDynamicsWorld& world);

template <class Bytes>
void transfer(Bytes& bytes, btFemTreeNodeSnapshot& s)
{
    bytes(s.m_low, s.m_high, s.m_object, s.m_rank);
}

template <class Bytes>
void transfer(Bytes& bytes, btFemTreeSnapshot& s)
{
    bytes(s.m_nodes, s.m_freeRank, s.m_lookAhead, s.m_path);
}

template <class Bytes>
void transfer(Bytes& bytes, btFemBoundsSnapshot& s)
{
    bytes(s.m_low, s.m_high);
}

template <class Bytes>
void transfer(Bytes& bytes, btFemBroadphaseSnapshot& s)
{
    bytes(s.m_bounds, s.m_trees, s.m_stages, s.m_stage, s.m_newPairs, s.m_fixedLeft, s.m_parseId, s.m_cleanUpAt,
          s.m_lastId, s.m_updateCalls, s.m_updatesDone, s.m_updateRatio, s.m_needsCleanUp);
}
