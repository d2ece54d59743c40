// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

#include "python/core/robot.h"
#include "python/core/world.h"

namespace bullet_fem::python
{

/// The robots of a world, by indices that are never used again.
struct WorldRobots
{
    /// Result of add(): the robot, and the soft bodies of its file.
    struct Added
    {
        int m_robot = -1;
        std::vector<int> m_softBodies;
    };
    /// Throws std::invalid_argument if the world is not of kind 'multibody', and what Robot and addSoft() throw; the
    /// world is unchanged then.
    static Added add(World& world, const UrdfRobot& robot, const btTransform& base, bool isFixed,
                     const std::string& name);
    static Robot& robot(World& world, int index);
    static int count(const World& world);
};

}  // namespace bullet_fem::python
