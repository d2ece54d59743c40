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
    /// Builds the surface. Nodes and corners must be in range, weights finite. Throws std::invalid_argument if no
    /// triangle has an area at rest.
    CollisionSkin(const TetMesh& mesh, const std::vector<SkinVertex>& vertices, std::vector<Triangle> triangles);

    /// The rest shape, with the vertices that triangles use, in their given order.
    const RestSurface& rest() const { return m_rest; }

    /// The nodes that vertices depend on, ascending.
    const std::vector<int>& nodes() const { return m_nodes; }

    /// Interpolates nodal values to the vertices. Allocates if the size of `vertexValues` changes.
    void follow(const std::vector<Vec3>& nodeValues, std::vector<Vec3>& vertexValues) const;

    /// A point of a triangle as a weighted sum of unique nodes. `vertices`: an edge repeats its second corner, a vertex
    /// its first.
    SurfacePoint pointOf(int body, const Triangle& vertices, const std::array<double, 3>& weights) const;

private:
    void takeVertices(const std::vector<SkinVertex>& vertices);
    void turnOutward();
    void measure(const TetMesh& mesh);

    RestSurface m_rest;
    std::vector<SkinVertex> m_vertices;
    std::vector<int> m_nodes;
};

/// The skin from m_renderNodes and m_renderFaces. Throws std::invalid_argument with the vertex or face, the value and
/// the remedy if there are none, if a vertex does not depend on four nodes of the body or is outside of its tetrahedron
/// by more than 1 %, if a corner of a face is not in m_renderNodes, or if no face has an area.
std::shared_ptr<const CollisionSkin> skinOf(const btSoftBody& body, const TetMesh& mesh);

}  // namespace bullet_fem
