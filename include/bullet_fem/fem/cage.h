// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <vector>

#include "bullet_fem/fem/surface_mesh.h"
#include "bullet_fem/fem/tet_mesh.h"

namespace bullet_fem
{

/// How a cage is filled.
struct CageSettings
{
    double m_cellSize = 0;   ///< edge of a lattice cube [m], > 0
    int m_maxTets = 200000;  ///< refuse beyond this many elements, in [5, 5e6]
    /// Least filled fraction that an element's mass and stiffness are scaled by, in (0, 1]. Contact is on the cage's
    /// boundary, where emptier elements are softer; below about .2 they turn inside out under a hard landing.
    double m_fillFloor = 0.25;
    int m_fillSamples = 64;  ///< points an element's filled fraction is measured with, in [8, 4096]
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
    /// The solid's volume [m3], > 0. Exact, by the divergence theorem, for a closed surface in which no overlap was
    /// found; else the volume of the samples with a winding number of magnitude 1/2 or more, overlaps once.
    double m_surfaceVolume = 0;
    double m_massScale = 1;           ///< [-]: sum over e of m_massScale m_filled[e] V_e is m_surfaceVolume
    bool m_insideOut = false;         ///< most of the inside has triangles oriented inward (accepted)
    bool m_selfIntersecting = false;  ///< samples with winding numbers above 3/2 or of both signs were found
    int m_openEdges = 0;              ///< edges whose triangles do not cancel: one alone, or two oriented alike; the
                                      ///< generalised winding number closes over them. 0: closed
};

/// Fills a lattice of alternating five-tet cubes, centred on the surface's bounding box, keeps every element that holds
/// a sample inside, that a triangle enters or that a vertex needs, measures how much of each is filled, and embeds the
/// surface's vertices. The inside is where the generalised winding number [Jacobson et al. 2013] has magnitude at least
/// 1/2, so self-intersecting, inside-out and slightly open surfaces have one. The same bits on every call.
/// Throws std::invalid_argument naming value, range and remedy: settings out of range; no triangles, indices out of
/// range, vertices that are not finite, a surface below 1e-7 of its distance from the origin; one oriented at random
/// (at more than 1/10 of the edges); a surface without inside (flat, wide open: |vector area| above 9/10 of the area,
/// or volume below 1e-7 of area times length); a cell size that is longer than the surface, needs more than min(20
/// m_maxTets, 2e7) cubes for the bounding box, or gives more than m_maxTets elements.
Cage makeCage(const SurfaceMesh& surface, const CageSettings& settings);

}  // namespace bullet_fem
