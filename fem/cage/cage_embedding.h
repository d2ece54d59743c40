// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "fem/cage/cage_fill.h"

namespace bullet_fem
{

/// Barycentric weights of p in a tet; their sum is 1 to rounding.
std::array<double, 4> barycentric(const std::array<Vec3, 4>& x, const Vec3& p);

/// Ensures that every used vertex [m] lies in a kept tet, and returns its element in the order of fill.m_tets (0 for
/// unused vertices).
std::vector<int> holdVertices(const CageLattice& lattice, const std::vector<Vec3>& vertices,
                              const std::vector<char>& used, CageFill& fill);

/// Barycentric weights with the final nodes, which reproduce the vertex.
std::vector<Embedding> embed(const std::vector<Vec3>& vertices, const std::vector<int>& held, const TetMesh& mesh);

/// Embeds every used vertex again after nodes have moved: in the best element around its previous one, or in the best
/// of all if none of these contains it.
void embedAnew(const TetMesh& mesh, const std::vector<Vec3>& vertices, const std::vector<char>& used,
               std::vector<Embedding>& embedding);

}  // namespace bullet_fem
