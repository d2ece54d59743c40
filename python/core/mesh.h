// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bullet_fem/fem/baked/baked_body.h"
#include "bullet_fem/fem/cage/cage.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem::python
{

/// A tetrahedral mesh, of a file or made, or a cage with the surface in it.
struct Mesh
{
    TetMesh m_tets;
    std::vector<int> m_regions;          ///< label of each element; empty: none
    std::shared_ptr<const Cage> m_cage;  ///< null: no cage
    SurfaceMesh m_surface;               ///< embedded in the cage

    static Mesh ofTets(TetMesh tets) { return {std::move(tets), {}, nullptr, {}}; }
    static Mesh ofFile(const std::string& path, double scale);
    static Mesh ofSurface(SurfaceMesh surface, const CageSettings& settings);
};

}  // namespace bullet_fem::python
