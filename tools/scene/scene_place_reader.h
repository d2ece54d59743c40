// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "tools/scene/json_cursor.h"
#include "tools/scene/scene_description.h"

namespace bullet_fem
{

inline SceneBox readBox(const JsonCursor& at)
{
    const JsonRange place = {-1e6, 1e6};
    at.onlyMembers({"low", "high"});
    const SceneBox box = {at["low"].vector(place), at["high"].vector(place)};
    for (int i = 0; i < 3; ++i)
        if (box.m_low[i] > box.m_high[i]) at.fail("has a 'low' above its 'high'");
    return box;
}

/// Reads radius and height of a cylinder or capsule [m].
inline void readRound(const JsonCursor& at, double& radius, double& height)
{
    const JsonRange length = {0, 1e6, true};
    at.onlyMembers({"radius", "height"});
    radius = at["radius"].number(length);
    height = at["height"].number(length);
}

inline void readPose(const JsonCursor& at, ScenePose& pose)
{
    at.read("position", {-1e6, 1e6}, pose.m_position);
    if (!at.has("rotation")) return;
    const JsonCursor rotation = at["rotation"];
    rotation.onlyMembers({"axis", "degrees"});
    pose.m_axis = rotation["axis"].direction();
    pose.m_angle = rotation["degrees"].number({-3600, 3600}) * 3.14159265358979323846 / 180;
}

}  // namespace bullet_fem
