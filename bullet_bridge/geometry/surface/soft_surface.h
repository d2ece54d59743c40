// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "bullet_bridge/geometry/surface/rest_neighbours.h"
#include "bullet_bridge/geometry/surface/surface_features.h"
#include "bullet_bridge/geometry/surface/surface_ridges.h"
#include "bullet_bridge/geometry/surface/surface_tree.h"
#include "bullet_fem/fem/contact/contact_solver.h"

namespace bullet_fem
{

/// A vector's direction; zero where it has none.
inline Vec3 unit(const Vec3& a)
{
    const double length = norm(a);
    return length > 0 ? (1 / length) * a : Vec3();
}

/// What the nodes have, at a point of a triangle with barycentric weights [-].
inline Vec3 interpolated(const std::vector<Vec3>& values, const Triangle& t, const std::array<double, 3>& w)
{
    return w[0] * values[t[0]] + w[1] * values[t[1]] + w[2] * values[t[2]];
}

/// That point of a mesh's surface, for the solver.
inline SurfacePoint pointOf(int body, const Triangle& nodes, const std::array<double, 3>& weights)
{
    SurfacePoint point;
    point.m_body = body;
    std::copy(nodes.begin(), nodes.end(), point.m_nodes.begin());
    std::copy(weights.begin(), weights.end(), point.m_weights.begin());
    return point;
}

/// A surface in its rest shape: what of a body collides.
struct RestSurface
{
    std::vector<Vec3> m_positions;      ///< of the vertices [m]
    std::vector<Triangle> m_triangles;  ///< outward
    std::vector<int> m_vertices;        ///< of the triangles, ascending
    double m_meanEdge = 0;              ///< that bands and margins are shares of [m]
    double m_size = 0;                  ///< cube root of the body's volume [m]
    std::vector<int> m_nearestNode;     ///< per vertex: node of the mesh; empty: the vertices are the nodes
};

/// The boundary of a mesh.
RestSurface boundaryOf(const TetMesh& mesh);

/// The surface of a deforming body as contacts between soft bodies see it: normals of faces, edges and corners, how the
/// surface is bent, and a tree over its triangles. Built at set-up; update() never allocates.
class SoftSurface
{
public:
    /// The boundary of a mesh.
    explicit SoftSurface(const TetMesh& mesh);

    /// Any surface, which may be open, or have edges of more than two triangles: both kinds of edges only touch as
    /// parts of their triangles.
    explicit SoftSurface(const RestSurface& rest);

    /// Of the nodes that are nearest to its vertices, which only contact of the surface with itself needs, and must
    /// have.
    void setRestNeighbours(std::shared_ptr<const RestNeighbours> neighbours);
    /// True if every edge has two triangles.
    bool isClosed() const { return m_closed; }
    bool hasRestNeighbours() const { return m_restNeighbours != nullptr; }

    /// Takes the positions at the start of a step of h [s] and the velocities that are expected in it: once a step.
    void update(const std::vector<Vec3>& x, const std::vector<Vec3>& v, double h);

    /// The same in two parts: place() takes them, and one of the others says where normals and bends are looked up
    /// fast. These are the same everywhere; ridges() has those alone that are near.
    void place(const std::vector<Vec3>& x, const std::vector<Vec3>& v, double h);
    void prepareAll();
    /// Near boxes that hold for the step.
    void prepareNear(const std::vector<SurfaceTree::Nearby>& boxes);
    /// True if prepareAll() was the last of them.
    bool isPrepared() const { return m_prepared; }
    /// True if it is so fine that what is near another body is much less than all of it.
    bool isFine() const { return m_triangles.size() >= kFine; }

    /// Notes where the vertices of the surface were at the last update(). Never allocates.
    void notePlace();
    void forgetPlace() { m_placeNoted = false; }
    bool isPlaceNoted() const { return m_placeNoted; }
    /// True if every vertex of the surface is within `reach` [m] of its noted place, and is expected to stay there
    /// through the step: arguments as those of update(), which need not have been called.
    bool isStill(const std::vector<Vec3>& x, const std::vector<Vec3>& v, double h, double reach) const;

    /// What notePlace() noted, one place a vertex of nodes() [m], for it to last; empty: nothing.
    std::vector<Vec3> notedPlace() const { return m_placeNoted ? m_place : std::vector<Vec3>(); }
    /// Gives it back: none, or one a vertex.
    void restorePlace(const std::vector<Vec3>& place);

