// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

#include "bullet_fem/btFemVectors.h"
#include "tools/scene/scene_reader.h"
#include "tools/scene/scene_world.h"

namespace bullet_fem
{

/// A scene and its world.
struct SceneRun
{
    explicit SceneRun(const std::string& json, const std::string& folder = ".")
        : m_scene(parseScene(json, folder)), m_world(m_scene)
    {
    }
    SceneRun& until(double seconds)
    {
        while (m_world.time() < seconds - 1e-9) m_world.step();
        return *this;
    }
    Vec3 node(int body, int i) const { return vec3(m_world.soft(body).m_nodes[i].m_x); }
    int nodeCount(int body) const { return m_world.soft(body).m_nodes.size(); }
    Vec3 momentum(int body) const
    {
        Vec3 sum;
        for (int i = 0; i < nodeCount(body); ++i)
        {
            const btSoftBody::Node& n = m_world.soft(body).m_nodes[i];
            if (n.m_im > 0) sum += (1 / double(n.m_im)) * vec3(n.m_v);
        }
        return sum;
    }
    std::vector<int> nodesIn(int body, const SceneBox& box) const
    {
        std::vector<int> nodes;
        for (int i = 0; i < nodeCount(body); ++i)
            if (box.contains(node(body, i))) nodes.push_back(i);
        return nodes;
    }

    SceneDescription m_scene;
    SceneWorld m_world;
};

}  // namespace bullet_fem
