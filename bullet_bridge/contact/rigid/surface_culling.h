// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <limits>
#include <vector>

#include "bullet_bridge/geometry/surface/soft_surface.h"

namespace bullet_fem
{

/// Tells cheaply which vertices, edges and triangles of a surface cannot come near a shape: by the shape's bounds, and
/// by its distances from the vertices. What it does not rule out may be far all the same. Scratch grows with the
/// surface, never shrinks.
class SurfaceCulling
{
public:
    /// Takes a surface with its vertices at x [m], which must stay where they are.
    void begin(const SoftSurface& surface, const std::vector<Vec3>& x);

    /// The corners of the box around all of it [m].
    const Vec3& low() const { return m_low; }
    const Vec3& high() const { return m_high; }

    /// No two points of a triangle are farther apart [m].
    double longestEdge() const { return m_longestEdge; }

    /// A box around a shape; forgets what was noted.
    struct Bounds
    {
        Vec3 m_low, m_high;  ///< [m]
        double m_reach;      ///< distance from it at which features count [m]
    };
    /// False if all of the surface is out of reach; then nothing more may be asked.
    bool meets(const Bounds& bounds);

    /// Notes where a vertex is, and where else a straight way takes it. True if that can be within reach.
    bool noteVertex(int vertex, const Vec3& start, const Vec3& end);

    /// Notes the gap between a vertex and a convex shape [m] and its gradient; of a vertex that is farther than reach
    /// and longestEdge() the gap is infinite.
    void noteGap(int vertex, double gap, const Vec3& normal) { m_gaps[vertex] = {gap, normal}; }
    /// Notes that the gap is not known.
    void noteNoGap(int vertex) { m_gaps[vertex] = {-std::numeric_limits<double>::infinity(), {}}; }

    /// True if no point of a triangle, or of an edge (two vertices the same), or of their ways, can be within reach of
    /// the bounds. All vertices must have been noted.
    bool isOutside(const Triangle& t) const { return (m_outside[t[0]] & m_outside[t[1]] & m_outside[t[2]]) != 0; }

    /// What the gaps noted say of a triangle or edge: none of its points is nearer to the shape [m], but for what
    /// gradients are off.
    double leastGap(const Triangle& t) const;

private:
    struct Gap
    {
        double m_gap;
        Vec3 m_normal;
    };
    double leastGap(int vertex, const Triangle& t) const;

    const std::vector<Vec3>* m_x = nullptr;
    Vec3 m_low, m_high;  // of the surface
    double m_longestEdge = 0;
    Bounds m_bounds = {};
    std::vector<unsigned char> m_outside;  // a bit for every side of the bounds that a vertex is beyond
    std::vector<Gap> m_gaps;
};

}  // namespace bullet_fem
