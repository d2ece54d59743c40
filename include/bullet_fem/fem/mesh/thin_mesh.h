// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

/// Edges for each cell of depth from a corner of a body of cubes to the nearest node at that depth, without diagonals.
constexpr int kThinReach = 3;

/// True if a mesh has fewer than four cells across somewhere. The depth of a node is the number of edges from it to the
/// nearest node of the surface: n cells between two opposite surfaces have nodes of depth n / 2, rounded down. A mesh
/// is thin if a node is more than d kThinReach edges away from every node of depth d or more, d = 1 or 2, or is not
/// connected to one. So edges and corners of a thick body, and fins about as long as thick, are not thin. Three cells
/// of a body-centred lattice count as four, because the centres of its cells are nodes. Depends on the elements' nodes
/// alone, not on positions. Takes ten passes over the elements. Allocates.
BULLETFEM_API bool isThinSomewhere(const TetMesh& mesh);

}  // namespace bullet_fem
