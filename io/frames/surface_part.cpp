// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "io/frames/surface_part.h"

#include "fem/common/message.h"

namespace bullet_fem
{

SurfacePart::SurfacePart(const char* caller, const BodyFrame& body) : m_triangles(body.m_triangles)
{
    if (m_triangles.empty())
        reject(caller, ": body ", body.m_id, " has no triangle; give its surface, as of TetMesh::surface()");
    std::vector<int> vertex(body.m_positions.size(), -1);
    for (const Triangle& t : m_triangles)
        for (const int node : t) vertex[node] = 0;
    for (std::size_t i = 0; i < vertex.size(); ++i)
    {
        if (vertex[i] < 0) continue;
        vertex[i] = static_cast<int>(m_node.size());
        m_node.push_back(static_cast<int>(i));
    }
    for (Triangle& t : m_triangles)
        for (int& node : t) node = vertex[node];
}

}  // namespace bullet_fem
