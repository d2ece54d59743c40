// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <stdexcept>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/io/surface_file.h"

btSoftBody* btFemHelpers::createFromSurfaceFile(btSoftBodyWorldInfo& worldInfo, const char* path, btScalar cellSize,
                                                btScalar scale)
{
    if (!path) throw std::invalid_argument("createFromSurfaceFile: the path is null");
    bullet_fem::CageSettings settings;
    settings.m_cellSize = cellSize;
    return createFromSurface(worldInfo, bullet_fem::readSurfaceFile(path, scale), settings);
}
