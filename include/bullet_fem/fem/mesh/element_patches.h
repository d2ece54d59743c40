// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

/// The elements of a mesh in groups of neighbours, one to kMost each: patches over which a volume change is averaged
/// (docs/materials.md). Four to eight elements around an edge, or an element with its neighbours, are patches, the most
/// compact ones first: the five or six tetrahedra of a cube, the octahedra around the axes of a body-centred lattice.
/// What is left over makes patches with its neighbours.
///
/// Every patch is connected through faces. The same mesh gives the same patches on every machine. Const once built.
struct BULLETFEM_API ElementPatches
{
    static constexpr int kMost = 8;  ///< elements of a patch

    ElementPatches() = default;
    /// `group`: per element, ElementMaterials::patchGroups(): patches join none of different groups. Empty: one group.
    explicit ElementPatches(const TetMesh& mesh, const std::vector<int>& group = {});

    /// True if there are none: every element has its own volume change.
    bool empty() const { return m_element.empty(); }
    /// Number of patches.
    int count() const { return static_cast<int>(m_start.size()) - 1; }
    /// Elements of a patch, in [1, kMost]; `patch` in [0, count()).
    int size(int patch) const;

    std::vector<int> m_start = {0};  ///< of every patch and of the end, into m_element
    std::vector<int> m_element;      ///< every element of the mesh once; ascending within a patch
    std::vector<int> m_patch;        ///< of every element
};

}  // namespace bullet_fem
