// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/cage/surface_mesh.h"
#include "demos/drop_options.h"

namespace bullet_fem
{

/// Size of the surface in the scene.
struct DropSize
{
    double m_fileLength = 0;  ///< longest side of the surface's bounding box in units of the file [-]
    double m_scale = 1;       ///< scene metres per unit of the file [m]
    double m_length = 0;      ///< longest side in the scene [m], the scene's unit of length
};

/// Takes the scale from the options, or chooses it for a length of 1 m. Throws std::invalid_argument if the body would
/// be smaller than 1 cm or larger than 100 m, outside the range of single precision and Bullet's margins.
DropSize chooseSize(const SurfaceMesh& surface, const DropOptions& options);

}  // namespace bullet_fem
