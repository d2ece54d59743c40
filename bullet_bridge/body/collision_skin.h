// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "bullet_bridge/geometry/surface/soft_surface.h"
#include "bullet_fem/fem/contact/contact_solver.h"

class btSoftBody;

namespace bullet_fem
{

/// A vertex as a weighted sum of four nodes.
struct SkinVertex
{
    std::array<int, 4> m_nodes;
    std::array<double, 4> m_weights;  ///< [-], sum 1; unused ones are 0
};

/// A surface that is embedded in a body's elements, prepared for collision: unique vertices, no degenerate or duplicate
/// triangles, outward orientation. Immutable; bodies may share it.
class CollisionSkin
{
public:
    /// Counts of the repairs.
    struct Mended
    {
        int m_welded = 0;      ///< vertices merged with another at an equal position
        int m_degenerate = 0;  ///< removed triangles without area
        int m_duplicates = 0;  ///< removed triangles with the vertices of another
        int m_turned = 0;      ///< reoriented triangles, those of inverted components included
        int m_openEdges = 0;   ///< edges of one triangle
        int m_crossings = 0;   ///< edges of more than two triangles
    };

    /// Builds the surface. Nodes and corners must be in range, weights finite. Throws std::invalid_argument if no
    /// triangle has an area at rest.
    CollisionSkin(const TetMesh& mesh, const std::vector<SkinVertex>& vertices, std::vector<Triangle> triangles);

    /// The rest shape, with the vertices that triangles use, in their given order.
    const RestSurface& rest() const { return m_rest; }

    /// Counts of the repairs by the constructor.
    const Mended& mended() const { return m_mended; }

    /// The nodes that vertices depend on, ascending.
    const std::vector<int>& nodes() const { return m_nodes; }

    /// The index in the given vertices of a vertex of rest().
    int given(int vertex) const { return m_given[vertex]; }

    /// Interpolates nodal values to the vertices. Allocates if the size of `vertexValues` changes.
    void follow(const std::vector<Vec3>& nodeValues, std::vector<Vec3>& vertexValues) const;

    /// A point of a triangle as a weighted sum of unique nodes. `vertices`: an edge repeats its second corner, a vertex
    /// its first.
    SurfacePoint pointOf(int body, const Triangle& vertices, const std::array<double, 3>& weights) const;

private:
    void takeVertices(const std::vector<SkinVertex>& vertices, const std::vector<int>& welded);
    void turnOutward();
    void countEdges(const SurfaceTopology& topology);
    void measure(const SurfaceTopology& topology, const TetMesh& mesh);

    RestSurface m_rest;
    std::vector<SkinVertex> m_vertices;
    std::vector<int> m_nodes, m_given;
    Mended m_mended;
};

/// The skin from m_renderNodes and m_renderFaces. Throws std::invalid_argument with the vertex or face, the value and
/// the remedy if there are none, if a vertex does not depend on four nodes of the body or is outside of its tetrahedron
/// by more than 1 %, if a corner of a face is not in m_renderNodes, or if no face has an area.
std::shared_ptr<const CollisionSkin> skinOf(const btSoftBody& body, const TetMesh& mesh);

}  // namespace bullet_fem
