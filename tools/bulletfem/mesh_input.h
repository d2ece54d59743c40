// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "bullet_fem/fem/cage/cage.h"

namespace bullet_fem
{

/// How a cage is asked for on the command line.
struct CageOptions
{
    void add(CLI::App& command);
    CageSettings settings() const;

    double m_cellSize = 0;  // [m]; 0: by m_tets
    int m_tets = 2000;
    double m_snap = 0;
    double m_cellsAcross = 0;
    int m_mostLevels = 3;
    bool m_surfaceCollides = false;
};

/// Elements, from a mesh file, or from a surface file by a cage around it.
struct MeshInput
{
    TetMesh m_mesh;
    std::optional<Cage> m_cage;
    SurfaceMesh m_surface;  // what the cage is around

    /// Throws std::runtime_error or std::invalid_argument that names the file.
    static MeshInput read(const std::string& path, double scale, const CageOptions& options);
};

/// By its ending: OFF, OBJ, STL or PLY.
bool isSurfaceFile(const std::string& path);

}  // namespace bullet_fem
