// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <limits>
#include <vector>

#include "bullet_bridge/geometry/surface/soft_surface.h"

namespace bullet_fem
{

/// Cheap conservative tests of which vertices, edges and triangles of a surface cannot come near a shape, by the
/// shape's bounds and by its distances from the vertices. Features that pass may still be far. Scratch grows with the
/// surface, never shrinks.
class SurfaceCulling
{
public:
    /// Starts with a surface whose vertices are at x [m]; x must outlive the queries, unchanged.
    void begin(const SoftSurface& surface, const std::vector<Vec3>& x);

    /// Enlarges the bounding box of the surface by a point [m].
    void include(const Vec3& x);

    /// Corners of the bounding box of the surface [m].
    const Vec3& low() const { return m_low; }
    const Vec3& high() const { return m_high; }

    /// Length of the longest edge [m].
    double longestEdge() const { return m_longestEdge; }

    /// Bounding box of a shape.
    struct Bounds
    {
        Vec3 m_low, m_high;  ///< [m]
        double m_reach;      ///< distance from the box up to which features count [m]
    };
    /// Sets the bounds of the next queries. False if all of the surface is out of reach; then no query may follow.
    bool meets(const Bounds& bounds);

    /// Notes where a vertex is, and the end of its straight path. True if the path's bounding box is within reach.
    bool noteVertex(int vertex, const Vec3& start, const Vec3& end);

    /// Notes the gap between a vertex and a convex shape [m] and the gap's gradient. The gap is infinite for a vertex
    /// that is farther away than reach + longestEdge().
    void noteGap(int vertex, double gap, const Vec3& normal) { m_gaps[vertex] = {gap, normal}; }
    /// Notes that the gap is not known.
    void noteNoGap(int vertex) { m_gaps[vertex] = {-std::numeric_limits<double>::infinity(), {}}; }

    /// True if no point of a triangle, or of an edge (two equal vertices), comes within reach of the bounds on its
    /// path. All vertices must have been noted.
    bool isOutside(const Triangle& t) const { return (m_outside[t[0]] & m_outside[t[1]] & m_outside[t[2]]) != 0; }

    /// Lower bound of the gap between a triangle or edge and the shape [m] from the noted gaps, up to errors of their
    /// gradients.
    double minGap(const Triangle& t) const;

private:
    struct Gap
    {
        double m_gap;
        Vec3 m_normal;
    };
    double minGap(int vertex, const Triangle& t) const;

    const std::vector<Vec3>* m_x = nullptr;
    Vec3 m_low, m_high;  // of the surface
    double m_longestEdge = 0;
    Bounds m_bounds = {};
    std::vector<unsigned char> m_outside;  // one bit for each side of the bounds that the vertex is beyond
    std::vector<Gap> m_gaps;
};

}  // namespace bullet_fem
