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

/// Mean ratio of a tet: 12 (3 V)^(2/3) over the sum of its squared edges [Liu and Joe 1994, eq. 11]. 1 for the regular
/// tet, 0 for a flat one, negative for an inverted one. Corners in the order of positive orientation.
BULLETFEM_API double meanRatio(const std::array<Vec3, 4>& corners);

/// What a cage is like, and what its surface was like.
struct CageReport
{
    int m_tets = 0;                            ///< elements
    int m_nodes = 0;                           ///< nodes
    double m_cellSize = 0;                     ///< edge of a lattice cube [m]
    double m_smallestCell = 0;                 ///< of an element: edge of a cube of six times its volume [m], or
    double m_largestCell = 0;                  ///< m_cellSize where cells are not graded
    double m_cellsAcross = 0;                  ///< wanted across thin parts; less than asked for if m_targetTets is low
    int m_levels = 0;                          ///< halvings of m_cellSize, rounded up, in the smallest cell
    std::array<int, 7> m_levelTets{};          ///< elements by such halvings
    std::array<int, 10> m_qualityHistogram{};  ///< elements by mean ratio: [0, .1), [.1, .2), ... [.9, 1]
    double m_leastQuality = 0;                 ///< least mean ratio of an element
    double m_qualityBound = 0;                 ///< what no element of any cage with these settings is below
    /// The solid's volume [m3], > 0; times the density it is the mass. Exact, by the divergence theorem, for a closed
    /// surface in which no overlap was found; else the volume of the samples with a winding number of magnitude 1/2 or
    /// more, overlaps once.
    double m_surfaceVolume = 0;
    bool m_volumeIsExact = false;     ///< which of the two it is
    double m_volumeRatio = 0;         ///< the cage's volume over the solid's [-]
    double m_latticeVolumeRatio = 0;  ///< the same before boundary nodes were snapped

    int m_pieces = 0;                 ///< parts of the surface that neither an edge nor a vertex joins
    bool m_insideOut = false;         ///< most of the inside has triangles oriented inward (accepted)
    bool m_selfIntersecting = false;  ///< samples with winding numbers above 3/2 or of both signs were found (accepted)
    int m_openEdges = 0;              ///< edges whose triangles do not cancel: one alone, or two oriented alike; the
                                      ///< generalised winding number closes over them. 0: closed
    double m_openShare = 0;           ///< of all edges, in [0, 1]
    int m_duplicates = 0;             ///< triangles given twice (left out)
    int m_degenerate = 0;             ///< triangles without area (they count nothing)
    int m_turned = 0;                 ///< triangles that turned against their neighbours (turned over)

    std::vector<int>
        m_regions;  ///< per element, the label of its region: see paintedRegions(); empty if none is painted
};

/// The report in lines of text, for people.
BULLETFEM_API std::string describe(const CageReport& report);

}  // namespace bullet_fem
