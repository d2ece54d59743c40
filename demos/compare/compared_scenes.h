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

/// The bodies of a scene without its ground, in the order of their creation.
struct ComparedBodies
{
    std::vector<btSoftBody*> m_soft;
    std::vector<btRigidBody*> m_rigid;   ///< moving bodies, all boxes
    const btRigidBody* m_top = nullptr;  ///< top of a stack that should stand
};

/// A scene for both sides. The ground is y = 0.
struct ComparedScene
{
    std::string m_name;
    double m_seconds;
    Vec3 m_eye, m_target;  ///< of the camera [m]
    double m_fieldOfView;  ///< vertical [rad]
    int m_clusters;        ///< best number of clusters for Bullet's own soft bodies (see SpringSettings)
    std::function<ComparedBodies(ComparedSide& side)> m_build;
};

struct CrateSettings
{
    double m_young = 1e5;     ///< of BulletFEM's side [Pa]
    double m_crateMass = 30;  ///< [kg]
    int m_tets = 3000;        ///< desired number of elements
};

/// A crate falls onto a surface of 1 m length that lies on its side.
ComparedScene crateScene(const std::string& meshFile, const CrateSettings& settings);
/// A box falls onto a stack of three cushions and boards, `cells` cells wide each: the tower demo without its ball.
ComparedScene stackScene(double young, int cells);

}  // namespace bullet_fem
