// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/scene_simulation.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/btFemRay.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/baked/baked_body.h"

namespace bullet_fem
{
namespace
{

enum Parameter
{
    kYoung,
    kPoisson,
    kDamping,
    kGravity
};

constexpr double kPull = 20;  // weights of the body that the mouse pulls with at most

}  // namespace

SceneSimulation::SceneSimulation(SceneWorld& world)
    : m_world(world), m_frames(world), m_painter(world, m_frames), m_gravity(norm(world.description().m_gravity))
{
    for (const SceneSoftBody& body : world.description().m_softBodies)
        m_materials.push_back(body.m_mesh.m_kind == SceneMesh::Kind::baked
                                  ? inspectBakedBody(body.m_mesh.m_path).m_material
                                  : body.m_material);
}

void SceneSimulation::step()
{
    m_world.step();
}

const PictureScene& SceneSimulation::scene()
{
    m_frames.update();
    const SceneSnapshot snapshot = snapshotOf(m_world, m_frames);
    const double wanted = m_world.description().m_pictures.m_hottest;
    m_hottest = std::max(m_hottest, hottestOf({snapshot}));
    m_painter.setHottest(wanted > 0 ? wanted : m_hottest);
    m_largestForce = std::max(m_largestForce, largestForceOf({snapshot}));
    if (m_largestForce > 0) m_painter.setLargestForce(m_largestForce);
    return m_painter.paint(snapshot);
}

bool SceneSimulation::beginDrag(const PictureRay& ray)
{
    endDrag();
    const btVector3 from = bulletVector(ray.m_from), to = bulletVector(ray.m_to);
    btFemRayHit nearest, hit;
    for (int i = 0; i < m_world.softCount(); ++i)
        if (btFemRay::test(&m_world.soft(i), from, to, &hit) && hit.m_fraction < nearest.m_fraction)
        {
            nearest = hit;
            m_held = &m_world.soft(i);
        }
    if (!m_held) return false;
    const double mass = m_held->getTotalMass(), rate = 10;  // [1/s]: follows the mouse within a tenth of a second
    btFemSpring spring = btFemSpring::at(nearest);
    spring.m_stiffness = btScalar(mass * rate * rate);
    spring.m_damping = btScalar(mass * rate);
    spring.m_maxForce = btScalar(kPull * mass * std::max(1.0, m_gravity));
    m_spring = m_world.fem().addSpring(m_held, spring);
    m_holdDistance = norm(vec3(nearest.m_point) - ray.m_from);
    m_held->activate();
    return true;
}

void SceneSimulation::moveDrag(const PictureRay& ray)
{
    if (!m_held) return;
    const Vec3 along = ray.m_to - ray.m_from;
    m_world.fem().setSpringTarget(m_held, m_spring, bulletVector(ray.m_from + (m_holdDistance / norm(along)) * along));
    m_held->activate();
}

void SceneSimulation::endDrag()
{
    if (m_held) m_world.fem().removeSpring(m_held, m_spring);
    m_held = nullptr;
}

std::vector<ViewerParameter> SceneSimulation::parameters() const
{
    const Material first = m_materials.empty() ? Material() : m_materials[0];
    std::vector<ViewerParameter> all(4);
    all[kYoung] = {"Young's modulus", "Pa", first.m_youngModulus, 1e3, 1e10, true};
    all[kPoisson] = {"Poisson's ratio", "", first.m_poissonRatio, 0, 0.49, false};
    all[kDamping] = {"Stiffness damping", "s", first.m_stiffnessDamping, 0, 0.1, false};
    all[kGravity] = {"Gravity", "m/s\u00b2", m_gravity, 0, 30, false};
    return all;
}

void SceneSimulation::setParameter(std::size_t index, double value)
{
    switch (index)
    {
        case kYoung:
            return setMaterials(&Material::m_youngModulus, value);
        case kPoisson:
            return setMaterials(&Material::m_poissonRatio, value);
        case kDamping:
            return setMaterials(&Material::m_stiffnessDamping, value);
        case kGravity:
            m_gravity = value;
            return applyGravity();
        default:
            return;
    }
}

void SceneSimulation::setMaterials(double Material::*member, double value)
{
    for (int i = 0; i < m_world.softCount(); ++i)
    {
        m_materials[i].*member = value;
        btFemMaterial material = materialOf(m_materials[i]);
        material.m_density = 0;  // masses stay
        m_world.fem().setMaterial(&m_world.soft(i), material);
        m_world.soft(i).activate();
    }
}

void SceneSimulation::applyGravity()
{
    const Vec3& given = m_world.description().m_gravity;
    const double length = norm(given);
    const btVector3 gravity = bulletVector(length > 0 ? (m_gravity / length) * given : Vec3{0, -m_gravity, 0});
    m_world.world().setGravity(gravity);  // of rigid bodies, too
    m_world.world().getWorldInfo().m_gravity = gravity;
    for (int i = 0; i < m_world.softCount(); ++i) m_world.soft(i).activate();
}

std::string SceneSimulation::status() const
{
    int tets = 0, contacts = 0;
    for (int i = 0; i < m_world.softCount(); ++i)
    {
        const btFemStepReport& report = m_world.fem().stepReport(&m_world.soft(i));
        tets += report.m_tets;
        contacts += report.m_contacts;
    }
    char text[96];
    std::snprintf(text, sizeof text, "%.2f s, %d tetrahedra, %d contact points", m_world.time(), tets, contacts);
    return text;
}

}  // namespace bullet_fem
