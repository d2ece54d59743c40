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

/// A lattice tet kept in the cage.
struct FilledTet
{
    int m_cube = 0, m_tet = 0;
    double m_fraction = 0;  ///< filled fraction [-], in [0, 1]; exactly 1 without contact to the surface
};

/// The kept tets of a lattice and their filled fractions.
struct CageFill
{
    std::vector<FilledTet> m_tets;     ///< every tet with a sample inside or entered by a triangle, by cube, then tet
    std::vector<std::uint8_t> m_kept;  ///< per cube: a bit for each of its tets in m_tets; empty if graded
    double m_insideVolume = 0;         ///< in lattice units
    double m_sampleCount = 0;          ///< number of evaluated winding numbers
    bool m_insideOut = false;          ///< most of the inside has a negative winding number
    bool m_selfIntersecting = false;   ///< magnitudes above 3/2, or both signs
};

/// Derives the surface's properties from the sampled winding numbers.
void report(const FillTally& tally, CageFill& fill);

/// Fills a marked lattice. The winding number's origin is the centre of the lattice, in metres; `closed`: the winding
/// number is constant away from the triangles. Throws std::invalid_argument if more than m_maxTets tets would be kept,
/// before they are stored.
CageFill fillCage(const CageLattice& lattice, const SurfaceWinding& winding, bool closed, const CageSettings& settings);

/// A cage's elements before and after nodes moved.
struct MovedTets
{
    const TetMesh& m_before;
    const TetMesh& m_after;
    Vec3 m_centre;  ///< origin of the winding number [m]
};

/// Measures the filled fractions of the moved elements again.
void refill(const MovedTets& tets, const SurfaceWinding& winding, const CageSettings& settings, CageFill& fill);

/// Approximate number of elements that fillCage keeps: exact if the surface is closed and no vertex needs another
/// element. Stops counting beyond twice m_targetTets.
double countTets(const CageLattice& lattice, const SurfaceWinding& winding, bool closed, const CageSettings& settings);

}  // namespace bullet_fem
