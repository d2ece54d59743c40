// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "bullet_bridge/geometry/surface/rest_neighbours.h"
#include "bullet_bridge/geometry/surface/surface_curvature.h"
#include "bullet_bridge/geometry/surface/surface_ridges.h"
#include "bullet_bridge/geometry/surface/surface_tree.h"
#include "bullet_fem/fem/contact/contact_solver.h"

namespace bullet_fem
{

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
    double m_meanEdge = 0;              ///< unit of bands and margins [m]
    double m_size = 0;                  ///< cube root of the body's volume [m]
    std::vector<int> m_nearestNode;  ///< per vertex, the nearest node of the mesh; empty if the vertices are the nodes
};

/// The boundary surface of a mesh.
RestSurface boundaryOf(const TetMesh& mesh);

/// The surface of a deforming body as input of the soft-body contact search: its topology and curvature at rest, and in
/// a step its face normals, dihedral angles, and a bounding volume tree over its triangles. Built at set-up; place()
/// and the preparation never allocate.
class SoftSurface
{
public:
    /// Any surface. It may be open or have edges of more than two triangles; such edges are in contact only as parts of
    /// their triangles.
    explicit SoftSurface(const RestSurface& rest);

    /// Sets the neighbours at rest of the nodes nearest to the vertices. Required for self contact, and used by it
    /// only.
    void setRestNeighbours(std::shared_ptr<const RestNeighbours> neighbours)
    {
        m_restNeighbours = std::move(neighbours);
    }
    bool hasRestNeighbours() const { return m_restNeighbours != nullptr; }
    /// True if two vertices are excluded from self contact: see RestNeighbours.
    bool areCloseAtRest(int a, int b) const { return m_restNeighbours->areClose(nodeAt(a), nodeAt(b)); }

    /// Sets the positions x [m] at the start of a step of h [s], and the expected velocities v [m/s]. Then prepareAll()
    /// or prepareNear() stores normals and dihedral angles. Other normals and angles are computed at each call, with
    /// equal results; ridges() has only ridges of prepared leaves.
    void place(const std::vector<Vec3>& x, const std::vector<Vec3>& v, double h);
    void prepareAll();
    /// Prepares only the triangles near boxes, which must be valid for the whole step.
    void prepareNear(const std::vector<SurfaceTree::Nearby>& boxes);

    const SurfaceTopology& topology() const { return m_topology; }
    const SurfaceCurvature& curvature() const { return m_curvature; }  ///< at rest
    double meanEdge() const { return m_meanEdge; }  ///< mean edge of the tetrahedra at rest, or of finer triangles [m]
    double size() const { return m_size; }          ///< cube root of the volume at rest [m]

    const SurfaceTree& tree() const { return m_tree; }
    const SurfaceRidges& ridges() const { return m_ridges; }
    const std::vector<Vec3>& position() const { return m_tree.positions(); }  ///< of all vertices [m]
    const std::vector<Vec3>& change() const { return m_change; }              ///< displacements h v [m]
    double step() const { return m_step; }                                    ///< h of the last place() [s]

    /// Outward unit normal; zero for triangles without area.
    Vec3 faceNormal(int triangle) const
    {
        return m_faceNormal[triangle] ? *m_faceNormal[triangle] : normalOf(m_tree.corners(triangle));
    }
    /// Sine of the dihedral angle at an edge [-]: > 0 in a groove, < 0 on a ridge.
    double bend(int edge) const;

private:
    int nodeAt(int vertex) const { return m_nearestNode.empty() ? vertex : m_nearestNode[vertex]; }

    SurfaceTopology m_topology;
    SurfaceCurvature m_curvature;
    double m_meanEdge, m_size, m_step = 0;
    std::vector<int> m_nearestNode;
    std::shared_ptr<const RestNeighbours> m_restNeighbours;
    SurfaceTree m_tree;
    SurfaceRidges m_ridges;
    std::vector<Vec3> m_change;
    std::vector<std::optional<Vec3>> m_faceNormal;  // of prepared triangles
    std::vector<double> m_bend;
    std::vector<unsigned char> m_preparedEdge;  // not 0: m_bend is valid
    std::vector<int> m_nearNodes;               // scratch: nodes of the tree
};

// Unit normals of edges and vertices, outward. They are computed on demand, as few are near another body.

/// Mean of an edge's face normals.
Vec3 edgeNormal(const SoftSurface& surface, int edge);
/// Mean of a vertex's face normals weighted by their angles.
Vec3 nodeNormal(const SoftSurface& surface, int node);
/// The pseudonormal of a triangle's feature: its sign tells on which side of a closed surface a point is whose nearest
/// point lies on that feature [Baerentzen and Aanaes 2005].
Vec3 normalAt(const SoftSurface& surface, int triangle, const TrianglePoint& point);

/// Unit vector in a triangle's plane, perpendicular to its edge, into the triangle.
Vec3 intoFace(const SoftSurface& surface, int edge, int triangle);
/// Those of an edge's two triangles.
std::array<Vec3, 2> intoFaces(const SoftSurface& surface, int edge);

/// True if the normals of all faces at an edge (a node) are within 8 degrees of its normal.
bool isFlatEdge(const SoftSurface& surface, int edge);
bool isFlatNode(const SoftSurface& surface, int node);

/// Smallest dot product [-] of a direction with the unit vectors along the surface edges from a node. If it is >= 0,
/// the body near the node lies on the direction's side of a plane through the node.
double minAlongEdges(const SoftSurface& surface, int node, const Vec3& direction);

/// Centre of the bounding box at the start [m].
Vec3 middleOf(const SoftSurface& surface);

}  // namespace bullet_fem
