// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/bulletfem/cage_options.h"

#include "tools/console/option_range.h"

namespace bullet_fem
{

void CageOptions::add(CLI::App& command)
{
    CLI::Option* cell = command.add_option("--cell", m_cellSize, "for a surface: edge of the cage's cells [m]")
                            ->check(inRange(1e-9, 1e6));
    command.add_option("--tets", m_tets, "for a surface: approximate number of tetrahedra (default 2000)")
        ->check(inRange(5, 5e6))
        ->excludes(cell);
    command
        .add_option("--snap", m_snap,
                    "for a surface: moves the cage's boundary by this fraction toward it [0 to 1] (default 0)")
        ->check(inRange(0, 1));
    CLI::Option* grade =
        command
            .add_option(
                "--grade", m_cellsAcross,
                "for a surface: number of cells across thin parts, which get smaller cells [0.5 to 8], usually 2")
            ->check(inRange(0.5, 8));
    command
        .add_option("--levels", m_mostLevels, "with --grade: maximum number of halvings of cells [1 to 6] (default 3)")
        ->check(inRange(1, 6))
        ->needs(grade);
}

CageSettings CageOptions::settings() const
{
    CageSettings settings;
    settings.m_cellSize = m_cellSize;
    settings.m_targetTets = m_cellSize > 0 ? 0 : m_tets;
    settings.m_maxTets = 5000000;
    settings.m_snap = m_snap;
    settings.m_cellsAcross = m_cellsAcross;
    settings.m_mostLevels = m_mostLevels;
    settings.m_surfaceCollides = m_surfaceCollides;
    return settings;
}

}  // namespace bullet_fem
