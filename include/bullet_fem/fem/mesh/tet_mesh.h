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

/// Treatment of nodes that belong to no element.
enum class LooseNodes
{
    refused,  ///< the constructor throws
    kept      ///< each is a connected component of its own, without mass from a density; bodies must fix it
};

/// A checked tetrahedral mesh in its rest shape. Immutable.
class BULLETFEM_API TetMesh
{
public:
    TetMesh() = default;

    /// Takes n rest positions [m] and the elements. Elements of negative orientation are reversed (last two nodes
    /// swapped) and counted. Throws std::invalid_argument, naming element and node, on: no element; an index outside
    /// [0, n); a repeated node in an element; a degenerate element (volume below 1e-9 of its longest edge cubed); a
    /// position that is not finite; a node in no element, unless these are kept; two elements with equal nodes; a face
    /// shared by more than two elements. Allocates.
    TetMesh(std::vector<Vec3> restPositions, std::vector<Tet> tets, LooseNodes loose = LooseNodes::refused);

    /// Rebuilds a mesh from its positions, elements and boundarySides(), keeping loose nodes, without the search for
    /// its surface, which takes most of the constructor's time. Throws std::invalid_argument as the constructor does,
    /// and on elements of negative orientation or on side bits that no element has. Whether the sides are the right
    /// ones is not checked.
    static TetMesh withSides(std::vector<Vec3> restPositions, std::vector<Tet> tets,
                             const std::vector<unsigned char>& sides);

    /// Boundary sides, one mask per element: bit a is set if the face opposite its node a is on the surface. Allocates.
    std::vector<unsigned char> boundarySides() const;

    const std::vector<Vec3>& restPositions() const { return m_restPositions; }  ///< X [m], n entries
    /// Node indices of every element, of positive orientation.
    const std::vector<Tet>& tets() const { return m_tets; }
    const std::vector<Triangle>& surface() const { return m_surface; }         ///< boundary triangles, oriented outward
    const std::vector<int>& surfaceNodes() const { return m_surfaceNodes; }    ///< nodes of the surface, ascending
    const std::vector<int>& nodeComponent() const { return m_nodeComponent; }  ///< connected component of each node
    /// Number of nodes, loose ones included.
    int nodeCount() const { return static_cast<int>(m_restPositions.size()); }
    /// Number of elements, >= 1.
    int tetCount() const { return static_cast<int>(m_tets.size()); }
    int componentCount() const { return m_componentCount; }  ///< connected components (through shared nodes)
    int looseCount() const { return m_looseCount; }          ///< number of nodes that belong to no element
    /// True if no element uses `node`, in [0, nodeCount()).
    bool isLoose(int node) const { return m_looseCount > 0 && m_loose[static_cast<std::size_t>(node)]; }
    int turnedCount() const { return m_turnedCount; }  ///< number of reversed elements
    /// Number of elements with a volume below 1e-3 of their longest edge cubed.
    int sliverCount() const { return m_sliverCount; }
    double tetVolume(int e) const;                              ///< V_e [m3], > 0
    double volume() const { return m_volume; }                  ///< sum of V_e [m3]
    double meanEdgeLength() const { return m_meanEdgeLength; }  ///< mean over the elements' edges [m]
    /// Minimum distance from a face to the opposite corner over all elements [m], > 0.
    double shortestHeight() const { return m_shortestHeight; }

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
