// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

/// A tet that can be bisected at the midpoint of the edge from corner 0 to corner 3 - generation mod 3 [Maubach 1995].
struct BisectedTet
{
    Tet m_corners;                  ///< in the order that determines the bisected edge, of either orientation
    int m_child = 0;                ///< the first of its two children, which are consecutive; 0: a leaf
    std::uint8_t m_generation = 0;  ///< bisections since its cube was split into six
    bool m_whole = false;           ///< known to be inside entirely
};

/// Cubes of a lattice, each split into six tets around the diagonal from its corner with even coordinates to the one
/// with odd coordinates [Tucker 1945], and bisected on demand and wherever a hanging node would arise. Tets always have
/// three shapes up to scale, and after three bisections they are those of a lattice of half the size: mean ratios
/// .7559, .7619 and .7999.
class BisectedTets
{
public:
    explicit BisectedTets(const std::array<int, 3>& cubes) : m_cubes(cubes) {}

    /// Adds the six tets of a cube. Cubes must come in ascending order (x fastest), before any bisection.
    void addCube(int cube, bool whole);

    /// Number of the cubes' tets, which come first.
    int rootCount() const { return 6 * static_cast<int>(m_added.size()); }

    /// The first of the six consecutive tets of a cube; -1 if the cube was not added.
    int firstOf(const std::array<int, 3>& place) const;

    /// Bisects the marked leaves, then those with a bisected edge until there are none. `marks` has one entry per tet
    /// (0: not marked) and is resized to one zero a tet. Returns false, unfinished, if there are more than `most` tets.
    bool halve(std::vector<char>& marks, std::size_t most);

    const std::vector<BisectedTet>& tets() const { return m_tets; }  ///< all generations
    const std::vector<Vec3>& nodes() const { return m_nodes; }       ///< in lattice units
    std::array<Vec3, 4> corners(int tet) const;                      ///< positively oriented corners, in lattice units
    Tet orientedTet(int tet) const;                                  ///< positively oriented node indices
    double volume(int tet) const;                                    ///< in lattice units

private:
    int nodeAt(const std::array<int, 3>& place);
    int middleOf(int a, int b);
    bool hasHalvedEdge(const BisectedTet& tet) const;
    void halve(int tet);

    std::array<int, 3> m_cubes;
    std::vector<BisectedTet> m_tets;
    std::vector<Vec3> m_nodes;
    std::vector<int> m_added;                          // added cubes, ascending
    std::unordered_map<std::uint64_t, int> m_places;   // nodes of the lattice by position
    std::unordered_map<std::uint64_t, int> m_middles;  // midpoint nodes by the end nodes of their edge
    std::vector<char> m_atHalved;                      // per node: 1 if it is an end of a bisected edge
};

}  // namespace bullet_fem
