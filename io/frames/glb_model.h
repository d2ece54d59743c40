// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <string>
#include <vector>

#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

using Float3 = std::array<float, 3>;

/// A surface in all frames of a film.
struct GlbBody
{
    int m_id = 0;
    std::size_t m_nodeCount = 0;                  ///< nodes of the body
    std::vector<int> m_node;                      ///< node of every vertex
    std::vector<Triangle> m_given;                ///< node triangles of the first frame
    std::vector<Triangle> m_triangles;            ///< vertex triangles
    std::vector<std::vector<Float3>> m_position;  ///< per frame and vertex [m]
    std::vector<std::vector<float>> m_vonMises;   ///< per frame and vertex [Pa]; empty without colours
};

/// A film that is ready to be written.
struct GlbModel
{
    const std::vector<GlbBody>& m_bodies;
    const std::vector<float>& m_times;  ///< [s], ascending from 0
    bool m_stepped = false;
    bool m_normals = true;
    bool m_zUp = false;
    bool m_peakColours = false;  ///< maximum over all frames instead of each frame's value
    double m_hottest = 0;        ///< stress of the top colour [Pa]; 0: no colours
};

/// The bytes of its file.
std::string glbBytes(const GlbModel& model);

}  // namespace bullet_fem
