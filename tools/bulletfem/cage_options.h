// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <CLI/CLI.hpp>

#include "bullet_fem/fem/cage/cage_settings.h"

namespace bullet_fem
{

/// Command-line options of a cage.
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

}  // namespace bullet_fem
