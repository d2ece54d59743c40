// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <stdexcept>

#include "io/surface/polygon_mesh.h"

namespace bullet_fem
{

PolygonMesh readWithAssimp(const std::string&)
{
    throw std::runtime_error("this program reads neither OBJ nor STL, as it was built without Assimp; give PLY or OFF");
}

}  // namespace bullet_fem
