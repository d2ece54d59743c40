// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/rigid/impact_patches.h"

#include <algorithm>
#include <utility>

#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "bullet_fem/bullet_bridge/vectors.h"
#include "bullet_fem/fem/step/stress.h"

namespace bullet_fem
{

bool ImpactScene::isPair(const ContactPoint& c) const
{
    return c.m_other.m_body >= 0 ? c.m_other.m_body != c.m_soft.m_body
                                 : c.m_rigidProxy < static_cast<int>(m_rigid.rigidProxies().size());
}

double ImpactScene::approachOf(const ContactPoint& c) const
{
    const auto velocityOf = [&](const SurfacePoint& point)
    { return point.of(m_bodies[point.m_body]->m_body.m_state.m_v); };
    const Vec3 other =
        c.m_other.m_body >= 0 ? velocityOf(c.m_other) : before(c.m_rigidProxy).velocityAt(c.m_point + c.m_approach);
    return dot(c.m_normal, other - velocityOf(c.m_soft));
}

int ImpactScene::componentOf(const SurfacePoint& point) const
{
    return m_bodies[point.m_body]->m_body.m_model->mesh().nodeComponent()[point.m_nodes[0]];
}

RigidProxy ImpactScene::before(int rigidProxy) const
{
    RigidProxy proxy = m_rigid.rigidProxies()[rigidProxy];
    const btRigidBody* body = movableBody(m_rigid.object(rigidProxy));
    const LinkMotion motion = body ? LinkMotion{vec3(body->getLinearVelocity()), vec3(body->getAngularVelocity())}
                                   : m_rigid.motionNow(rigidProxy);
    proxy.m_linearVelocity = motion.m_linear;
    proxy.m_angularVelocity = motion.m_angular;
    return proxy;
}

double ImpactPatches::impedanceOf(const ImpactScene& scene, int body)
{
    double& impedance = m_impedances[body];
    if (impedance == 0) impedance = waveImpedance(scene.m_bodies[body]->m_body);
    return impedance;
}

void ImpactPatches::findStresses(const ImpactScene& scene, double least)
{
    m_stresses.assign(scene.m_bodies.size(), 0);
    m_impedances.assign(scene.m_bodies.size(), 0);
    for (const ContactPoint& c : scene.m_problem.m_contacts)
    {
        if (!(dot(c.m_impulse, c.m_normal) > 0) || !scene.isPair(c)) continue;
        const double speed = scene.approachOf(c);
        if (!(speed > least)) continue;
        const int body = c.m_soft.m_body, other = c.m_other.m_body;
        const double own = impedanceOf(scene, body);
        if (other < 0)
        {
            m_stresses[body] = std::max(m_stresses[body], speed * own);
            continue;
        }
        const double its = impedanceOf(scene, other), stress = speed * own * its / (own + its);
        for (const int side : {body, other}) m_stresses[side] = std::max(m_stresses[side], stress);
    }
}

// True if a body rebounds by its elasticity: it has impacts, or one begins.
bool ImpactPatches::anyMeets(const ImpactScene& scene)
{
    if (!m_isElastic) return false;
    bool any = false;
    for (std::size_t b = 0; b < scene.m_bodies.size(); ++b)
    {
        any = any || !scene.m_bodies[b]->m_memory.m_impacts.empty() || m_stresses[b] > 0;
        m_impulses.reserve(scene.m_bodies[b]->m_body.m_state.m_x.size());
    }
    return any;
}

// The empty patch of a contact. Between two soft bodies, the one of smaller broadphase id keeps the impact.
ImpactPatch ImpactPatches::patchOf(const ImpactScene& scene, const ContactPoint& c)
{
    const std::vector<FemSoftBody*>& bodies = scene.m_bodies;
    ImpactPatch patch;
    patch.m_body = c.m_soft.m_body;
    patch.m_component = scene.componentOf(c.m_soft);
    patch.m_rigidProxy = c.m_rigidProxy;
    if (c.m_other.m_body < 0) return patch;
    patch.m_otherBody = c.m_other.m_body;
    patch.m_otherComponent = scene.componentOf(c.m_other);
    if (broadphaseId(*bodies[patch.m_otherBody]->m_softBody) < broadphaseId(*bodies[patch.m_body]->m_softBody))
    {
        std::swap(patch.m_body, patch.m_otherBody);
        std::swap(patch.m_component, patch.m_otherComponent);
    }
    return patch;
}

void ImpactPatches::gather(const ImpactScene& scene, double least)
{
    findStresses(scene, least);
    m_patches.clear();
    const bool anyMeets = this->anyMeets(scene);
    for (const ContactPoint& c : scene.m_problem.m_contacts)
    {
        if (!scene.isPair(c)) continue;
        if (!(c.m_restitution > 0) && !anyMeets) continue;
        const ImpactPatch patch = patchOf(scene, c);
        const Vec3 normal = patch.m_body == c.m_soft.m_body ? c.m_normal : -c.m_normal;
        auto found =
            std::find_if(m_patches.rbegin(), m_patches.rend(), [&](const ImpactPatch& p) { return p.isOf(patch); });
        if (found == m_patches.rend())
        {
            m_patches.push_back(patch);
            found = m_patches.rbegin();
        }
        const double push = dot(c.m_impulse, c.m_normal);
        found->m_restitution = std::max(found->m_restitution, c.m_restitution);
        if (!(push > 0)) continue;
        found->m_push += push;
        found->m_point += push * (c.m_point + c.m_approach);
        found->m_normal += push * normal;
    }
}

// Adds the response of a soft side. False if its elasticity is not known.
bool ImpactPatches::addSide(const ImpactScene& scene, const ImpactPatch& patch, int body, PatchResponse& response)
{
    Body& soft = scene.m_bodies[body]->m_body;
    const double size = norm(patch.m_normal);
    m_impulses.assign(soft.m_state.m_x.size(), Vec3());
    for (const ContactPoint& c : scene.m_problem.m_contacts)
    {
        const double push = dot(c.m_impulse, c.m_normal);
        if (!(push > 0) || !scene.isPair(c) || !patch.isOf(patchOf(scene, c))) continue;
        const bool isSoft = c.m_soft.m_body == body;
        const SurfacePoint& point = isSoft ? c.m_soft : c.m_other;
        const Vec3 impulse = ((isSoft ? push : -push) / size) * c.m_normal;
        for (int k = 0; k < point.m_count; ++k) m_impulses[point.m_nodes[k]] += point.m_weights[k] * impulse;
    }
    return addVibrations(soft, m_impulses, response);
}

bool ImpactPatches::addResponse(const ImpactScene& scene, const ImpactPatch& patch, PatchResponse& response)
{
    return addSide(scene, patch, patch.m_body, response) &&
           (patch.m_otherBody < 0 || addSide(scene, patch, patch.m_otherBody, response));
}

}  // namespace bullet_fem
