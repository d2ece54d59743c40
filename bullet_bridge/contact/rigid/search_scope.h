// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>

#include "bullet_bridge/body/fem_soft_body.h"
#include "bullet_bridge/contact/rigid/surface_culling.h"

namespace bullet_fem
{

using FeatureWeights = std::array<double, 3>;  ///< barycentric, on the corners of a feature [-]

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

    FemSoftBody& fem() const { return *m_fem; }

    /// Sets all but the fastest node and the culling.
    void begin(FemSoftBody& fem, int bodyIndex);
};

constexpr double kFeatureDepth = 0.3;    ///< largest depth of edge and triangle contacts, over the mean edge [-]
constexpr double kOpposedCosine = -0.5;  ///< cosine between opposed normals, at most [-]

}  // namespace bullet_fem
