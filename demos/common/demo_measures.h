// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/fem/cage/surface_mesh.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

/// Mass of the free nodes [kg].
double massOf(const btSoftBody& body);
/// Centre of mass of the free nodes [m].
btVector3 centreOf(const btSoftBody& body);
/// Velocity of the centre of mass [m/s].
btVector3 velocityOf(const btSoftBody& body);
/// Minimum and maximum coordinates over all nodes [m].
btVector3 lowestOf(const btSoftBody& body);
btVector3 highestOf(const btSoftBody& body);
/// Extent along the axes [m].
inline btVector3 sizeOf(const btSoftBody& body)
{
    return highestOf(body) - lowestOf(body);
}

/// Volume of each tetrahedron [m3]; negative if it is inverted.
std::vector<double> volumesOf(const btSoftBody& body);

/// The surface moved to the origin, scaled to `length` [m] along x, its longest side, with its shortest side along y.
SurfaceMesh lyingDown(SurfaceMesh surface, double length);

/// A box along the axes, given by two corners [m].
struct Block
{
    Vec3 m_low, m_high;
};
/// Whether a point is in one of the blocks.
bool isIn(const std::vector<Block>& blocks, const Vec3& place);
/// The mesh without the elements whose centre is in one of the holes, as in scene files.
TetMesh carved(const TetMesh& mesh, const std::vector<Block>& holes);
/// The elements of a body whose centre is in the block now.
std::vector<int> elementsIn(const btSoftBody& body, const Block& block);

}  // namespace bullet_fem
