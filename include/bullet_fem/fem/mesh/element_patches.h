// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

/// Disjoint groups of neighbouring elements, one to kMax each: patches over which the volume change is averaged (mean
/// dilatation [Nagtegaal et al. 1974], docs/materials.md). Candidates are four to eight elements around an edge, and an
/// element with its face neighbours; the most compact candidates are taken first, for instance the five or six
/// tetrahedra of a cube or the octahedra around the axes of a body-centred lattice. Remaining elements form patches
/// with their neighbours.
///
/// Every patch is connected through faces. Patches depend on the mesh alone, not on the machine. Constant once built.
struct BULLETFEM_API ElementPatches
{
    static constexpr int kMax = 8;  ///< maximum number of elements in a patch
    [[deprecated("kMax")]] static constexpr int kMost = kMax;

    ElementPatches() = default;
    /// Builds the patches. `group`: one number per element (ElementMaterials::patchGroups()); a patch never joins
    /// different groups. Empty: one group. Allocates.
    explicit ElementPatches(const TetMesh& mesh, const std::vector<int>& group = {});

    /// True if there are no patches: every element has its own volume change.
    bool empty() const { return m_element.empty(); }
    /// Number of patches.
    int count() const { return static_cast<int>(m_start.size()) - 1; }
    /// Number of elements in a patch, in [1, kMax]; `patch` in [0, count()).
    int size(int patch) const;

    std::vector<int> m_start = {0};  ///< start of each patch in m_element, then the end
    std::vector<int> m_element;      ///< every element of the mesh once; ascending within a patch
    std::vector<int> m_patch;        ///< patch of each element
};

}  // namespace bullet_fem
