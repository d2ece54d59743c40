// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>

#include "bullet_fem/fem/cage/cage_progress.h"

namespace bullet_fem
{

/// Options of makeCage(). Give a cell size or a number of elements, not both.
struct CageSettings
{
    double m_cellSize = 0;  ///< edge of a lattice cube [m], > 0; 0: chosen from m_targetTets
    /// Number of elements aimed at, in [5, m_maxTets]; 0: given by m_cellSize. Not every number is possible: the result
    /// is within 20 % from some hundred elements on, and else the nearest number found.
    int m_targetTets = 0;
    /// Snapping: share of the way that boundary nodes move to the nearest point of the surface [-], in [0, 1]; 0: none.
    /// A node stops where an element would fall below a mean ratio of .3, or the surface would leave the cage.
    double m_snap = 0;
    /// Grading: number of cells across thin parts, in [0.5, 8], 2 is usual; 0: uniform cells. Cells keep the edge
    /// m_cellSize where the opposite side of the surface is farther away than this many cells; elsewhere, and in narrow
    /// gaps whose sides must separate, they are halved as often as necessary.
    double m_cellsAcross = 0;
    int m_mostLevels = 3;    ///< maximum number of halvings of a graded cell's edge, in [1, 6]
    int m_maxTets = 200000;  ///< maximum number of elements, in [5, 5e6]; larger cages are refused
    /// Minimum filled fraction for scaling an element's mass and stiffness [-], in (0, 1]. Contact acts on the cage's
    /// boundary, where partly filled elements are softer; with a floor below about .2 they invert in a hard landing.
    double m_fillFloor = 0.25;
    int m_fillSamples = 64;  ///< sample points per element for its filled fraction, in [8, 4096]
    /// Collision surface of bodies made of the cage: the embedded surface, or the cage's boundary, which lies up to a
    /// cell outside it. Does not change the cage itself.
    bool m_surfaceCollides = false;
    CageProgress m_progress = {};  ///< progress callback, which may cancel; empty: none
};

/// A vertex of the surface as a fixed affine combination of four cage nodes.
struct Embedding
{
    int m_tet = 0;                         ///< element that holds the vertex; 0 for a vertex in no triangle
    std::array<double, 4> m_weights = {};  ///< barycentric weights [-] in the order of the element's nodes; sum 1, each
                                           ///< at least -1e-6 for a vertex of a triangle
};

}  // namespace bullet_fem
