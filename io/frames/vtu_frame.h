// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

#include "bullet_fem/io/body_frame.h"
#include "bullet_fem/io/vtu_writer.h"

namespace bullet_fem
{

/// The text of a .vtu file: one Piece element with the cells of all bodies, their tetrahedra or, without these, their
/// triangles. `named`: with the body ids as cell data. The bodies have been checked.
std::string vtuFrame(const std::vector<BodyFrame>& bodies, VtuEncoding encoding, bool named);

/// The text of a .vtu file with a mesh and, if there are any, the regions of its elements; coordinates have enough
/// digits for an exact round trip.
std::string vtuMesh(const TetMesh& mesh, const std::vector<int>& regions);

}  // namespace bullet_fem
