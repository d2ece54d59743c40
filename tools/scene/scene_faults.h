// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

#include "tools/scene/scene_frames.h"

namespace bullet_fem
{

/// A fault of the state of bodies.
struct SceneFault
{
    std::string m_body;   ///< its name
    std::string m_other;  ///< the body that it is in; empty: it has elements that are inside out
    int m_elements = 0;   ///< that are inside out
    double m_depth = 0;   ///< of its deepest point below the other's surface [m]
    double m_share = 0;   ///< the depth over the size of the smaller of both [-]

    /// The fault, and its remedy.
    std::string sentence() const;
};

/// How deep one body may be in another: share of the size of the smaller one, the cube root of its volume [-].
constexpr double kDeepestShare = 0.05;

/// Soft bodies with elements that are inside out, and pairs of bodies, one of them soft at least, that are deeper in
/// each other than that share. Left out are pairs whose contact an anchor switches off, pairs that hang together by
/// welds, and those of which one has pinned nodes in the other. The frames must be those of the world as it is.
std::vector<SceneFault> findFaults(const SceneWorld& world, const SceneFrames& frames);

}  // namespace bullet_fem
