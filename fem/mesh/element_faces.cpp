// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/mesh/element_faces.h"

#include <algorithm>
#include <tuple>

namespace bullet_fem
{

std::vector<ElementFace> sortedFaces(const std::vector<Tet>& tets)
{
    std::vector<ElementFace> faces;
    faces.reserve(4 * tets.size());
    for (std::size_t e = 0; e < tets.size(); ++e)
        for (int a = 0; a < 4; ++a)
        {
            Triangle nodes = {tets[e][(a + 1) % 4], tets[e][(a + 2) % 4], tets[e][(a + 3) % 4]};
            std::sort(nodes.begin(), nodes.end());
            faces.push_back({nodes, static_cast<int>(e), a});
        }
    std::sort(faces.begin(), faces.end(),
              [](const ElementFace& f, const ElementFace& g)
              { return std::tie(f.m_nodes, f.m_tet) < std::tie(g.m_nodes, g.m_tet); });
    return faces;
}

std::vector<std::array<int, 4>> elementsBehindFaces(const std::vector<Tet>& tets)
{
    const std::vector<ElementFace> faces = sortedFaces(tets);
    std::vector<std::array<int, 4>> behind(tets.size(), {-1, -1, -1, -1});
    for (std::size_t k = 1; k < faces.size(); ++k)
    {
        const ElementFace &f = faces[k - 1], &g = faces[k];
        if (f.m_nodes != g.m_nodes) continue;
        behind[f.m_tet][f.m_opposite] = g.m_tet;
        behind[g.m_tet][g.m_opposite] = f.m_tet;
    }
    return behind;
}

}  // namespace bullet_fem
