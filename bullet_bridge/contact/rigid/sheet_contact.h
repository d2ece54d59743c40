// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/geometry/shapes/triangle_soup.h"

/// Contacts of a soft surface's nodes, edges and triangles with a soup of two-sided sheets. Nodes have contacts with
/// faces, and with edges and corners where these are nearest; triangles with the soup's corners; edges with its edges.
/// Triangles and edges know the inside by the orientation of the soft surface; nodes by the side of the sheets that
/// they come from.
namespace bullet_fem
{

constexpr double kParallelNormals = 1 - 1e-6;  ///< smallest cosine of normals that count as one

/// A half space that a point of the soft surface must stay in.
struct SheetContact
{
    SurfaceDistance m_surface;  ///< gap, less the thickness; negative on the other side
    int m_triangle = 0;         ///< index in the soup
};

/// A point of the soft surface, and the extent of its search.
struct SheetProbe
{
    Vec3 m_position;         ///< as the step begins [m]
    Vec3 m_rightSide;        ///< that position, moved back to the right side of all sheets by onRightSide() [m]
    Vec3 m_path;             ///< displacement in free motion relative to the sheet [m]
    double m_band = 0;       ///< gaps below this are contacts whether or not they close [m]
    double m_thickness = 0;  ///< of the sheet on each side, plus the contact offset [m]
};

/// The position of a point that comes from `safe`, moved back through the sheets between the two.
Vec3 onRightSide(const TriangleSoup& soup, const Vec3& safe, const Vec3& position);

/// Replaces `touches` by those of a point:
///   - faces that it lies over, can reach on its path or a part of it, and that no other face hides; of parallel faces
///     only the nearest, so that a plane of many triangles counts once;
///   - within the band, edges and corners that are nearest among the triangles around them;
///   - the face that its path crosses first.
void findPointContacts(const TriangleSoup& soup, const SheetProbe& probe, std::vector<SheetContact>& touches);

/// Replaces `touches` by the faces below the end of a point's path that the path comes close to or crosses and that no
/// other face hides: past a concave edge, the next face. `beyond`: distance beyond a rim that still counts as over the
/// face [m], as contacts bound a path to their rims but for rounding.
void findContactsAtEnd(const TriangleSoup& soup, const SheetProbe& probe, double beyond,
                       std::vector<SheetContact>& touches);

/// A triangle or edge (second corner repeated) of a soft surface, and the extent of its search.
struct SheetFeature
{
    Corners m_corners;       ///< [m]
    Vec3 m_outward;          ///< unit normal; of an edge the mean of its triangles'
    double m_halfAngle = 1;  ///< of an edge: cosine of the angle between m_outward and its triangles' normals [-]
    double m_reach = 0;      ///< gap up to which corners and edges are searched [m]
    double m_depth = 0;      ///< depth inside up to which they are searched [m]
    double m_thickness = 0;  ///< as in SheetProbe [m]
};

/// Smallest cosine [-] between m_outward and the contact normals of an edge; 1 for a triangle.
double widestNormal(const SheetFeature& edge);

/// Replaces `touches` by the soup's corners that point at a soft triangle, each with the normal that moves the triangle
/// off it.
void findCornerContacts(const TriangleSoup& soup, const SheetFeature& triangle, std::vector<SheetContact>& touches);

/// Replaces `touches` by the soup's convex edges that cross a soft edge.
void findEdgeContacts(const TriangleSoup& soup, const SheetFeature& edge, std::vector<SheetContact>& touches);

}  // namespace bullet_fem
