// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "python/core/mesh.h"

#include <utility>

#include "bullet_fem/io/tet_mesh_file.h"

namespace bullet_fem::python
{

Mesh Mesh::ofFile(const std::string& path, double scale)
{
    TetMeshFile file = readTetMeshFile(path, scale);
    Mesh mesh = ofTets(file.mesh());
    mesh.m_regions = std::move(file.m_regions);
    return mesh;
}

Mesh Mesh::ofSurface(SurfaceMesh surface, const CageSettings& settings)
{
    auto cage = std::make_shared<Cage>(makeCage(surface, settings));
    Mesh mesh = ofTets(cage->m_mesh);
    mesh.m_regions = cage->m_report.m_regions;
    mesh.m_cage = std::move(cage);
    mesh.m_surface = std::move(surface);
    return mesh;
}

}  // namespace bullet_fem::python
