// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <stdexcept>
#include <string>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/io/surface_file.h"
#include "fem/common/attempt.h"

btSoftBody* btFemHelpers::createFromSurfaceFile(btSoftBodyWorldInfo& worldInfo, const char* path, btScalar cellSize,
                                                btScalar scale, std::string* why)
{
    const auto create = [&]
    {
        if (!path) throw std::invalid_argument("createFromSurfaceFile: the path is null");
        bullet_fem::CageSettings settings;
        settings.m_cellSize = cellSize;
        return createFromSurface(worldInfo, bullet_fem::readSurfaceFile(path, scale), settings);
    };
    return bullet_fem::attemptValue(why, create);
}
