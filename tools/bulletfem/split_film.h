// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/io/glb_film.h"
#include "tools/scene/scene_frames.h"

namespace bullet_fem
{

/// Keeps a run whose bodies split, for a film whose triangles are the same in all frames: those of the run's end. The
/// sides of a crack lie on each other until it opens.
class SplitFilm
{
public:
    /// Both must live longer.
    SplitFilm(const SceneWorld& world, const SceneFrames& frames) : m_world(world), m_frames(frames) {}

    /// True if a body of the scene may split.
    static bool isNeeded(const SceneWorld& world) { return !world.fractures().bodies().empty(); }

    /// The frames as they are now.
    void add();

    /// At the run's end. Throws what GlbFilm::addFrame throws.
    void give(GlbFilm& film);

private:
    struct Frame
    {
        double m_time;  // [s]
        std::vector<BodyFrame> m_bodies;
    };
    void complete(int body, BodyFrame& frame) const;

    const SceneWorld& m_world;
    const SceneFrames& m_frames;
    std::vector<Frame> m_kept;
};

}  // namespace bullet_fem
