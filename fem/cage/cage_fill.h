// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstdint>
#include <vector>

#include "fem/cage/cage_lattice.h"
#include "fem/cage/fill_samples.h"
#include "fem/cage/winding_near.h"

namespace bullet_fem
{

/// A tet of the lattice that the cage keeps.
struct FilledTet
{
    int m_cube = 0, m_tet = 0;
    double m_fraction = 0;  ///< filled fraction [-], in [0, 1]; exactly 1 if the surface does not touch it
};

/// Which tets of a lattice hold something, and how much.
struct CageFill
{
    std::vector<FilledTet> m_tets;     ///< every tet with a sample inside or entered by a triangle, by cube, then tet
    std::vector<std::uint8_t> m_kept;  ///< per cube: a bit for each of its tets in m_tets; empty if graded
    double m_insideVolume = 0;         ///< in lattice units
    double m_sampleCount = 0;          ///< points whose winding number was looked at
    bool m_insideOut = false;          ///< most of the inside has a negative winding number
    bool m_selfIntersecting = false;   ///< magnitudes above 3/2, or both signs
};

/// What the points inside say of the surface.
void report(const FillTally& tally, CageFill& fill);

/// Fills a marked lattice. The winding number is about the centre of the lattice, in metres; `closed` says that the
/// winding number is constant away from the triangles. Throws std::invalid_argument if more than m_maxTets tets are
/// kept, before they are stored.
CageFill fillCage(const CageLattice& lattice, const SurfaceWinding& winding, bool closed, const CageSettings& settings);

/// A cage's elements before and after nodes have moved.
struct MovedTets
{
    const TetMesh& m_before;
    const TetMesh& m_after;
    Vec3 m_centre;  ///< where the winding number has its origin [m]
};

/// Measures the filled fractions of the elements that have moved.
void refill(const MovedTets& tets, const SurfaceWinding& winding, const CageSettings& settings, CageFill& fill);

/// About how many elements fillCage keeps: exactly where the surface is closed and no vertex needs another element.
/// Counting ends beyond twice m_targetTets.
double countTets(const CageLattice& lattice, const SurfaceWinding& winding, bool closed, const CageSettings& settings);

}  // namespace bullet_fem
