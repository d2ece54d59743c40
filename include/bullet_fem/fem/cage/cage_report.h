// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <string>
#include <vector>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// Mean ratio of a tet [-], 12 (3 V)^(2/3) over the sum of its squared edges [Liu & Joe 1994, eq. 11]: 1 for the
/// regular tet, 0 for a flat one, negative for an inverted one. Corners in the order of positive orientation.
BULLETFEM_API double meanRatio(const std::array<Vec3, 4>& corners);

/// Statistics of a cage and of its surface.
struct CageReport
{
    int m_tets = 0;             ///< elements
    int m_nodes = 0;            ///< nodes
    double m_cellSize = 0;      ///< edge of a lattice cube [m]
    double m_smallestCell = 0;  ///< smallest element: edge of a cube of six times its volume [m]
    double m_largestCell = 0;   ///< largest element [m]; both equal m_cellSize in ungraded cages
    /// Target number of cells across thin parts; below m_cellsAcross of the settings if m_targetTets is low.
    double m_cellsAcross = 0;
    int m_levels = 0;                          ///< halvings of m_cellSize in the smallest cell, rounded up
    std::array<int, 7> m_levelTets{};          ///< number of elements by halvings
    std::array<int, 10> m_qualityHistogram{};  ///< number of elements by mean ratio: [0, .1), [.1, .2), ... [.9, 1]
    double m_leastQuality = 0;                 ///< minimum mean ratio of an element
    double m_qualityBound = 0;                 ///< lower bound of the mean ratio for any cage with these settings
    /// The solid's volume [m3], > 0; its product with the density is the mass. Exact, by the divergence theorem, for a
    /// closed surface without detected overlap; else the volume of the samples whose winding number has magnitude 1/2
    /// or more, which counts overlaps once.
    double m_surfaceVolume = 0;
    bool m_volumeIsExact = false;     ///< whether m_surfaceVolume is the exact one
    double m_volumeRatio = 0;         ///< the cage's volume over the solid's [-]
    double m_latticeVolumeRatio = 0;  ///< m_volumeRatio before boundary nodes were snapped [-]

    int m_pieces = 0;                 ///< connected components of the surface (through edges or vertices)
    bool m_insideOut = false;         ///< most of the inside has triangles oriented inward (accepted)
    bool m_selfIntersecting = false;  ///< samples with winding numbers above 3/2 or of both signs were found (accepted)
    int m_openEdges = 0;     ///< edges whose triangles do not cancel: a single one, or two of equal orientation; the
                             ///< generalised winding number closes them. 0: closed surface
    double m_openShare = 0;  ///< m_openEdges over the number of edges [-], in [0, 1]
    int m_duplicates = 0;    ///< duplicate triangles (dropped)
    int m_degenerate = 0;    ///< triangles of zero area (without effect)
    int m_turned = 0;        ///< triangles oriented against their neighbours (reversed)

    /// Region label of each element (paintedRegions()); empty without labels.
    std::vector<int> m_regions;
};

/// The report as readable lines of text. Allocates.
BULLETFEM_API std::string describe(const CageReport& report);

}  // namespace bullet_fem
