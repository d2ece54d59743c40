// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bullet_fem/fem/cage/cage.h"

namespace bullet_fem
{

/// Elements, from a mesh file, or from a surface file by a cage around it.
struct MeshInput
{
    TetMesh m_mesh;
    std::vector<int> m_labels;  // of the elements' regions; empty if the file has none
    std::optional<Cage> m_cage;
    SurfaceMesh m_surface;  // what the cage is around

    /// Throws std::runtime_error or std::invalid_argument that names the file, and CageCancelled.
    static MeshInput read(const std::string& path, double scale, const CageSettings& settings);
};

/// By its ending: OFF, OBJ, STL or PLY.
bool isSurfaceFile(const std::string& path);

}  // namespace bullet_fem
