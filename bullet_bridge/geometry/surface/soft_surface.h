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

/// The unit vector of a; zero if a is zero.
inline Vec3 unit(const Vec3& a)
{
    const double length = norm(a);
    return length > 0 ? (1 / length) * a : Vec3();
}

/// Linear interpolation of nodal values with barycentric weights [-].
inline Vec3 interpolated(const std::vector<Vec3>& values, const Triangle& t, const std::array<double, 3>& w)
{
    return w[0] * values[t[0]] + w[1] * values[t[1]] + w[2] * values[t[2]];
}

/// A point of a mesh's surface as the solver's SurfacePoint.
inline SurfacePoint pointOf(int body, const Triangle& nodes, const std::array<double, 3>& weights)
{
    SurfacePoint point;
    point.m_body = body;
    std::copy(nodes.begin(), nodes.end(), point.m_nodes.begin());
    std::copy(weights.begin(), weights.end(), point.m_weights.begin());
    return point;
}

/// The collision surface of a body in its rest shape.
struct RestSurface
{
    std::vector<Vec3> m_positions;      ///< of the vertices [m]
    std::vector<Triangle> m_triangles;  ///< vertex indices, oriented outward
    std::vector<int> m_vertices;        ///< vertices of the triangles, ascending
    double m_meanEdge = 0;              ///< unit of bands and margins [m]
    double m_size = 0;                  ///< cube root of the body's volume [m]
    std::vector<int> m_nearestNode;  ///< per vertex, the nearest node of the mesh; empty if the vertices are the nodes
};

/// The boundary surface of a mesh.
RestSurface boundaryOf(const TetMesh& mesh);

/// The surface of a deforming body as input of the soft-body contact search: normals of faces, edges and vertices,
/// dihedral angles, and a bounding volume tree over its triangles. Built at set-up; update() never allocates.
class SoftSurface
{
public:
    /// The boundary surface of a mesh.
    explicit SoftSurface(const TetMesh& mesh);

    /// Any surface. It may be open or have edges of more than two triangles; such edges are in contact only as parts of
    /// their triangles.
    explicit SoftSurface(const RestSurface& rest);

    /// Sets the neighbours at rest of the nodes nearest to the vertices. Required for self contact, and used by it
    /// only.
    void setRestNeighbours(std::shared_ptr<const RestNeighbours> neighbours);
    /// True if every edge has two triangles.
    bool isClosed() const { return m_closed; }
    bool hasRestNeighbours() const { return m_restNeighbours != nullptr; }

    /// Sets the positions x [m] at the start of a step of h [s], and the expected velocities v [m/s]. Call once a step.
    void update(const std::vector<Vec3>& x, const std::vector<Vec3>& v, double h);

    /// update() in two parts: place() sets positions and velocities; then prepareAll() or prepareNear() stores normals
    /// and dihedral angles. Other normals and angles are computed at each call, with equal results; ridges() has only
    /// ridges of prepared leaves.
    void place(const std::vector<Vec3>& x, const std::vector<Vec3>& v, double h);
    void prepareAll();
    /// Prepares only the triangles near boxes, which must be valid for the whole step.
    void prepareNear(const std::vector<SurfaceTree::Nearby>& boxes);
    /// True if the last preparation was prepareAll().
    bool isPrepared() const { return m_prepared; }
    /// True if the surface is so fine that prepareNear() pays off.
    bool isFine() const { return m_triangles.size() >= kFine; }

    /// Notes the present positions of the surface's vertices. Never allocates.
    void notePlace();

    /// Discards the noted positions: isStill() is false until the next notePlace().
    void forgetPlace() { m_placeNoted = false; }
    bool isPlaceNoted() const { return m_placeNoted; }
    /// True if all vertices are and stay within `reach` [m] of their noted positions during the step. Arguments as for
    /// update(), which need not have been called.
    bool isStill(const std::vector<Vec3>& x, const std::vector<Vec3>& v, double h, double reach) const;

    /// The noted positions, one per vertex of nodes() [m], for a snapshot; empty if there are none.
    std::vector<Vec3> notedPlace() const { return m_placeNoted ? m_place : std::vector<Vec3>(); }
    /// Restores notedPlace(): one position per vertex of nodes(), or none.
    void restorePlace(const std::vector<Vec3>& place);

