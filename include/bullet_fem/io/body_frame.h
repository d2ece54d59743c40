// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/step/stress.h"

namespace bullet_fem
{

/// A body at one instant, as the writers take it. Keep one a body, and give it new values every frame: positions, and
/// whatever else shall be shown; an empty array is not written. All in the world's axes.
struct BodyFrame
{
    int m_id = 0;                            ///< tells bodies apart in the files; any number
    std::vector<Vec3> m_positions;           ///< of the nodes [m]
    std::vector<Tet> m_tets;                 ///< may be empty, as of a rigid body
    std::vector<Triangle> m_triangles;       ///< the surface, counter-clockwise seen from outside
    std::vector<Vec3> m_displacement;        ///< a node [m], from wherever the program likes
    std::vector<Vec3> m_velocity;            ///< a node [m/s]
    std::vector<Vec3> m_contactForce;        ///< a node [N]
    std::vector<Vec3> m_reactionForce;       ///< a node: by which it is held [N]
    std::vector<Stress> m_nodeStress;        ///< a node [Pa]
    std::vector<Stress> m_tetStress;         ///< a tetrahedron [Pa]
    std::vector<double> m_tetPlasticStrain;  ///< a tetrahedron, equivalent [-]
    std::vector<int> m_tetRegion;            ///< a tetrahedron: the label of its region, as TetMeshFile::m_regions
    std::vector<double> m_tetActivation;     ///< a tetrahedron: the stress along its fibres [Pa]
};

}  // namespace bullet_fem
