// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/scene_hold.h"

#include <algorithm>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/btFemRay.h"
#include "bullet_fem/btFemVectors.h"

namespace bullet_fem
{
namespace
{

constexpr double kPull = 20;       // maximum force of the mouse, in weights of the body
constexpr double kFollowing = 10;  // [1/s]: follows the mouse within a tenth of a second

}  // namespace

bool SceneHold::begin(const PictureRay& ray)
{
    end();
    const btVector3 from = bulletVector(ray.m_from), to = bulletVector(ray.m_to);
    btFemRayHit nearest, hit;
    for (int i = 0; i < m_world.softCount(); ++i)
        if (btFemRay::test(&m_world.soft(i), from, to, &hit) && hit.m_fraction < nearest.m_fraction)
        {
            nearest = hit;
            m_held = &m_world.soft(i);
        }
    if (!m_held) return false;
    const double mass = m_held->getTotalMass(), gravity = norm(m_world.description().m_gravity);
    btFemSpring spring = btFemSpring::at(nearest);
    spring.m_stiffness = btScalar(mass * kFollowing * kFollowing);
    spring.m_damping = btScalar(mass * kFollowing);
    spring.m_maxForce = btScalar(kPull * mass * std::max(1.0, gravity));
    m_spring = m_world.fem().addSpring(m_held, spring);
    m_distance = norm(vec3(nearest.m_point) - ray.m_from);
    m_held->activate();
    return true;
}

void SceneHold::move(const PictureRay& ray)
{
    if (!m_held) return;
    const Vec3 along = ray.m_to - ray.m_from;
    m_world.fem().setSpringTarget(m_held, m_spring, bulletVector(ray.m_from + (m_distance / norm(along)) * along));
    m_held->activate();
}

void SceneHold::end()
{
    if (m_held) m_world.fem().removeSpring(m_held, m_spring);
    m_held = nullptr;
}

}  // namespace bullet_fem
