// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <vector>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/mesh/element_materials.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

/// The elements around every edge of a mesh: smoothing domains over which strains are averaged in materials with
/// accurate bending (edge-smoothed finite elements [Liu & Nguyen-Thoi 2010], docs/materials.md). Every element gives a
/// sixth of its smoothed volume to each of its six edges:
///
///     s_k = sum over e of b_e V_e eps_e / sum over e of b_e V_e
///     eps_e <- b_e / 6 sum over k of s_k + (1 - b_e) eps_e
///
/// The smoothed share b_e is 0 in materials without accurate bending. Domains do not cross regions of different
/// materials. They depend on the mesh alone, not on the machine. Constant once built.
struct BULLETFEM_API EdgeDomains
{
    /// b_e of materials with accurate bending [-]. With 1, bars one cell thick bend 30 to 60 % too much and bars of two
    /// cells 5 to 9 %; with 0.8 the error is at most 6 % from two cells on, and 15 % for one. The unsmoothed fifth is
    /// soft enough for bending and suppresses modes that strain single elements.
    static constexpr double kShare = 0.8;

    EdgeDomains() = default;
    /// Builds the domains. `group`: one patch group per element (ElementMaterials::patchGroups()); empty: one group.
    /// `volume`: one volume per element [m3], > 0. Allocates.
    EdgeDomains(const TetMesh& mesh, const ElementMaterials& materials, const std::vector<int>& group,
                const std::vector<double>& volume);

    /// True if there are no domains: no strain is averaged.
    bool empty() const { return m_element.empty(); }
    /// Number of domains.
    int count() const { return static_cast<int>(m_start.size()) - 1; }

    std::vector<int> m_start = {0};  ///< start of each domain in m_element, then the end
    std::vector<int> m_element;      ///< elements of all domains, ascending within each domain
    /// Weight of each entry of m_element in its domain's mean [-]; sums to 1 per domain.
    std::vector<double> m_weight;
    std::vector<std::array<int, 6>> m_domain;  ///< domains of each element's six edges; 0 where its share is 0
    std::vector<double> m_share;               ///< b_e of each element [-], in [0, 1]
};

}  // namespace bullet_fem
