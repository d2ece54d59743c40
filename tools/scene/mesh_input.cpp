// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/mesh_input.h"

#include <stdexcept>

#include "bullet_fem/io/surface_file.h"
#include "bullet_fem/io/tet_mesh_file.h"
#include "fem/common/reason.h"
#include "io/text/file_bytes.h"

namespace bullet_fem
{

bool isSurfaceFile(const std::string& path)
{
    const std::string ending = lowerCaseEnding(path);
    return ending == ".off" || ending == ".obj" || ending == ".stl" || ending == ".ply";
}

MeshInput MeshInput::read(const std::string& path, double scale, const CageSettings& settings)
{
    MeshInput input;
    if (isSurfaceFile(path)) input.m_surface = readSurfaceFile(path, scale);
    try
    {
        if (isSurfaceFile(path))
        {
            input.m_cage = makeCage(input.m_surface, settings);
            input.m_mesh = input.m_cage->m_mesh;
            input.m_labels = input.m_cage->m_report.m_regions;
        }
        else
        {
            TetMeshFile file = readTetMeshFile(path, scale);
            input.m_mesh = file.mesh();
            input.m_labels = std::move(file.m_regions);
        }
    }
    catch (const std::invalid_argument& error)
    {
        throw std::runtime_error("'" + path + "': " + reasonOf(error));
    }
    return input;
}

}  // namespace bullet_fem
