// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/geometry/shapes/triangle_soup.h"

/// How nodes, edges and triangles of a soft surface touch a soup of two-sided sheets. Nodes touch faces, and edges and
/// corners where these are nearest; triangles touch the soup's corners, and edges its edges. The last two are told
/// inside from outside by the soft surface, which is oriented; nodes by the side of the sheets that they come from.
namespace bullet_fem
{

constexpr double kParallelNormals = 1 - 1e-6;  ///< cosine of the angle between normals that count as one

/// A half space that a point of the soft surface must not leave.
struct SheetTouch
{
    SurfaceDistance m_surface;  ///< gap to the sheet with its thickness; negative on the other side
    int m_triangle = 0;         ///< of the soup
};

/// A point of the soft surface, and how far to look from it.
struct SheetProbe
{
    Vec3 m_position;         ///< as the step begins [m]
    Vec3 m_rightSide;        ///< the same, on the right side of all sheets: see onRightSide() [m]
    Vec3 m_path;             ///< its free motion in the step relative to the sheet [m]
    double m_band = 0;       ///< gaps below this touch though nothing closes them [m]
    double m_thickness = 0;  ///< of the sheet, on both of its sides, and of the soft surface [m]
};

/// The position of a point that came from `safe`, moved back through the sheets that it has crossed since.
Vec3 onRightSide(const TriangleSoup& soup, const Vec3& safe, const Vec3& position);

/// Replaces `touches` by those of a point:
///  - faces over which it lies, that it can reach on its path or a shorter one, and that no other hides; of parallel
///    ones the nearest, so that a plane of many triangles is one;
///  - within the band, edges and corners that are nearest among the triangles around them;
///  - the face that its path meets first.
void findPointTouches(const TriangleSoup& soup, const SheetProbe& probe, std::vector<SheetTouch>& touches);

/// Replaces `touches` by the faces that a point lies over where its path ends, that it is not beyond the plane of where
/// it begins, and that nothing hides: past a concave edge, the next face.
void findTouchesAtEnd(const TriangleSoup& soup, const SheetProbe& probe, std::vector<SheetTouch>& touches);

/// A triangle or edge (its second corner twice) of a soft surface, and how far to look from it.
struct SheetFeature
{
    Corners m_corners;       ///< [m]
    Vec3 m_outward;          ///< unit; of an edge halfway between its triangles'
    double m_halfAngle = 1;  ///< of an edge: cosine of the angle between m_outward and its triangles' normals
    double m_reach = 0;      ///< gap up to which corners and edges are looked for [m]
    double m_depth = 0;      ///< and how deep inside [m]
    double m_thickness = 0;  ///< as in SheetProbe [m]
};

/// Cosine of the angle between m_outward and the normals that an edge may touch with; of a triangle it is 1.
double widestNormal(const SheetFeature& edge);

/// Replaces `touches` by the soup's corners that point at a soft triangle, with the normal that moves it off them.
void findCornerTouches(const TriangleSoup& soup, const SheetFeature& triangle, std::vector<SheetTouch>& touches);

/// Replaces `touches` by the soup's convex edges that cross a soft edge.
void findEdgeTouches(const TriangleSoup& soup, const SheetFeature& edge, std::vector<SheetTouch>& touches);

}  // namespace bullet_fem
