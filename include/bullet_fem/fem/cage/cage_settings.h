// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>

#include "bullet_fem/fem/cage/cage_progress.h"

namespace bullet_fem
{

/// How a cage is made. Give a cell size or a number of elements, not both.
struct CageSettings
{
    double m_cellSize = 0;  ///< edge of a lattice cube [m], > 0; 0: as m_targetTets asks
    /// Elements wanted, in [5, m_maxTets]; 0: as m_cellSize says. The lattice does not give every number: within 20 %
    /// from some hundred elements on, and else the nearest that was found.
    int m_targetTets = 0;
    /// Share of the way that boundary nodes move toward the nearest point of the surface, in [0, 1]; 0: none. They stop
    /// where an element would fall below a mean ratio of .3, or the surface would no longer be inside.
    double m_snap = 0;
    /// Cells that thin parts are to have across, in [0.5, 8], 2 is usual; 0: cells are alike. Cells stay m_cellSize
    /// long where the surface's other side is farther away than that many; elsewhere they are halved as often as it
    /// takes, and in narrow gaps, too, so that their sides come apart.
    double m_cellsAcross = 0;
    int m_mostLevels = 3;    ///< most halvings of a cell's edge where cells are graded, in [1, 6]
    int m_maxTets = 200000;  ///< refuse beyond this many elements, in [5, 5e6]
    /// Least filled fraction that an element's mass and stiffness are scaled by, in (0, 1]. Contact is on the cage's
    /// boundary, where emptier elements are softer; below about .2 they turn inside out under a hard landing.
    double m_fillFloor = 0.25;
    int m_fillSamples = 64;  ///< points an element's filled fraction is measured with, in [8, 4096]
    /// What collides: the surface, not the boundary of the cage, which stands up to a cell outside it. For the bodies
    /// that are made of the cage; the cage itself is the same.
    bool m_surfaceCollides = false;
    CageProgress m_progress = {};  ///< is told how far it is, and may give up; empty: nobody is
};

/// A vertex of the surface as a fixed affine combination of four cage nodes.
struct Embedding
{
    int m_tet = 0;                         ///< element that holds the vertex; 0 for a vertex in no triangle
    std::array<double, 4> m_weights = {};  ///< barycentric weights [-] in the order of the element's nodes, sum 1,
                                           ///< at least -1e-6 but for vertices in no triangle
};

}  // namespace bullet_fem
