// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bullet_fem/fem/common/vec3.h"
#include "demos/compare/compared_sides.h"

namespace bullet_fem
{

/// The bodies of a scene, without its ground, in the order in which they were added.
struct ComparedBodies
{
    std::vector<btSoftBody*> m_soft;
    std::vector<btRigidBody*> m_rigid;   ///< those that move, all boxes
    const btRigidBody* m_top = nullptr;  ///< of a stack that shall stand
};

/// A scene that both sides play. The ground is y = 0.
struct ComparedScene
{
    std::string m_name;
    double m_seconds;
    Vec3 m_eye, m_target;  ///< the camera's [m]
    double m_fieldOfView;  ///< upwards [rad]
    int m_clusters;        ///< with which Bullet's own does best here, as SpringSettings has them
    std::function<ComparedBodies(ComparedSide& side)> m_build;
};

struct CrateSettings
{
    double m_young = 1e5;     ///< of our side [Pa]
    double m_crateMass = 30;  ///< [kg]
    int m_tets = 3000;        ///< elements wanted
};

/// A crate falls onto a surface, 1 m long, that lies on its side.
ComparedScene crateScene(const std::string& meshFile, const CrateSettings& settings);
/// A box falls onto three cushions with boards on them, `cells` cells wide each: the tower demo, without its ball.
ComparedScene stackScene(double young, int cells);

}  // namespace bullet_fem
