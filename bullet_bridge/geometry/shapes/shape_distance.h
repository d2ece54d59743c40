// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>

#include "LinearMath/btAlignedObjectArray.h"
#include "bullet_fem/fem/common/vec3.h"

class btCollisionObject;
class btCollisionShape;

namespace bullet_fem
{

/// A rigid transform in double precision: world = m_rotation local + m_origin.
struct Pose
{
    Mat3 m_rotation = Mat3::identity();
    Vec3 m_origin;  ///< [m]

    /// Transforms a point from local to world coordinates, and back [m].
    Vec3 toWorld(const Vec3& local) const { return m_rotation * local + m_origin; }
    Vec3 toLocal(const Vec3& world) const { return transposeTimes(m_rotation, world - m_origin); }
};

/// A shape of a collision object that is not a compound, with its world transform: convex, a static plane, a signed
/// distance field, or a sheet of triangles (triangle mesh, scaled or multimaterial triangle mesh, heightfield, part of
/// a GImpact mesh, any other btConcaveShape).
struct ShapeLeaf
{
    const btCollisionShape* m_shape = nullptr;
    Pose m_pose;                    ///< Bullet's transforms, composed and orthonormalised in double precision
    Vec3 m_boundsMin, m_boundsMax;  ///< world bounds with the shape's margin [m]; a plane's are infinite
};

/// True for Bullet's static planes, which are half spaces.
bool isPlane(const ShapeLeaf& leaf);

/// Appends the leaves of an object's shape, through nested compounds of Bullet and GImpact. Returns the number of
/// omitted leaves of unknown kind: empty shapes, signed distance fields that are not loaded, convex hulls and
/// multi-spheres without points, triangle meshes without a tree or scaled to zero, soft bodies, and classes that are
/// neither a btConvexShape nor a btConcaveShape. Allocates only when `leaves` grows.
int collectShapeLeaves(const btCollisionObject& object, btAlignedObjectArray<ShapeLeaf>& leaves);

/// True if the shape can be a leaf: its kind is known, and it is neither a compound nor a whole GImpact mesh.
bool isKnownShape(const btCollisionShape& shape);

/// The point of a soft surface that is nearest to a rigid shape. The nearest point of the rigid shape is that point
/// minus m_gap m_normal.
struct SurfaceDistance
{
    double m_gap = 0;  ///< signed distance to the shape with its Bullet margin [m]; negative inside
    Vec3 m_normal;     ///< unit, world, from the rigid shape to the soft point
    std::array<double, 3> m_barycentric = {1, 0, 0};  ///< weights of the soft point in its triangle; (1, 0, 0) for
                                                      ///< nodes [-]
};

/// Signed distance of a world point to a leaf. Inside it is the distance to the nearest face; in a centre or on an
/// axis, where directions are equivalent, the normal is a fixed one. The treatment of Bullet's margin:
///  - box, cylinder: inside their extents. Closed form, to the sharp outline (Bullet's own GJK rounds the edges);
///  - sphere, capsule: it is the radius. Closed form;
///  - cone: around radius and height (0.04 m unless set, so Bullet's cone is larger than its sizes). Closed form;
///  - static plane: none, as for Bullet's rigid bodies. Closed form; points behind the plane are inside at any depth;
///  - sheets of triangles: not handled here but in sheet_contact.h. The margin is on both sides of the sheet, 0 for
///    meshes and heightfields and 0.01 m for GImpact unless set: this is where Bullet's boxes and hulls come to rest
///    (its spheres ignore it). A scaled mesh has its own margin, not the original's;
///  - convex hull and every other btConvexShape: around the shape. By GJK, and by EPA inside the core, in double
///    precision; exact for polyhedra, to 2e-5 of their size for curved shapes.
/// False, with `distance` unchanged, if the distance exceeds maxDistance [m] (> 0) or is not finite. Never allocates.
bool pointShapeDistance(const ShapeLeaf& leaf, const Vec3& point, double maxDistance, SurfaceDistance& distance);

/// Nearest point of a world triangle to a convex leaf or field, with its barycentric coordinates (>= 0, sum 1); if they
/// overlap, the deepest point along the shortest way out. By GJK and EPA in double precision, also for degenerate
/// triangles; deep inside cylinders, cones and other curved shapes accurate to 2e-5 of their size (one in 30,000 random
/// triangles was off by 4e-4). The edges of boxes and cylinders are rounded by 0.2 % of the smallest half extent, so
/// near an edge (corner) the gap may exceed that to the sharp shape by 0.08 % (0.15 %) of this extent. A triangle has
/// no inside: if it was pushed through more than half of the shape, it is brought out on the other side. Planes are not
/// supported: their nearest point is a node. False, with `distance` unchanged, for planes, or if the distance exceeds
/// maxDistance [m] (> 0) or is not finite. Never allocates.
bool triangleShapeDistance(const ShapeLeaf& leaf, const std::array<Vec3, 3>& triangle, double maxDistance,
                           SurfaceDistance& distance);

}  // namespace bullet_fem
