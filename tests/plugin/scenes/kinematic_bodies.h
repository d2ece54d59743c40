// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "plugin/scenes/soft_boxes.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{

/// A kinematic box with these edges [m], moved by its motion state.
inline btRigidBody& addKinematicBox(SoftWorld& world, const Vec3& size, const btTransform& pose, btScalar friction = 1)
{
    RigidSettings settings;
    settings.m_transform = pose;
    settings.m_friction = friction;
    btRigidBody& box = addRigidBox(world, size, settings);
    box.setCollisionFlags(box.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    return box;
}

/// A modulus 10^n [Pa] and a time step [s] in the names of tests.
inline std::string nameOfYoung(double young)
{
    return "1e" + std::to_string(std::lround(std::log10(young))) + "Pa";
}
inline std::string nameOfStep(double step)
{
    return std::to_string(std::lround(1 / step)) + "Hz";
}

}  // namespace bullet_fem
