// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/cage/bisected_tets.h"
#include "fem/cage/cage_lattice.h"
#include "fem/cage/thin_parts.h"
#include "fem/cage/winding_near.h"

namespace bullet_fem
{

/// How far cells are halved.
struct Grading
{
    double m_cellsAcross = 0;   ///< [-], > 0
    int m_mostGenerations = 0;  ///< halvings of a tet, three a level

    static Grading of(const CageSettings& settings) { return {settings.m_cellsAcross, 3 * settings.m_mostLevels}; }
};

/// A surface about the centre of its bounding box, and where it is thin, for cells up to a size.
class GradedSurface
{
public:
    /// Looks for parts that are thin for cells of that size [m], or shorter ones, with m_cellsAcross and m_mostLevels.
    GradedSurface(const SurfaceInspection& surface, const SurfaceWinding& winding, const CageSettings& settings,
                  double cellSize);

    const TriangleTree& tree() const { return m_tree; }
    const std::vector<ThinPart>& parts() const { return m_parts; }

private:
    TriangleTree m_tree;
    std::vector<ThinPart> m_parts;
};

/// A cube [m_place, m_place + 1] / 2^m_level in lattice units that wants tets of a generation.
struct WantedCell
{
    std::array<int, 3> m_place = {};
    int m_level = 0, m_generation = 0;
};

struct WantedCells
{
    std::size_t m_most = 0;           ///< cells after which counting ends
    std::vector<WantedCell> m_cells;  ///< each place once a level, in ascending order
};

/// What the parts want: m_cellsAcross cells across solid parts, or as many as m_mostGenerations allow; as many across
/// gaps, and in whole levels, but nothing where that is not allowed. Returns false if that is far more than m_most.
bool findWantedCells(const CageLattice& lattice, const std::vector<ThinPart>& parts, const Grading& grading,
                     WantedCells& wanted);

/// Halves until no tet that meets a wanted cell is of a lower generation. Returns false, in the midst, if there are
/// more than `most` tets.
bool grade(const std::vector<WantedCell>& wanted, std::size_t most, BisectedTets& tets);

}  // namespace bullet_fem
