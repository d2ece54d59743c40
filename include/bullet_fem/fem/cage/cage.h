// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/cage/cage_report.h"
#include "bullet_fem/fem/cage/cage_settings.h"
#include "bullet_fem/fem/cage/surface_mesh.h"
#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

/// A tetrahedral mesh that encloses a surface, with what the surface is to the elements.
struct Cage
{
    /// The tetrahedra.
    TetMesh m_mesh;
    std::vector<double> m_filled;        ///< per element: filled fraction [-], in [floor, 1]; scales mass and stiffness
    std::vector<Embedding> m_embedding;  ///< per surface vertex
    bool m_surfaceCollides = false;      ///< as CageSettings asked
    double m_massScale = 1;              ///< [-]: sum over e of m_massScale m_filled[e] V_e is m_report.m_surfaceVolume
    /// What it is like.
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
/// m_maxTets elements. Throws CageCancelled if m_progress gives up.
BULLETFEM_API Cage makeCage(const SurfaceMesh& surface, const CageSettings& settings);

}  // namespace bullet_fem
