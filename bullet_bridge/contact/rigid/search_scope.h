// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "bullet_bridge/body/fem_soft_body.h"
#include "bullet_bridge/contact/rigid/surface_culling.h"

namespace bullet_fem
{

using FeatureWeights = std::array<double, 3>;  ///< barycentric, on the corners of a feature [-]

constexpr double kFeatureDepth = 0.3;    ///< largest depth of edge and triangle contacts, over the mean edge [-]
constexpr double kOpposedCosine = -0.5;  ///< cosine between opposed normals, at most [-]

/// The body whose contacts are searched, with the lengths that the searches share, and their culling.
struct SearchScope
{
    FemSoftBody* m_fem = nullptr;  ///< not null in a search
    int m_bodyIndex = 0;           ///< ContactPoint's m_soft.m_body
    double m_edge = 0;             ///< mean edge length [m]
    double m_size = 0;             ///< cube root of the body's volume [m]
    double m_advantage = 0;        ///< by which a nearest point must be closer than the fixed ones [m]
    double m_band = 0;             ///< gaps below this are contacts whether or not they close [m]
    double m_fastest = 0;          ///< fastest node of the body [m/s]
    SurfaceCulling m_culling;
    Vec3 m_middle;  ///< mean of the surface's vertices [m]; set if inner nodes are exposed

    FemSoftBody& fem() const { return *m_fem; }

    /// The vertices of the surface and the exposed inner nodes, ascending.
    const std::vector<int>& vertices() const { return m_exposed.empty() ? surfaceVertices() : m_exposed; }

    /// Largest depth of a point below a triangle of the surface, at which it is a contact of the triangle [m]: no
    /// deeper than the body.
    double depthOn(int triangle) const { return std::min(kFeatureDepth * m_edge, m_fem->heightOn(triangle)); }

    /// Sets all but the fastest node and the culling.
    void begin(FemSoftBody& fem, int bodyIndex);

    /// Finds the inner nodes that the surface no longer encloses: those outside its bounding box, and those of elements
    /// that are inside out. Call after the start of the culling, whose box then encloses them.
    void findExposed();

private:
    const std::vector<int>& surfaceVertices() const { return m_fem->m_surface.topology().vertices(); }

    std::vector<int> m_exposed;                // with the surface's vertices; empty if there are none
    std::vector<unsigned char> m_isInsideOut;  // per node: of an element that is inside out; empty if none may be
};

}  // namespace bullet_fem
