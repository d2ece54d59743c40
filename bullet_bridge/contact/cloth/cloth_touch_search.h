// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/contact/cloth/cloth_surface.h"
#include "bullet_bridge/geometry/surface/soft_surface.h"

namespace bullet_fem
{

/// A point of a FEM body's surface and one of a cloth that touch, or may do so within the step.
struct ClothTouch
{
    Triangle m_nodes, m_clothNodes;                   ///< unused ones repeat the first
    std::array<double, 3> m_weights, m_clothWeights;  ///< sum 1 [-]
    Vec3 m_point, m_onBody;                           ///< of the cloth, and of the body, as the step begins [m]
    Vec3 m_normal;                                    ///< unit, from the cloth to the body
    double m_gap = 0;                                 ///< at the start, between body and margin [m]; negative inside
};

/// Finds where a cloth touches the surface of a FEM body:
///  - a node of the cloth, the nearest point of the surface; from inside the body the nearest face leads out;
///  - a vertex of the surface, the nearest point of the cloth's faces, which have two sides: the cloth is on that which
///    the surface is turned to, as a body is solid;
///  - what comes from farther than the band, where it arrives first on its straight way, by conservative advancement
///    [Mirtich 1996], with the deformation of that step left out.
class ClothTouchSearch
{
public:
    /// `thickness` [m] is kept between the two, from `band` [m] more on they touch though nothing closes them.
    ClothTouchSearch(const SoftSurface& surface, const ClothSurface& cloth, double thickness, double band)
        : m_surface(surface), m_cloth(cloth), m_thickness(thickness), m_band(band)
    {
    }

    /// Appends the touches of the cloth's nodes, then those of the surface's vertices, by ascending number.
    void find(std::vector<ClothTouch>& touches);

private:
    struct Mover  // a node or a vertex
    {
        int m_index;
        Vec3 m_x, m_change, m_normal;
    };
    struct Place  // of the other side
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
    void findNode(int node, std::vector<ClothTouch>& touches) const;
    void findVertex(int vertex, std::vector<ClothTouch>& touches) const;

    const SoftSurface& m_surface;
    const ClothSurface& m_cloth;
    double m_thickness, m_band;
};

}  // namespace bullet_fem
