// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/geometry/surface/soft_surface.h"

namespace bullet_fem
{

/// A contact between points of two soft surfaces, present or possible within the step.
struct SurfaceContact
{
    Triangle m_nodes, m_otherNodes;                   ///< unused ones repeat the first
    std::array<double, 3> m_weights, m_otherWeights;  ///< barycentric, sum 1 [-]; the point may be up to 1e-3 edges
                                                      ///< beyond a face's rim
    Vec3 m_normal;                                    ///< unit, from the other surface to this one
    double m_gap = 0;                       ///< along the normal as the step begins [m]; negative: penetration
    int m_feature = 0, m_otherFeature = 0;  ///< node, triangle or edge: see SoftPairOrigin
};

/// Search distances between two surfaces.
struct ContactReach
{
    double m_band = 0;  ///< gaps below this are contacts whether or not they close [m]
    double m_edge = 0;  ///< the smaller mean edge of the two [m]
    double m_fall = 0;  ///< displacement by gravity that is missing in the free approach if one body is supported [m]
    double depth() const { return 0.5 * m_edge; }       ///< largest penetration that is always credible [m]
    double within() const { return m_band + m_fall; }   ///< gaps above this do not close [m]
    double near() const { return within() + depth(); }  ///< largest distance at the start of edge pairs [m]
};

}  // namespace bullet_fem
