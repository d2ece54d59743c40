// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/bulletfem/cage_options.h"

#include "tools/console/option_range.h"

namespace bullet_fem
{

void CageOptions::add(CLI::App& command)
{
    CLI::Option* cell = command.add_option("--cell", m_cellSize, "of a surface: edge of the cage's cells [m]")
                            ->check(inRange(1e-9, 1e6));
    command.add_option("--tets", m_tets, "of a surface: about so many tetrahedra (default 2000)")
        ->check(inRange(5, 5e6))
        ->excludes(cell);
    command
        .add_option("--snap", m_snap,
                    "of a surface: move the cage's boundary by this share toward it [0 to 1] (default 0)")
        ->check(inRange(0, 1));
    CLI::Option* grade =
        command
            .add_option("--grade", m_cellsAcross,
                        "of a surface: smaller cells where it is thin, so many across [0.5 to 8], 2 is usual")
            ->check(inRange(0.5, 8));
    command.add_option("--levels", m_mostLevels, "with --grade: cells are halved up to so often [1 to 6] (default 3)")
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
