// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/cage/bisected_tets.h"
#include "fem/cage/cage_lattice.h"
#include "fem/cage/thin_parts.h"
#include "fem/cage/winding_near.h"

namespace bullet_fem
{

/// Limits of the refinement.
struct Grading
{
    double m_cellsAcross = 0;  ///< [-], > 0
    int m_maxGenerations = 0;  ///< maximum bisections of a tet, three per level

    static Grading of(const CageSettings& settings) { return {settings.m_cellsAcross, 3 * settings.m_mostLevels}; }
};

/// A surface relative to the centre of its bounding box, and its thin parts for cells up to a given size.
class GradedSurface
{
public:
    /// Searches parts that are thin for cells of this size [m] or smaller, with m_cellsAcross and m_mostLevels.
    GradedSurface(const SurfaceInspection& surface, const SurfaceWinding& winding, const CageSettings& settings,
                  double cellSize);

    const TriangleTree& tree() const { return m_tree; }
    const std::vector<ThinPart>& parts() const { return m_parts; }

private:
    TriangleTree m_tree;
    std::vector<ThinPart> m_parts;
};

/// A cube [m_place, m_place + 1] / 2^m_level in lattice units that requires tets of a generation.
struct WantedCell
{
    std::array<int, 3> m_place = {};
    int m_level = 0, m_generation = 0;
};

struct WantedCells
{
    std::size_t m_max = 0;            ///< maximum number of cells, beyond which counting stops
    std::vector<WantedCell> m_cells;  ///< each position once per level, in ascending order
};

/// Required cells: m_cellsAcross cells across solid parts, or as many as m_maxGenerations permits; equally many across
/// gaps, in whole levels, or none where that is not permitted. Returns false if there are far more than m_max.
bool findWantedCells(const CageLattice& lattice, const std::vector<ThinPart>& parts, const Grading& grading,
                     WantedCells& wanted);

/// Bisects until every tet that meets a required cell has at least its generation. Returns false, unfinished, if there
/// are more than `most` tets.
bool grade(const std::vector<WantedCell>& wanted, std::size_t most, BisectedTets& tets);

}  // namespace bullet_fem
