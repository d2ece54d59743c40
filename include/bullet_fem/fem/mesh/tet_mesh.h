// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <vector>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

using Tet = std::array<int, 4>;       ///< node indices; positive orientation: (X1-X0) x (X2-X0) . (X3-X0) > 0
using Triangle = std::array<int, 3>;  ///< node indices, counter-clockwise seen from outside

/// What becomes of nodes that no element uses.
enum class LooseNodes
{
    refused,  ///< the mesh is not made
    kept      ///< each is a piece of its own, without mass from a density; bodies must have it fixed
};

/// A checked tetrahedral mesh in its rest shape. Immutable.
class BULLETFEM_API TetMesh
{
public:
    TetMesh() = default;

    /// Takes n rest positions [m] and the elements. Elements of negative orientation are turned (last two nodes
    /// swapped) and counted. Throws std::invalid_argument, naming element and node, on: no element; an index out of [0,
    /// n); a node twice in an element; a degenerate element (volume below 1e-9 of its longest edge cubed); a position
    /// that is not finite; a node in no element, unless
    /// these are kept; a face shared by more than two elements.
    TetMesh(std::vector<Vec3> restPositions, std::vector<Tet> tets, LooseNodes loose = LooseNodes::refused);

    /// The mesh that another one was, loose nodes kept, without the search for its surface, which takes most of the
    /// time: `sides` are the other's boundarySides(). Throws std::invalid_argument as the constructor does, and on
    /// elements of negative orientation or sides that no element has; whether the sides are the right ones is not
    /// looked at.
    static TetMesh withSides(std::vector<Vec3> restPositions, std::vector<Tet> tets,
                             const std::vector<unsigned char>& sides);

    /// Which sides of every element are on the surface: bit a is the one opposite its node a.
    std::vector<unsigned char> boundarySides() const;

    const std::vector<Vec3>& restPositions() const { return m_restPositions; }  ///< X [m], n entries
    /// Nodes of every element, of positive orientation.
    const std::vector<Tet>& tets() const { return m_tets; }
    const std::vector<Triangle>& surface() const { return m_surface; }         ///< boundary triangles, oriented outward
    const std::vector<int>& surfaceNodes() const { return m_surfaceNodes; }    ///< nodes of the surface, ascending
    const std::vector<int>& nodeComponent() const { return m_nodeComponent; }  ///< connected piece of every node
    /// Nodes, loose ones included.
    int nodeCount() const { return static_cast<int>(m_restPositions.size()); }
    /// Elements, >= 1.
    int tetCount() const { return static_cast<int>(m_tets.size()); }
    int componentCount() const { return m_componentCount; }  ///< connected pieces (through shared nodes)
    int looseCount() const { return m_looseCount; }          ///< nodes that no element uses
    /// True if no element uses the node; `node` in [0, nodeCount()).
    bool isLoose(int node) const { return m_looseCount > 0 && m_loose[static_cast<std::size_t>(node)]; }
    int turnedCount() const { return m_turnedCount; }  ///< elements whose orientation was mended
    int sliverCount() const
    {
        return m_sliverCount;
    }                                           ///< elements with a volume below 1e-3 of their longest edge cubed
    double tetVolume(int e) const;              ///< V_e [m3], > 0
    double volume() const { return m_volume; }  ///< sum of V_e [m3]
    double meanEdgeLength() const { return m_meanEdgeLength; }  ///< mean over the elements' edges [m]
    double shortestHeight() const { return m_shortestHeight; }  ///< of an element, from a face to its corner [m], > 0

private:
    void takeElements(std::vector<Vec3> restPositions, std::vector<Tet> tets, LooseNodes loose);
    void measure();

    std::vector<Vec3> m_restPositions;
    std::vector<Tet> m_tets;
    std::vector<Triangle> m_surface;
    std::vector<int> m_surfaceNodes;
    std::vector<int> m_nodeComponent;
    std::vector<unsigned char> m_loose;  // per node
    int m_looseCount = 0;
    int m_componentCount = 0;
    int m_turnedCount = 0;
    int m_sliverCount = 0;
    double m_meanEdgeLength = 0;
    double m_shortestHeight = 0;
    double m_volume = 0;
};

}  // namespace bullet_fem
