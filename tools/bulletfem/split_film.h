// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/io/glb_film.h"
#include "tools/scene/scene_frames.h"

namespace bullet_fem
{

/// Stores a run whose bodies split, for a film with constant triangles: those of the end of the run. The faces of a
/// crack coincide until it opens.
class SplitFilm
{
public:
    /// Both must outlive this object.
    SplitFilm(const SceneWorld& world, const SceneFrames& frames) : m_world(world), m_frames(frames) {}

    /// True if a body of the scene may split.
    static bool isNeeded(const SceneWorld& world) { return !world.fractures().bodies().empty(); }

    /// Stores the present frames.
    void add();

    /// Call at the end of the run. Throws the exceptions of GlbFilm::addFrame.
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
