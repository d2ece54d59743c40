// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/fem/cage/surface_mesh.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

/// Of the nodes that are not pinned [kg].
double massOf(const btSoftBody& body);
/// Of mass [m].
btVector3 centreOf(const btSoftBody& body);
/// Of the centre of mass [m/s].
btVector3 velocityOf(const btSoftBody& body);
/// Lowest and highest of all nodes' coordinates [m].
btVector3 lowestOf(const btSoftBody& body);
btVector3 highestOf(const btSoftBody& body);
/// Extent along the axes [m].
inline btVector3 sizeOf(const btSoftBody& body)
{
    return highestOf(body) - lowestOf(body);
}

/// Of every tetrahedron [m3]; negative where it is inside out.
std::vector<double> volumesOf(const btSoftBody& body);

/// A surface about the origin, its longest side `length` [m] along x, its shortest along y.
SurfaceMesh lyingDown(SurfaceMesh surface, double length);

/// A box along the axes, by two corners [m].
struct Block
{
    Vec3 m_low, m_high;
};
/// Whether a place is in one of them.
bool isIn(const std::vector<Block>& blocks, const Vec3& place);
/// A mesh without the elements whose middle is in one of the holes, as scenes have them.
TetMesh carved(const TetMesh& mesh, const std::vector<Block>& holes);
/// The elements of a body whose middle is in the block now.
std::vector<int> elementsIn(const btSoftBody& body, const Block& block);

}  // namespace bullet_fem
