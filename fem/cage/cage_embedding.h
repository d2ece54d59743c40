// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "fem/cage/cage_fill.h"

namespace bullet_fem
{

/// Barycentric weights of p in a tet, sum exactly 1 but for rounding.
std::array<double, 4> barycentric(const std::array<Vec3, 4>& x, const Vec3& p);

/// Makes sure that every used vertex [m] lies in a kept tet, and returns its element in the order of fill.m_tets (0 for
/// unused vertices).
std::vector<int> holdVertices(const CageLattice& lattice, const std::vector<Vec3>& vertices,
                              const std::vector<char>& used, CageFill& fill);

/// Weights with the final nodes, so that they give the vertex back.
std::vector<Embedding> embed(const std::vector<Vec3>& vertices, const std::vector<int>& held, const TetMesh& mesh);

/// The same after nodes have moved: every used vertex hangs on the element that holds it best, of those around the one
/// it was in, or of all where none of these holds it.
void embedAnew(const TetMesh& mesh, const std::vector<Vec3>& vertices, const std::vector<char>& used,
               std::vector<Embedding>& embedding);

}  // namespace bullet_fem
