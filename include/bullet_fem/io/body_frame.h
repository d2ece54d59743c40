// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/step/stress.h"

namespace bullet_fem
{

/// A body at one instant, the input of the file writers. Keep one object per body and update it every frame; empty
/// arrays are not written. All quantities in world axes.
struct BodyFrame
{
    int m_id = 0;                            ///< identifies the body in the files; any number
    std::vector<Vec3> m_positions;           ///< node positions [m]
    std::vector<Tet> m_tets;                 ///< tetrahedra; may be empty, as for a rigid body
    std::vector<Triangle> m_triangles;       ///< surface triangles, counter-clockwise seen from outside
    std::vector<Vec3> m_displacement;        ///< one per node, from any reference position [m]
    std::vector<Vec3> m_velocity;            ///< one per node [m/s]
    std::vector<Vec3> m_contactForce;        ///< one per node [N]
    std::vector<Vec3> m_reactionForce;       ///< force of the support on the body, one per node [N]
    std::vector<Stress> m_nodeStress;        ///< one per node [Pa]
    std::vector<Stress> m_tetStress;         ///< one per tetrahedron [Pa]
    std::vector<double> m_tetPlasticStrain;  ///< equivalent plastic strain, one per tetrahedron [-]
    std::vector<int> m_tetRegion;            ///< region label, one per tetrahedron, as TetMeshFile::m_regions
    std::vector<double> m_tetActivation;     ///< stress along its fibres, one per tetrahedron [Pa]
};

}  // namespace bullet_fem
