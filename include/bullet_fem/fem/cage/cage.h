// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <vector>

#include "bullet_fem/fem/cage/cage_report.h"
#include "bullet_fem/fem/cage/surface_mesh.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"

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
};

/// A vertex of the surface as a fixed affine combination of four cage nodes.
struct Embedding
{
    int m_tet = 0;                         ///< element that holds the vertex; 0 for a vertex in no triangle
    std::array<double, 4> m_weights = {};  ///< barycentric weights [-] in the order of the element's nodes, sum 1,
                                           ///< at least -1e-6 but for vertices in no triangle
};

/// A tetrahedral mesh that encloses a surface, with what the surface is to the elements.
struct Cage
{
    TetMesh m_mesh;
    std::vector<double> m_filled;        ///< per element: filled fraction [-], in [floor, 1]; scales mass and stiffness
    std::vector<Embedding> m_embedding;  ///< per surface vertex
    bool m_surfaceCollides = false;      ///< as CageSettings asked
    double m_massScale = 1;              ///< [-]: sum over e of m_massScale m_filled[e] V_e is m_report.m_surfaceVolume
    CageReport m_report;
};

/// Fills a lattice of alternating five-tet cubes, centred on the surface's bounding box, keeps every element that holds
/// a sample inside, that a triangle enters or that a vertex needs, measures how much of each is filled, and embeds the
/// surface's vertices. The inside is where the generalised winding number [Jacobson et al. 2013] has magnitude at least
/// 1/2, so self-intersecting, inside-out and slightly open surfaces have one. Triangles that are given twice are left
/// out, those that turn against their neighbours turned over; the report tells. The cage encloses the whole surface,
/// its triangles as well as its vertices, and does not overlap itself; the mean ratio of every element is at least
/// .8399, with m_cellsAcross .7559, or .3 with m_snap. With m_cellsAcross cubes are split into six tets, which are
/// bisected [Maubach 1995] until opposite sides of the surface have that many cells between them. The same bits on
/// every call. Throws std::invalid_argument naming value, range and remedy: settings out of range; no triangles,
/// indices out of range, vertices that are not finite, a surface below 1e-7 of its distance from the origin; one whose
/// triangles still disagree at more than 1/10 of the edges, because more than two meet there; a surface without inside
/// (flat, wide open: |vector area| above 9/10 of the area, or volume below 1e-7 of area times length); a cell size that
/// is longer than the surface, needs more than min(20 m_maxTets, 2e7) cubes for the bounding box, or gives more than
/// m_maxTets elements.
Cage makeCage(const SurfaceMesh& surface, const CageSettings& settings);

}  // namespace bullet_fem
