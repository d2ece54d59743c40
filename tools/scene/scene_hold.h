// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "tools/pictures/camera.h"
#include "tools/scene/scene_world.h"

namespace bullet_fem
{

/// Mouse drag of a soft body: an implicit spring from the picked point to the mouse position.
class SceneHold
{
public:
    /// The world must outlive this object.
    explicit SceneHold(SceneWorld& world) : m_world(world) {}

    /// Picks the first body on the ray; returns false unless it is a soft body.
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
