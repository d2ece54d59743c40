// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_bridge/geometry/surface/soft_surface.h"

namespace bullet_fem
{

/// Two points of soft surfaces that touch, or may do so within the step.
struct SurfaceTouch
{
    Triangle m_nodes, m_otherNodes;                   ///< unused ones repeat the first
    std::array<double, 3> m_weights, m_otherWeights;  ///< sum 1; up to 1e-3 edges beyond a face's rim [-]
    Vec3 m_normal;                                    ///< unit, from the other surface to this
    double m_gap = 0;                                 ///< along the normal at the start [m]; negative inside
    int m_feature = 0, m_otherFeature = 0;            ///< node, triangle or edge; see SoftPairOrigin
};

/// How far two surfaces look for each other.
struct TouchReach
{
    double m_band = 0;  ///< gaps below this are contacts though nothing closes them [m]
    double m_edge = 0;  ///< the smaller mean edge of the two [m]
    double m_fall = 0;  ///< by which they may come nearer than they would freely, if one does not fall [m]
    double depth() const { return 0.5 * m_edge; }       ///< to which one may always have sunk into the other [m]
    double within() const { return m_band + m_fall; }   ///< gaps above this do not close [m]
    double near() const { return within() + depth(); }  ///< what is farther apart at the start is no edges' affair [m]
};

}  // namespace bullet_fem