    const std::vector<Triangle>& triangles() const { return m_triangles; }
    const std::vector<int>& nodes() const { return m_nodes; }  ///< vertices of the surface, ascending
    int vertexCount() const { return static_cast<int>(position().size()); }
    const SurfaceFeatures& features() const { return m_features; }
    double meanEdge() const { return m_meanEdge; }  ///< mean edge of the tetrahedra at rest, or of finer triangles [m]
    /// Largest normal curvature along the edges at a vertex, at rest [1/m]; 0 where the surface is flat or concave.
    double curvature(int vertex) const { return m_curvature[vertex]; }

    /// True if a round surface has few facets around the vertex, so that it rolls from corner to corner.
    bool hasFewFacets(int vertex) const { return m_fewFacets[vertex]; }
    double size() const { return m_size; }  ///< cube root of the volume at rest [m]
    const SurfaceTree& tree() const { return m_tree; }
    const SurfaceRidges& ridges() const { return m_ridges; }
    /// True if two vertices are excluded from self contact: see RestNeighbours.
    bool areCloseAtRest(int a, int b) const { return m_restNeighbours->areClose(nodeAt(a), nodeAt(b)); }
    Vec3 middle() const;  ///< centre of the bounding box at the start [m]
    const std::vector<Vec3>& position() const { return m_tree.positions(); }  ///< of all vertices [m]
    double step() const { return m_step; }                                    ///< h of the last update [s]
    const std::vector<Vec3>& change() const { return m_change; }              ///< displacements h v [m]

    /// Outward unit normals; zero for triangles without area. Those of edges and nodes are computed on demand, as few
    /// are near another body.
    Vec3 faceNormal(int triangle) const
    {
        return m_prepared || m_preparedFace[triangle] ? m_faceNormal[triangle] : normalOf(triangle);
    }
    Vec3 edgeNormal(int edge) const;  ///< mean of its faces' normals
    Vec3 nodeNormal(int node) const;  ///< mean of its faces' normals weighted by their angles
    /// The pseudonormal of a triangle's feature: its sign tells on which side of a closed surface a point is whose
    /// nearest point lies on that feature [Baerentzen and Aanaes 2005].
    Vec3 normalAt(int triangle, const TrianglePoint& point) const;

    /// Sine of the dihedral angle at an edge [-]: > 0 in a groove, < 0 on a ridge.
    double bend(int edge) const { return m_prepared || m_preparedEdge[edge] ? m_bend[edge] : bendOf(edge); }
    /// One of the triangles at a node.
    int nodeOwner(int node) const { return m_features.m_around[m_features.m_firstAround[node]]; }
    /// Unit vectors from an edge into its two faces, perpendicular to the edge.
    std::array<Vec3, 2> intoFaces(int edge) const;
    /// True if the normals of all faces at an edge (a node) are within 8 degrees of its normal.
    bool isFlatEdge(int edge) const;
    bool isFlatNode(int node) const;

    /// Smallest dot product [-] of a direction with the unit vectors along the surface edges from a node. If it is >=
    /// 0, the body near the node lies on the direction's side of a plane through the node.
    double minAlongEdges(int node, const Vec3& direction) const;

private:
    static constexpr std::size_t kFine = 2000;  // triangles, as of two or three thousand elements

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
    std::vector<double> m_curvature;         // per vertex [1/m]
    std::vector<unsigned char> m_fewFacets;  // per vertex
    SurfaceTree m_tree;
    SurfaceRidges m_ridges;
    std::shared_ptr<const RestNeighbours> m_restNeighbours;
    std::vector<int> m_nearestNode;
    std::vector<std::array<int, 2>> m_edgeTriangles;  // a boundary edge repeats its triangle
    std::vector<unsigned char> m_manifoldEdge;        // 1: the edge has exactly two triangles
    bool m_closed = false;
    std::vector<int> m_firstAround, m_around;  // neighbouring vertices of vertex i: from m_firstAround[i] to
                                               // m_firstAround[i + 1] of m_around
    std::vector<Vec3> m_change, m_faceNormal;
    std::vector<Vec3> m_place;  // noted positions, one per vertex of m_nodes
    bool m_placeNoted = false;
    std::vector<double> m_bend;
    bool m_prepared = false;                                    // m_faceNormal and m_bend are valid for all
    std::vector<unsigned char> m_preparedFace, m_preparedEdge;  // not 0: m_faceNormal or m_bend is valid
    std::vector<int> m_nearNodes;                               // scratch: nodes of the tree
};

}  // namespace bullet_fem
