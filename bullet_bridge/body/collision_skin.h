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

/// A surface that follows a body's elements, ready to be what of the body collides: each vertex once, without triangles
/// that say nothing, all turned outward. Immutable; bodies may share it.
class CollisionSkin
{
public:
    /// What was mended to make it.
    struct Mended
    {
        int m_welded = 0;      ///< vertices at the place of another
        int m_degenerate = 0;  ///< triangles without area, left out
        int m_duplicates = 0;  ///< triangles that were there already, left out
        int m_turned = 0;      ///< triangles that were turned over, with those of pieces that were inside out
        int m_openEdges = 0;   ///< of one triangle
        int m_crossings = 0;   ///< edges of more than two triangles
    };

    /// A surface of these vertices. Nodes and corners must be in range, weights finite. Throws std::invalid_argument if
    /// no triangle has an area at rest.
    CollisionSkin(const TetMesh& mesh, const std::vector<SkinVertex>& vertices, std::vector<Triangle> triangles);

    /// At rest: vertices that triangles have, in the order in which they were given.
    const RestSurface& rest() const { return m_rest; }
    const Mended& mended() const { return m_mended; }

    /// The nodes that vertices depend on, ascending.
    const std::vector<int>& nodes() const { return m_nodes; }

    /// The vertex that was given of one that is used here.
    int given(int vertex) const { return m_given[vertex]; }

    /// What the vertices have, from what the nodes have. Allocates if `vertexValues` is of another size.
    void follow(const std::vector<Vec3>& nodeValues, std::vector<Vec3>& vertexValues) const;

    /// The point of a triangle of vertices (an edge has its second corner, a vertex its first once more) as a sum of
    /// nodes, each once.
    SurfacePoint pointOf(int body, const Triangle& vertices, const std::array<double, 3>& weights) const;

private:
    void takeVertices(const std::vector<SkinVertex>& vertices, const std::vector<int>& welded);
    void turnOutward();
    void countEdges();
    void measure(const TetMesh& mesh);

    RestSurface m_rest;
    std::vector<SkinVertex> m_vertices;
    std::vector<int> m_nodes, m_given;
    Mended m_mended;
};

/// The skin of m_renderNodes and m_renderFaces. Throws std::invalid_argument naming the vertex or face, the value and
/// the remedy: there are none; a vertex that does not follow four nodes of the body, or lies beyond its tetrahedron by
/// more than 1 %; a face whose corner is none of m_renderNodes; no face has an area.
std::shared_ptr<const CollisionSkin> skinOf(const btSoftBody& body, const TetMesh& mesh);

}  // namespace bullet_fem
