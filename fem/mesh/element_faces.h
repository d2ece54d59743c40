// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <vector>

#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

/// Corners of an element's edges.
constexpr int kElementEdges[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

struct ElementFace
{
    Triangle m_nodes;  // ascending
    int m_tet;
    int m_opposite;  // index in the element of the node opposite the face
};

/// The faces of all elements, sorted by nodes, then by element.
std::vector<ElementFace> sortedFaces(const std::vector<Tet>& tets);

/// The elements behind the faces opposite each node of every element; -1 on the boundary.
std::vector<std::array<int, 4>> elementsBehindFaces(const std::vector<Tet>& tets);

}  // namespace bullet_fem
