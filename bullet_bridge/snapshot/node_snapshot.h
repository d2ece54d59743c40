// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <vector>

#include "bullet_bridge/body/fem_soft_body.h"

namespace bullet_fem
{

/// The values that steps write to a btSoftBody besides the FEM state, and FemSoftBody's record of its nodes. Redundant
/// arrays are empty: m_x and m_v if they equal the values last written, those if they equal the rounded state, forces
/// and pins if all are zero.
struct NodeSnapshot
{
    using Components = std::array<btScalar, 3>;

    std::vector<Components> m_x, m_q, m_v, m_vn, m_f, m_n;  ///< as in btSoftBody::Node
    std::vector<btScalar> m_inverseMass, m_area;
    std::vector<unsigned char> m_attached;  ///< 1 where m_battach is set; empty if all are 0
    std::vector<Components> m_faceNormal;   ///< as in btSoftBody::Face
    std::vector<btScalar> m_faceArea;       ///< [m2]
    std::array<Components, 2> m_bounds;     ///< bounds for the broad phase [m]
    bool m_constantsOutdated = false;       ///< btSoftBody::m_bUpdateRtCst
    int m_activation = 0;                   ///< activation state
    btScalar m_deactivationTime = 0;        ///< [s]
    btScalar m_maxSpeedSquared = 0;         ///< [m2/s2]

    std::vector<Components> m_writtenX, m_writtenV;  ///< as in WrittenNodes
    std::vector<btScalar> m_writtenInverseMass;      ///< empty if equal to m_inverseMass
    std::vector<Vec3> m_pinVelocity, m_pinPosition;  ///< as in NodePins
    std::vector<unsigned char> m_hasTarget, m_moved;
    Vec3 m_restOrigin;  ///< as in FemSoftBody [m]
};

/// Copies the state of a body's nodes.
NodeSnapshot nodeSnapshotOf(const FemSoftBody& fem);

/// Throws std::invalid_argument, naming the value, unless the snapshot is consistent with this body.
void check(const NodeSnapshot& snapshot, const FemSoftBody& fem);

/// Restores the body's nodes. Call after check() and after restoring the FEM state.
void restore(const NodeSnapshot& snapshot, FemSoftBody& fem);

template <class Bytes>
void transfer(Bytes& bytes, NodeSnapshot& s)
{
    bytes(s.m_x, s.m_q, s.m_v, s.m_vn, s.m_f, s.m_n, s.m_inverseMass, s.m_area, s.m_attached, s.m_faceNormal,
          s.m_faceArea, s.m_bounds, s.m_constantsOutdated, s.m_activation, s.m_deactivationTime, s.m_maxSpeedSquared,
          s.m_writtenX, s.m_writtenV, s.m_writtenInverseMass, s.m_pinVelocity, s.m_pinPosition, s.m_hasTarget,
          s.m_moved, s.m_restOrigin);
}

}  // namespace bullet_fem
