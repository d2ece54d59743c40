// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/bulletfem/split_film.h"

#include "BulletSoftBody/btSoftBody.h"

namespace bullet_fem
{

void SplitFilm::add()
{
    m_kept.push_back({m_world.time(), m_frames.surfaces()});
    for (BodyFrame& body : m_kept.back().m_bodies)
    {
        if (body.m_id >= m_world.softCount() || !m_world.fractures().find(m_world.soft(body.m_id))) continue;
        const BodyFrame& volume = m_frames.volumes()[body.m_id];
        body.m_positions = volume.m_positions;  // all nodes: inner nodes may become part of a crack surface
        body.m_nodeStress = volume.m_nodeStress;
    }
}

// Nodes added by later splits take the position of the node that they copy, which may be a copy itself.
void SplitFilm::complete(int body, BodyFrame& frame) const
{
    const btSoftBody& soft = m_world.soft(body);
    const SceneSplits* splits = m_world.fractures().find(soft);
    if (!splits) return;
    for (int n = static_cast<int>(frame.m_positions.size()); n < soft.m_nodes.size(); ++n)
    {
        const std::size_t from = splits->m_copyOf[n - splits->m_nodes];
        frame.m_positions.push_back(frame.m_positions[from]);
        if (!frame.m_nodeStress.empty()) frame.m_nodeStress.push_back(frame.m_nodeStress[from]);
    }
    frame.m_triangles.resize(soft.m_faces.size());
    for (int t = 0; t < soft.m_faces.size(); ++t)
        for (int a = 0; a < 3; ++a)
            frame.m_triangles[t][a] = static_cast<int>(soft.m_faces[t].m_n[a] - &soft.m_nodes[0]);
}

void SplitFilm::give(GlbFilm& film)
{
    for (Frame& frame : m_kept)
    {
        for (BodyFrame& body : frame.m_bodies)
            if (body.m_id < m_world.softCount()) complete(body.m_id, body);
        film.addFrame(frame.m_time, frame.m_bodies);
        frame = {};
    }
}

}  // namespace bullet_fem
