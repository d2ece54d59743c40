// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/scenes/contact_scene.h"

#include <numeric>

namespace bullet_fem
{

ContactScene::ContactScene(double young, const Mat3& turn)
    : m_turn(turn),
      m_body(makeBody(makeBox({1, 1, 1}, {2, 2, 2}), elasticMaterial(young, 0.3))),
      m_cache(makeComplianceCache(m_body.m_model))
{
    m_rigidProxies.resize(1);
    for (Vec3& x : m_body.m_state.m_x) x = m_turn * x;
    m_settings.m_step.m_tolerance = 1e-9;
    m_settings.m_step.m_maxIterations = 200;
    m_settings.m_rounds = 4;
    m_settings.m_sweeps = 1000;
}

void ContactScene::touchNode(int node, double gap, double friction)
{
    ContactPoint contact;
    contact.m_soft = {0, {node, node, node}, {1, 0, 0}};
    contact.m_rigidProxy = 0;
    contact.m_point = m_body.m_state.m_x[node];
    contact.m_normal = m_turn * Vec3{0, 0, 1};
    contact.m_gap = gap;
    contact.m_friction = friction;
    m_contacts.push_back(contact);
}

void ContactScene::touchLowerFace(double gap, double friction)
{
    for (int node = 0; node < 9; ++node) touchNode(node, gap, friction);  // the grid's first layer
}

void ContactScene::setVelocity(const Vec3& v)
{
    for (Vec3& vi : m_body.m_state.m_v) vi = m_turn * v;
}

ContactReport ContactScene::solve()
{
    solveFreeMotion(m_body, m_settings.m_step);
    m_problem.m_bodies = {{&m_body, m_cache.get()}};
    return m_solver.solve(m_problem, m_settings);
}

Vec3 ContactScene::relativeVelocity(const ContactPoint& contact) const
{
    Vec3 v = -m_rigidProxies[contact.m_rigidProxy].velocityAt(contact.m_point);
    for (int a = 0; a < 3; ++a) v += contact.m_soft.m_weights[a] * velocity(m_body)[contact.m_soft.m_nodes[a]];
    return v;
}

double ContactScene::softMass() const
{
    return std::accumulate(m_body.m_state.m_mass.begin(), m_body.m_state.m_mass.end(), 0.0);
}

Vec3 ContactScene::totalImpulse() const
{
    Vec3 sum;
    for (const ContactPoint& contact : m_contacts) sum += contact.m_impulse;
    return sum;
}

void makeBall(RigidProxy& rigidProxy, double mass, double radius)
{
    rigidProxy.m_inverseMass = {1 / mass, 1 / mass, 1 / mass};
    rigidProxy.m_inverseInertia = Mat3::diagonal(1 / (0.4 * mass * radius * radius));
}

}  // namespace bullet_fem
