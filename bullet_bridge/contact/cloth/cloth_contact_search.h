// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/contact/cloth/cloth_surface.h"
#include "bullet_bridge/geometry/surface/soft_surface.h"

namespace bullet_fem
{

/// A contact between a FEM body's surface and a cloth, present or possible within the step.
struct ClothContact
{
    Triangle m_nodes, m_clothNodes;                   ///< unused ones repeat the first
    std::array<double, 3> m_weights, m_clothWeights;  ///< barycentric, sum 1 [-]
    Vec3 m_point, m_onBody;                           ///< points on the cloth and on the body as the step begins [m]
    Vec3 m_normal;                                    ///< unit, from the cloth to the body
    double m_gap = 0;  ///< as the step begins, less the cloth's margin and the contact offset [m]; negative:
                       ///< penetration
};

/// Finds the contacts of a cloth with the surface of a FEM body:
///   - each cloth node against the nearest point of the body's surface; a node inside the body is led out through the
///     nearest face;
///   - each vertex of the body against the nearest point of the cloth. A cloth face has two sides: the vertex belongs
///     to the side that its own surface faces, as the body is solid;
///   - a node or vertex beyond the contact band at the point where it first arrives on its straight path, by
///     conservative advancement [Mirtich 1996]; deformation during the step is neglected.
class ClothContactSearch
{
public:
    /// `thickness` [m] is the distance kept between the two. Pairs that are closer than thickness + band [m] are
    /// contacts whether or not they approach.
    ClothContactSearch(const SoftSurface& surface, const ClothSurface& cloth, double thickness, double band)
        : m_surface(surface), m_cloth(cloth), m_thickness(thickness), m_band(band)
    {
    }

    /// Appends the contacts of the cloth's nodes, then those of the surface's vertices, both by ascending index.
    void find(std::vector<ClothContact>& touches);

private:
    struct Mover  // a cloth node or a surface vertex
    {
        int m_index;
        Vec3 m_x, m_change, m_normal;
    };
    struct Place  // nearest point of the other side
    {
        int m_triangle = -1;
        TrianglePoint m_nearest;
        Vec3 m_normal;          // from the cloth to the body
        double m_distance = 0;  // signed [m]
    };

    template <class Look>
    bool arrive(const Mover& mover, const std::vector<Vec3>& change, const std::vector<Triangle>& triangles,
                const Look& look, Place& place) const;
    bool lookAtSurface(const Vec3& x, double most, Place& place) const;
    bool lookAtCloth(const Mover& mover, const Vec3& x, double most, Place& place) const;
    void findNode(int node, std::vector<ClothContact>& touches) const;
    void findVertex(int vertex, std::vector<ClothContact>& touches) const;

    const SoftSurface& m_surface;
    const ClothSurface& m_cloth;
    double m_thickness, m_band;
};

}  // namespace bullet_fem