    const std::vector<Triangle>& triangles() const { return m_triangles; }
    const std::vector<int>& nodes() const { return m_nodes; }  ///< vertices of the surface, ascending
    int vertexCount() const { return static_cast<int>(position().size()); }
    const SurfaceFeatures& features() const { return m_features; }
    double meanEdge() const { return m_meanEdge; }  ///< of the tetrahedra at rest, or of finer triangles [m]
    /// Largest curvature of the surface at a vertex at rest, of its edges there [1/m]; 0 where it is flat or hollow.
    double curvature(int vertex) const { return m_curvature[vertex]; }

    /// True if that is of a few facets, so that what rolls goes from corner to corner.
    bool hasFewFacets(int vertex) const { return m_fewFacets[vertex]; }
    double size() const { return m_size; }  ///< cube root of the volume at rest [m]
    const SurfaceTree& tree() const { return m_tree; }
    const SurfaceRidges& ridges() const { return m_ridges; }
    /// True if two vertices cannot touch each other however the body is bent: see RestNeighbours.
    bool areCloseAtRest(int a, int b) const { return m_restNeighbours->areClose(nodeAt(a), nodeAt(b)); }
    Vec3 middle() const;                                                      ///< of the bounds at the start [m]
    const std::vector<Vec3>& position() const { return m_tree.positions(); }  ///< [m], of all vertices
    double step() const { return m_step; }                                    ///< h of the last update [s]
    const std::vector<Vec3>& change() const { return m_change; }              ///< h v [m]

    /// Outward unit normals; zero where triangles have no area. Those of edges and nodes are calculated when asked for:
    /// few are near another body.
    Vec3 faceNormal(int triangle) const
    {
        return m_prepared || m_preparedFace[triangle] ? m_faceNormal[triangle] : normalOf(triangle);
    }
    Vec3 edgeNormal(int edge) const;  ///< mean of its faces'
    Vec3 nodeNormal(int node) const;  ///< weighted with the faces' angles
    /// The normal of a feature of a triangle: says on which side of a closed surface a point lies to which this feature
    /// is nearest [Baerentzen and Aanaes 2005].
    Vec3 normalAt(int triangle, const TrianglePoint& point) const;

    /// Sine of the angle by which the surface is bent at an edge: > 0 in a groove, < 0 on a ridge [-].
    double bend(int edge) const { return m_prepared || m_preparedEdge[edge] ? m_bend[edge] : bendOf(edge); }
    /// One of the triangles at a node.
    int nodeOwner(int node) const { return m_features.m_around[m_features.m_firstAround[node]]; }
    /// Unit vectors from an edge into its two faces, perpendicular to it.
    std::array<Vec3, 2> intoFaces(int edge) const;
    /// True if all faces at an edge (a node) have nearly (8 degrees) its normal.
    bool isFlatEdge(int edge) const;
    bool isFlatNode(int node) const;

    /// Least dot product of a direction with the unit vectors along the surface edges that leave a node: >= 0 if the
    /// body lies, near the node, on the direction's side of a plane.
    double leastAlongEdges(int node, const Vec3& direction) const;

private:
    static constexpr std::size_t kFine = 2000;  // triangles: two or three thousand elements have as many

    void listEdgeTriangles();
    void measureCurvature(const std::vector<Vec3>& x);
    Vec3 normalOf(int triangle) const;
    double bendOf(int edge) const;
    template <class Visit>
    void visitTrianglesAt(int edge, Visit visit) const;
    int nodeAt(int vertex) const { return m_nearestNode.empty() ? vertex : m_nearestNode[vertex]; }
    Vec3 intoFace(int edge, int triangle) const;

    std::vector<Triangle> m_triangles;
    std::vector<int> m_nodes;
    SurfaceFeatures m_features;
    double m_meanEdge, m_size, m_step = 0;
    std::vector<double> m_curvature;         // of every vertex
    std::vector<unsigned char> m_fewFacets;  // one a vertex
    SurfaceTree m_tree;
    SurfaceRidges m_ridges;
    std::shared_ptr<const RestNeighbours> m_restNeighbours;
    std::vector<int> m_nearestNode;
    std::vector<std::array<int, 2>> m_edgeTriangles;  // twice the same at a rim
    std::vector<unsigned char> m_manifoldEdge;        // 1: of exactly two triangles
    bool m_closed = false;
    std::vector<int> m_firstAround, m_around;  // surface edges' other ends around every vertex
    std::vector<Vec3> m_change, m_faceNormal;
    std::vector<Vec3> m_place;  // noted, one a vertex of m_nodes
    bool m_placeNoted = false;
    std::vector<double> m_bend;
    bool m_prepared = false;                                    // all faces and edges are
    std::vector<unsigned char> m_preparedFace, m_preparedEdge;  // not 0: m_faceNormal and m_bend have its
    std::vector<int> m_nearNodes;                               // of the tree, scratch
};

}  // namespace bullet_fem
