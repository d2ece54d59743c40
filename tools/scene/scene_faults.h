// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

#include "tools/scene/scene_frames.h"

namespace bullet_fem
{

/// A fault in the state of bodies.
struct SceneFault
{
    std::string m_body;   ///< its name
    std::string m_other;  ///< body that contains it; empty: it has inverted elements
    int m_elements = 0;   ///< number of inverted elements
    double m_depth = 0;   ///< of its deepest point below the surface of m_other [m]
    double m_share = 0;   ///< depth over the size of the smaller body [-]

    /// Describes the fault and its remedy.
    std::string sentence() const;
};

/// Penetration depth above which it is a fault, over the size of the smaller body (cube root of its volume) [-].
constexpr double kDeepestShare = 0.05;

/// Finds soft bodies with inverted elements, and pairs of bodies, at least one of them soft, that overlap deeper than
/// kDeepestShare. Excluded are pairs whose contact an anchor disables, pairs connected by welds, and pairs where one
/// body has nodes pinned inside the other. The frames must show the world's present state.
std::vector<SceneFault> findFaults(const SceneWorld& world, const SceneFrames& frames);

}  // namespace bullet_fem
