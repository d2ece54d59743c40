// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/mesh/edge_domains.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "fem/mesh/element_faces.h"

namespace bullet_fem
{

EdgeDomains::EdgeDomains(const TetMesh& mesh, const ElementMaterials& materials, const std::vector<int>& group,
                         const std::vector<double>& volume)
    : m_domain(mesh.tets().size(), {0, 0, 0, 0, 0, 0}), m_share(mesh.tets().size(), 0.0)
{
    for (int e = 0; e < mesh.tetCount(); ++e)
        if (materials.of(e).m_accurateBending) m_share[e] = kShare;
    struct Side
    {
        int m_low, m_high, m_group, m_tet, m_edge;
        auto place() const { return std::tie(m_low, m_high, m_group, m_tet); }
        auto domain() const { return std::tie(m_low, m_high, m_group); }
    };
    std::vector<Side> sides;
    sides.reserve(6 * mesh.tets().size());
    for (int e = 0; e < mesh.tetCount(); ++e)
        for (int k = 0; k < 6 && m_share[e] > 0; ++k)
        {
            const Tet& tet = mesh.tets()[e];
            const auto [low, high] = std::minmax(tet[kElementEdges[k][0]], tet[kElementEdges[k][1]]);
            sides.push_back({low, high, group.empty() ? 0 : group[e], e, k});
        }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.place() < b.place(); });
    for (std::size_t k = 0; k < sides.size();)
    {
        const std::size_t first = k;
        double sum = 0;
        for (; k < sides.size() && sides[k].domain() == sides[first].domain(); ++k)
        {
            const int e = sides[k].m_tet;
            sum += m_share[e] * volume[e];
            m_domain[e][sides[k].m_edge] = count();
            m_element.push_back(e);
        }
        for (std::size_t i = first; i < k; ++i) m_weight.push_back(m_share[m_element[i]] * volume[m_element[i]] / sum);
        m_start.push_back(static_cast<int>(m_element.size()));
    }
}

}  // namespace bullet_fem
