// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bullet_fem/fem/cage/cage_settings.h"
#include "fem/cage/surface_inspection.h"

namespace bullet_fem
{

/// Range of cell sizes of a lattice [m].
struct CellSizeRange
{
    double m_min, m_max;
};

/// A lattice of cubes around a surface, each split into five tets. In lattice units a cube has edge 1.
class CageLattice
{
public:
    /// From the cell size with the maximum number of cubes for m_maxTets, to the longest side of the bounding box.
    static CellSizeRange cellSizeRange(const SurfaceInspection& surface, const CageSettings& settings);

    /// Centres the lattice on the bounding box. Throws std::invalid_argument if the cell size is out of range.
    CageLattice(const SurfaceInspection& surface, const CageSettings& settings);

    /// Determines the touched and entered tets of every cube.
    void markSurface(const SurfaceMesh& surface);

    int cubeCount() const { return m_cubes[0] * m_cubes[1] * m_cubes[2]; }
    const std::array<int, 3>& cubes() const { return m_cubes; }
    int cube(const std::array<int, 3>& ijk) const { return (ijk[2] * m_cubes[1] + ijk[1]) * m_cubes[0] + ijk[0]; }
    std::array<int, 3> place(int cube) const;
    double cellSize() const { return m_cellSize; }  ///< [m]
    /// Cell size at which the whole box has at most m_maxTets elements [m].
    double safeCellSize() const { return m_safeCellSize; }

    Vec3 toLattice(const Vec3& x) const { return (x - m_origin) * (1 / m_cellSize); }  ///< from metres
    Vec3 toWorld(const Vec3& u) const { return m_origin + u * m_cellSize; }            ///< to metres
    /// From lattice units to metres relative to the centre of the bounding box.
    Vec3 toCentred(const Vec3& u) const
    {
        return (u - Vec3{0.5 * m_cubes[0], 0.5 * m_cubes[1], 0.5 * m_cubes[2]}) * m_cellSize;
    }

    /// From metres relative to the centre of the bounding box to lattice units.
    Vec3 fromCentred(const Vec3& x) const
    {
        return x * (1 / m_cellSize) + Vec3{0.5 * m_cubes[0], 0.5 * m_cubes[1], 0.5 * m_cubes[2]};
    }
    Vec3 cubeMiddle(int cube) const;  ///< in lattice units
    /// The cubes that contain p [lattice units], or are within `near` of it.
    std::vector<int> cubesAround(const Vec3& p, double near) const;

    /// Index of node `corner` of a tet among the lattice's nodes, x fastest.
    int node(int cube, int tet, int corner) const;
    int nodeCount() const { return (m_cubes[0] + 1) * (m_cubes[1] + 1) * (m_cubes[2] + 1); }
    Vec3 nodePlace(int node) const;                        ///< in lattice units
    std::array<Vec3, 4> corners(int cube, int tet) const;  ///< in lattice units, positively oriented
    static double tetVolume(int tet) { return tet == 4 ? 1.0 / 3 : 1.0 / 6; }  ///< in lattice units

    /// Bit t is set if a triangle is in contact with tet t within rounding: it must be sampled.
    unsigned touched(int cube) const { return m_touched[cube]; }
    /// Bit t is set if a triangle enters the interior of tet t: it must be kept. A subset of touched().
    unsigned entered(int cube) const { return m_entered[cube]; }

private:
    void markTriangle(const std::array<Vec3, 3>& triangle, const std::array<int, 3>& low,
                      const std::array<int, 3>& high);

    Vec3 m_origin;
    double m_cellSize = 0;
    double m_safeCellSize = 0;
    std::array<int, 3> m_cubes = {};
    std::vector<std::uint8_t> m_touched, m_entered;  // per cube, a bit for each of its tets
};

}  // namespace bullet_fem
