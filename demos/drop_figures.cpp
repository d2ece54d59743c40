// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "demos/drop_figures.h"

#include <algorithm>
#include <set>
#include <utility>

#include "BulletSoftBody/btSoftBody.h"

namespace bullet_fem
{
namespace
{

Vec3 vec3(const btVector3& v)
{
    return {v.x(), v.y(), v.z()};
}

Vec3 momentumOf(const btSoftBody& body)
{
    Vec3 p;
    for (int i = 0; i < body.m_nodes.size(); ++i) p += vec3(body.m_nodes[i].m_v) * (1.0 / body.m_nodes[i].m_im);
    return p;
}

double energyOf(const btSoftBody& body, const Vec3& g)
{
    double sum = 0;
    for (int i = 0; i < body.m_nodes.size(); ++i)
    {
        const Vec3 v = vec3(body.m_nodes[i].m_v);
        sum += (dot(v, v) / 2 - dot(g, vec3(body.m_nodes[i].m_x))) / body.m_nodes[i].m_im;
    }
    return sum;
}

double energyOf(const btRigidBody& body, const Vec3& g)
{
    if (body.getInvMass() == 0) return 0;
    const Vec3 v = vec3(body.getLinearVelocity());
    const Vec3 spin = vec3(body.getAngularVelocity() * body.getWorldTransform().getBasis());  // in the body's axes
    const Vec3 inertia = vec3(body.getLocalInertia());
    const double rotation = inertia.x * spin.x * spin.x + inertia.y * spin.y * spin.y + inertia.z * spin.z * spin.z;
    return (dot(v, v) / 2 - dot(g, vec3(body.getWorldTransform().getOrigin()))) / body.getInvMass() + rotation / 2;
}

double sixVolumes(const btSoftBody::Tetra& tet)
{
    const Vec3 x0 = vec3(tet.m_n[0]->m_x);
    const Vec3 a = vec3(tet.m_n[1]->m_x) - x0, b = vec3(tet.m_n[2]->m_x) - x0, c = vec3(tet.m_n[3]->m_x) - x0;
    return dot(cross(a, b), c);
}

}  // namespace

void Statistic::add(double value)
{
    m_largest = m_count == 0 ? value : std::max(m_largest, value);
    m_sum += value;
    ++m_count;
}

DropFigures::DropFigures(const DropScene& scene) : m_scene(scene)
{
    const btSoftBody& body = scene.softBody();
    for (int i = 0; i < body.m_nodes.size(); ++i) m_mass += 1.0 / body.m_nodes[i].m_im;
    for (int e = 0; e < body.m_tetras.size(); ++e) m_restVolumes.push_back(sixVolumes(body.m_tetras[e]));
    m_startMomentum = m_momentum = momentumOf(body);
    recordEnergy();
    m_startEnergy = m_largestEnergy = m_endEnergy;
}

void DropFigures::record(double milliseconds)
{
    m_stepMs.add(milliseconds);
    recordReport();
    recordPenetrations();
    recordMomentum();
    recordEnergy();
    recordHeight();
    recordVolumes();
}

double DropFigures::momentumBalance() const
{
    const Vec3 weight = m_mass * vec3(m_scene.gravity());
    const double seconds = stepCount() * m_scene.stepSize();
    return norm(m_momentum - m_startMomentum - m_impulse - seconds * weight) / (seconds * norm(weight));
}

void DropFigures::recordReport()
{
    const btFemStepReport& report = m_scene.report();
    m_freeMotionMs.add(report.m_freeMotionMs);
    m_contactMs.add(report.m_contactMs);
    m_freeIterations.add(report.m_iterations);
    m_contactIterations.add(report.m_contactIterations);
    m_contacts.add(report.m_contacts);
    m_flags |= report.m_flags;
    m_stepsNotConverged += (report.m_flags & BT_FEM_NOT_CONVERGED) != 0;
}

void DropFigures::recordPenetrations()
{
    const btAlignedObjectArray<btFemContact>& contacts = m_scene.contacts();
    for (int k = 0; k < contacts.size(); ++k)
    {
        double& deepest = contacts[k].m_other->isStaticObject() ? m_penetrationStatic : m_penetrationFalling;
        deepest = std::max(deepest, -double(contacts[k].m_gap));
    }
}

void DropFigures::recordMomentum()
{
    Vec3 impulse;
    const btAlignedObjectArray<btFemContact>& contacts = m_scene.contacts();
    for (int k = 0; k < contacts.size(); ++k) impulse += vec3(contacts[k].m_impulse);
    m_impulse += impulse;

    const Vec3 before = m_momentum, weight = m_scene.stepSize() * m_mass * vec3(m_scene.gravity());
    m_momentum = momentumOf(m_scene.softBody());
    m_softSpeed = norm(m_momentum) / m_mass;
    m_worstStepBalance = std::max(m_worstStepBalance, norm(m_momentum - before - impulse - weight) / norm(weight));
}

void DropFigures::recordEnergy()
{
    const Vec3 g = vec3(m_scene.gravity());
    m_endEnergy = energyOf(m_scene.softBody(), g);
    m_boxSpeed = 0;
    for (const auto& box : m_scene.boxes())
    {
        m_endEnergy += energyOf(*box, g);
        m_boxSpeed = std::max(m_boxSpeed, double(box->getLinearVelocity().length()));
    }
    m_largestEnergy = std::max(m_largestEnergy, m_endEnergy);
}

void DropFigures::recordHeight()
{
    const btSoftBody& body = m_scene.softBody();
    for (int i = 0; i < body.m_nodes.size(); ++i)
        m_lowestHeight = std::min(m_lowestHeight, double(body.m_nodes[i].m_x.y()));
}

void DropFigures::recordVolumes()
{
    const btSoftBody& body = m_scene.softBody();
    for (int e = 0; e < body.m_tetras.size(); ++e)
        m_smallestVolumeRatio = std::min(m_smallestVolumeRatio, sixVolumes(body.m_tetras[e]) / m_restVolumes[e]);
}

long matrixEntries(const btSoftBody& body)
{
    std::set<std::pair<const btSoftBody::Node*, const btSoftBody::Node*>> edges;
    for (int e = 0; e < body.m_tetras.size(); ++e)
        for (int a = 0; a < 4; ++a)
            for (int b = 0; b < a; ++b)
                edges.insert(std::minmax<const btSoftBody::Node*>(body.m_tetras[e].m_n[a], body.m_tetras[e].m_n[b]));
    return 6L * body.m_nodes.size() + 9L * static_cast<long>(edges.size());
}

}  // namespace bullet_fem
