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

/// A tet that can be halved: by a node in the middle of the edge from corner 0 to corner 3 - generation mod 3
/// [Maubach 1995].
struct BisectedTet
{
    Tet m_corners;                  ///< in the order that says where it is halved, of either orientation
    int m_child = 0;                ///< the first of its two halves, the other follows; 0: it is a leaf
    std::uint8_t m_generation = 0;  ///< halvings since its cube was split into six
    bool m_whole = false;           ///< known to be inside as a whole
};

/// Cubes of a lattice, each split into six tets around the diagonal from its corner of even to that of odd places
/// [Tucker 1945], that are halved where asked for, and where a neighbour's new node would else hang. Whatever is asked
/// for, tets have three shapes up to their size, and after three halvings they are those of a lattice of half the size:
/// mean ratios .7559, .7619 and .7999.
class BisectedTets
{
public:
    explicit BisectedTets(const std::array<int, 3>& cubes) : m_cubes(cubes) {}

    /// Adds the six tets of a cube. Cubes must come in ascending order (x fastest), before anything is halved.
    void addCube(int cube, bool whole);

    int rootCount() const { return 6 * static_cast<int>(m_added.size()); }  ///< tets of the cubes, which come first

    /// The first of the six tets of a cube, which stand one after the other; -1 if it was not added.
    int firstOf(const std::array<int, 3>& place) const;

    /// Halves the leaves with a mark, then those with a halved edge until there are none. `marks` has one entry a tet
    /// (0: none) and is left with as many zeros as there are tets. Returns false, in the midst, if there are more than
    /// `most` tets.
    bool halve(std::vector<char>& marks, std::size_t most);

    const std::vector<BisectedTet>& tets() const { return m_tets; }  ///< all generations
    const std::vector<Vec3>& nodes() const { return m_nodes; }       ///< in lattice units
    std::array<Vec3, 4> corners(int tet) const;                      ///< positively oriented, in lattice units
    Tet orientedTet(int tet) const;                                  ///< its nodes, positively oriented
    double volume(int tet) const;                                    ///< in lattice units

private:
    int nodeAt(const std::array<int, 3>& place);
    int middleOf(int a, int b);
    bool hasHalvedEdge(const BisectedTet& tet) const;
    void halve(int tet);

    std::array<int, 3> m_cubes;
    std::vector<BisectedTet> m_tets;
    std::vector<Vec3> m_nodes;
    std::vector<int> m_added;                          // cubes, ascending
    std::unordered_map<std::uint64_t, int> m_places;   // nodes of the lattice by their place
    std::unordered_map<std::uint64_t, int> m_middles;  // nodes by the ends of the edge that they halve
    std::vector<char> m_atHalved;                      // per node: 1 if it ends a halved edge
};

}  // namespace bullet_fem
