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

/// A tetrahedral mesh that encloses a surface, with the embedding of the surface in it.
struct Cage
{
    /// The tetrahedra.
    TetMesh m_mesh;
    std::vector<double> m_filled;        ///< per element: filled fraction [-], in [floor, 1]; scales mass and stiffness
    std::vector<Embedding> m_embedding;  ///< per surface vertex
    bool m_surfaceCollides = false;      ///< copied from CageSettings
    /// Factor on masses [-]: sum over e of m_massScale m_filled[e] V_e = m_report.m_surfaceVolume.
    double m_massScale = 1;
    /// Statistics of the cage and its surface.
    CageReport m_report;
};

/// Makes a cage. Fills a lattice of alternating five-tet cubes, centred on the surface's bounding box; keeps every
/// element that contains an interior sample, intersects a triangle or is needed to embed a vertex; measures the filled
/// fraction of each, and embeds the surface's vertices. A point is inside if its generalised winding number [Jacobson
/// et al. 2013] has magnitude at least 1/2, so self-intersecting, inside-out and slightly open surfaces have an inside.
/// Duplicate triangles are dropped and triangles oriented against their neighbours are reversed; the report counts
/// both. The cage encloses the whole surface, triangles as well as vertices, and does not overlap itself. The mean
/// ratio of every element is at least .8399; with m_cellsAcross .7559; with m_snap .3. With m_cellsAcross cubes are
/// split into six tets, which are bisected [Maubach 1995] until opposite sides of the surface have that many cells
/// between them. Deterministic. Allocates. Throws std::invalid_argument naming value, range and remedy: settings out of
/// range; no triangles, indices out of range, vertices that are not finite, a surface smaller than 1e-7 of its distance
/// from the origin; triangles that still disagree at more than 1/10 of the edges, because more than two meet there; a
/// surface without inside (flat, wide open: |vector area| above 9/10 of the area, or volume below 1e-7 of area times
/// length); a cell size that is longer than the surface, needs more than min(20 m_maxTets, 2e7) cubes for the bounding
/// box, or gives more than m_maxTets elements. Throws CageCancelled if m_progress returns false.
BULLETFEM_API Cage makeCage(const SurfaceMesh& surface, const CageSettings& settings);

}  // namespace bullet_fem
