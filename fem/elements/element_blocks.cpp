// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/elements/element_blocks.h"

#include <algorithm>

namespace bullet_fem
{

template <class Real>
ElementBlocks<Real>::ElementBlocks(const RestShape& shape) : m_blocks(bullet_fem::blockCount(shape.m_mesh.tetCount()))
{
    const int last = shape.m_mesh.tetCount() - 1;
    for (int e = 0; e < blockCount() * kLanes; ++e)
    {
        const RestElement& element = shape.m_elements[std::min(e, last)];
        const double stiffness = e <= last ? 1 : 0;
        ElementBlock<Real>& block = m_blocks[e / kLanes];
        const int lane = e % kLanes;
        const Tet& tet = shape.m_mesh.tets()[std::min(e, last)];
        for (int a = 0; a < 3; ++a)
        {
            const Vec3 edge = shape.m_mesh.restPositions()[tet[a + 1]] - shape.m_mesh.restPositions()[tet[0]];
            for (int c = 0; c < 3; ++c) block.m_Dm[3 * c + a][lane] = edge[c];
        }
        for (int k = 0; k < 9; ++k) block.m_DmInverse[k][lane] = static_cast<Real>(element.m_DmInverse(k / 3, k % 3));
        block.m_lambdaVolume[lane] = static_cast<Real>(stiffness * element.m_lambdaVolume);
        block.m_muVolume[lane] = static_cast<Real>(stiffness * element.m_muVolume);
        for (int a = 0; a < 4; ++a) block.m_node[lane][a] = tet[a];
    }
}

template struct ElementBlocks<float>;
template struct ElementBlocks<double>;

NodeCorners::NodeCorners(const RestShape& shape)
    : m_start(shape.m_mesh.nodeCount() + 1, 0),
      m_corner(4 * shape.m_elements.size()),
      m_volume(kLanes * blockCount(shape.m_mesh.tetCount()), 0.0f),
      m_parity(shape.m_elements.size())
{
    const std::vector<Tet>& tets = shape.m_mesh.tets();
    for (const Tet& tet : tets)
        for (int node : tet) ++m_start[node + 1];
    for (int i = 0; i < nodeCount(); ++i) m_start[i + 1] += m_start[i];
    std::vector<int> next(m_start.begin(), m_start.end() - 1);
    for (std::size_t e = 0; e < tets.size(); ++e)
    {
        m_volume[e] = static_cast<float>(shape.m_elements[e].m_volume);
        for (int a = 0; a < 4; ++a)
        {
            const int node = tets[e][a];
            m_parity[e][a] = (next[node] - m_start[node]) % 2;
            m_corner[next[node]++] = corner(static_cast<int>(e), a);
        }
    }
    for (int i = 0; i < nodeCount(); ++i)
    {
        float volumes[2] = {0, 0};
        for (int k = m_start[i]; k < m_start[i + 1]; ++k)
            volumes[(k - m_start[i]) % 2] += m_volume[element(m_corner[k])];
        m_volumeAround.push_back(volumes[0] + volumes[1]);
    }
}

}  // namespace bullet_fem
