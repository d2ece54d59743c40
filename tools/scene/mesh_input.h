// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bullet_fem/fem/cage/cage.h"

namespace bullet_fem
{

/// A tetrahedral mesh from a mesh file, or from a surface file with a cage around it.
struct MeshInput
{
    TetMesh m_mesh;
    std::vector<int> m_labels;  // region labels of the elements; empty if the file has none
    std::optional<Cage> m_cage;
    SurfaceMesh m_surface;  // embedded in the cage

    /// Throws std::runtime_error or std::invalid_argument with the file name, and CageCancelled.
    static MeshInput read(const std::string& path, double scale, const CageSettings& settings);
};

/// Whether the file extension is OFF, OBJ, STL or PLY.
bool isSurfaceFile(const std::string& path);

}  // namespace bullet_fem
