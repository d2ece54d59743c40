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

/// A rigid placement in double precision: world = m_rotation local + m_origin.
struct Pose
{
    Mat3 m_rotation = Mat3::identity();
    Vec3 m_origin;  ///< [m]

    Vec3 toWorld(const Vec3& local) const { return m_rotation * local + m_origin; }
    Vec3 toLocal(const Vec3& world) const { return transposeTimes(m_rotation, world - m_origin); }
};

/// One shape of a collision object that is not a compound, with its world placement. Convex, a static plane, a signed
/// distance field, or a sheet of triangles: triangle mesh, scaled or multimaterial triangle mesh, heightfield, part of
/// a GImpact mesh, any other btConcaveShape.
struct ShapeLeaf
{
    const btCollisionShape* m_shape = nullptr;
    Pose m_pose;                    ///< Bullet's transforms, composed and made orthonormal in double
    Vec3 m_boundsMin, m_boundsMax;  ///< world bounds with the shape's margin [m]; a plane's are infinite
};

/// True for Bullet's static planes, which fill the half of space below them.
bool isPlane(const ShapeLeaf& leaf);

/// Appends the leaves of an object's shape, through compounds of any depth, Bullet's and GImpact's; allocates only when
/// `leaves` must grow. Returns the number of leaves of a kind that is not known (they are left out): empty shapes,
/// signed distance fields that were not loaded, convex hulls and multi-spheres without points, triangle meshes whose
/// tree was not built or that are scaled to nothing, soft bodies, and classes that are neither a btConvexShape nor a
/// btConcaveShape.
int collectShapeLeaves(const btCollisionObject& object, btAlignedObjectArray<ShapeLeaf>& leaves);

/// True if the shape can be a leaf: it is of a known kind, and neither a compound nor a whole GImpact mesh.
bool isKnownShape(const btCollisionShape& shape);

/// Where a point of a soft surface is nearest to a rigid shape. The nearest point of the rigid shape is the soft point
/// minus m_gap m_normal.
struct SurfaceDistance
{
    double m_gap = 0;  ///< signed distance to the shape with its Bullet margin [m]; negative inside
    Vec3 m_normal;     ///< unit, world, from the rigid shape to the soft point
    std::array<double, 3> m_barycentric = {1, 0, 0};  ///< of the soft point in its triangle; (1, 0, 0) for nodes
};

/// Signed distance of a world point to a leaf; inside it is that to the nearest face, and on an axis or in a centre,
/// where all directions are equal, the normal is a fixed one. Where Bullet has its margin:
///  - box, cylinder: inside their extents. Closed form, to the sharp outline (Bullet's own GJK rounds the edges);
///  - sphere, capsule: it is the radius. Closed form;
///  - cone: around radius and height (0.04 m unless set, so Bullet's cone is larger than its sizes). Closed form;
///  - static plane: none, as for Bullet's rigid bodies. Closed form; behind the plane is inside at any depth;
///  - sheets of triangles are not asked here but by sheet_touch.h. There the margin is on both sides of the sheet, 0
///  for
///    meshes and heightfields and 0.01 m for GImpact unless set: where Bullet's boxes and hulls come to rest (its
///    spheres ignore it). Of a scaled mesh it is its own, not the original's;
///  - convex hull and every other btConvexShape: around the shape. By GJK, inside the shape proper by EPA, in
///    double; exact for shapes that have corners only, to 2e-5 of their size for those with round sides.
/// False, and `distance` untouched, if farther than maxDistance [m] (> 0) or not finite. Never allocates.
bool pointShapeDistance(const ShapeLeaf& leaf, const Vec3& point, double maxDistance, SurfaceDistance& distance);

/// Nearest point of a world triangle to a convex leaf, with its barycentric coordinates (>= 0, of sum 1); if they
/// overlap, the deepest point along the shortest way out. By GJK and EPA in double, for degenerate triangles too; deep
/// in cylinders, cones and other round shapes to 2e-5 of their size (one in 30,000 random triangles was off by 4e-4).
/// The edges of boxes and cylinders are rounded with 0.2 % of the smallest half extent, so near an edge (corner) the
/// gap may be greater than that to the sharp shape by 0.08 % (0.15 %) of this extent. A triangle is a sheet: what was
/// pushed through more than half of the shape is brought out on the other side. Planes are not asked: their nearest
/// point is a node. False, and `distance` untouched, if farther than maxDistance [m] (> 0), not finite or a plane.
/// Never allocates.
bool triangleShapeDistance(const ShapeLeaf& leaf, const std::array<Vec3, 3>& triangle, double maxDistance,
                           SurfaceDistance& distance);

}  // namespace bullet_fem
