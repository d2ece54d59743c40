// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/geometry/surface/soft_surface.h"

namespace bullet_fem
{

// Unit normals of edges and vertices, outward. They are computed on demand, as few are near another body.

/// Mean of an edge's face normals.
Vec3 edgeNormal(const SoftSurface& surface, int edge);
/// Mean of a vertex's face normals weighted by their angles.
Vec3 nodeNormal(const SoftSurface& surface, int node);
/// The pseudonormal of a triangle's feature: its sign tells on which side of a closed surface a point is whose nearest
/// point lies on that feature [Baerentzen and Aanaes 2005].
Vec3 normalAt(const SoftSurface& surface, int triangle, const TrianglePoint& point);

/// Unit vector in a triangle's plane, perpendicular to its edge, into the triangle.
Vec3 intoFace(const SoftSurface& surface, int edge, int triangle);
/// Those of an edge's two triangles.
std::array<Vec3, 2> intoFaces(const SoftSurface& surface, int edge);

/// True if the normals of all faces at an edge (a node) are within 8 degrees of its normal.
bool isFlatEdge(const SoftSurface& surface, int edge);
bool isFlatNode(const SoftSurface& surface, int node);

/// Smallest dot product [-] of a direction with the unit vectors along the surface edges from a node. If it is >= 0,
/// the body near the node lies on the direction's side of a plane through the node.
double minAlongEdges(const SoftSurface& surface, int node, const Vec3& direction);

/// Centre of the bounding box at the start [m].
Vec3 middleOf(const SoftSurface& surface);

}  // namespace bullet_fem
