// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "tools/pictures/camera.h"
#include "tools/scene/scene_world.h"

namespace bullet_fem
{

/// The mouse's hold on a soft body: an implicit spring from what it hit to where the mouse is.
class SceneHold
{
public:
    /// The world must live longer.
    explicit SceneHold(SceneWorld& world) : m_world(world) {}

    /// Takes what the ray hits first; false if that is no soft body.
    bool begin(const PictureRay& ray);
    void move(const PictureRay& ray);
    void end();

private:
    SceneWorld& m_world;
    btSoftBody* m_held = nullptr;
    int m_spring = 0;
    double m_distance = 0;  // from the eye [m]
};

}  // namespace bullet_fem
