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

/// The elements around every edge of a mesh: domains over which strains are averaged where a material bends accurately
/// (edge-smoothed finite elements, docs/materials.md). Every element gives a sixth of its smoothed volume to each of
/// its six edges:
///
///     s_k = sum over e of b_e V_e eps_e / sum over e of b_e V_e,    eps_e <- b_e / 6 sum over k of s_k + (1 - b_e)
///     eps_e
///
/// b_e, the share that is smoothed, is 0 where a material does not bend accurately. Domains do not cross regions of
/// different materials. The same mesh gives the same domains on every machine. Const once built.
struct BULLETFEM_API EdgeDomains
{
    /// b of what bends accurately. With 1 bars of one cell across bend 30 to 60 % too much and bars of two 5 to 9 %;
    /// with this all from two cells on are within 6 %, and those of one within 15 %. What is left is soft enough for
    /// bending and keeps elements from being strained alone.
    static constexpr double kShare = 0.8;

    EdgeDomains() = default;
    /// `group`: per element, ElementMaterials::patchGroups(); empty: one group. `volume`: of every element [m3], > 0.
    EdgeDomains(const TetMesh& mesh, const ElementMaterials& materials, const std::vector<int>& group,
                const std::vector<double>& volume);

    /// True if there are none: no strain is averaged.
    bool empty() const { return m_element.empty(); }
    /// Number of domains.
    int count() const { return static_cast<int>(m_start.size()) - 1; }

    std::vector<int> m_start = {0};            ///< of every domain and of the end, into m_element
    std::vector<int> m_element;                ///< elements of the domains, ascending within each
    std::vector<double> m_weight;              ///< of every entry of m_element in its domain's mean [-]; sum to 1
    std::vector<std::array<int, 6>> m_domain;  ///< of every element; 0 where its share is 0
    std::vector<double> m_share;               ///< b_e [-], in [0, 1]
};

}  // namespace bullet_fem
