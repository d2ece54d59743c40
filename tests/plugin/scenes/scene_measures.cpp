// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/scenes/scene_measures.h"

#include <algorithm>

#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"

namespace bullet_fem
{

namespace
{

double massOf(const btSoftBody::Node& node)
{
    return node.m_im > 0 ? 1 / double(node.m_im) : 0;
}

}  // namespace

Motion& Motion::operator+=(const Motion& b)
{
    m_linear += b.m_linear;
    m_angular += b.m_angular;
    m_energy += b.m_energy;
    return *this;
}

Motion motionOf(const btSoftBody& body)
{
    Motion sum;
    for (int i = 0; i < body.m_nodes.size(); ++i)
    {
        const Vec3 v = vec3(body.m_nodes[i].m_v), p = massOf(body.m_nodes[i]) * v;
        sum += {p, cross(vec3(body.m_nodes[i].m_x), p), 0.5 * dot(p, v)};
    }
    return sum;
}

Motion motionOf(const btRigidBody& body)
{
    const btMatrix3x3& R = body.getWorldTransform().getBasis();
    const btVector3 localSpin = R.transpose() * body.getAngularVelocity();
    const btVector3 spinMomentum = R * (localSpin / body.getInvInertiaDiagLocal());
    const Vec3 v = vec3(body.getLinearVelocity()), p = (1 / double(body.getInvMass())) * v;
    return {p, cross(vec3(body.getCenterOfMassPosition()), p) + vec3(spinMomentum),
            0.5 * dot(p, v) + 0.5 * dot(vec3(spinMomentum), vec3(body.getAngularVelocity()))};
}

double massOf(const btSoftBody& body)
{
    double sum = 0;
    for (int i = 0; i < body.m_nodes.size(); ++i) sum += massOf(body.m_nodes[i]);
    return sum;
}

Vec3 centerOf(const btSoftBody& body)
{
    Vec3 sum;
    for (int i = 0; i < body.m_nodes.size(); ++i) sum += massOf(body.m_nodes[i]) * vec3(body.m_nodes[i].m_x);
    return (1 / massOf(body)) * sum;
}

Vec3 velocityOf(const btSoftBody& body)
{
    return (1 / massOf(body)) * motionOf(body).m_linear;
}

double lowestHeight(const btSoftBody& body)
{
    double lowest = body.m_nodes[0].m_x.z();
    for (int i = 0; i < body.m_nodes.size(); ++i) lowest = std::min(lowest, double(body.m_nodes[i].m_x.z()));
    return lowest;
}

double fastestNode(const btSoftBody& body)
{
    double fastest = 0;
    for (int i = 0; i < body.m_nodes.size(); ++i) fastest = std::max(fastest, norm(vec3(body.m_nodes[i].m_v)));
    return fastest;
}

bool allFinite(const btSoftBody& body)
{
    for (int i = 0; i < body.m_nodes.size(); ++i)
    {
        const btSoftBody::Node& n = body.m_nodes[i];
        if (!isFinite(vec3(n.m_x)) || !isFinite(vec3(n.m_v)) || !isFinite(vec3(n.m_q)) || !isFinite(vec3(n.m_f)))
            return false;
    }
    return true;
}

std::vector<Vec3> edgesOf(const btSoftBody& body)
{
    std::vector<Vec3> edges;
    for (int i = 0; i < body.m_nodes.size(); ++i)
        edges.push_back(vec3(body.m_nodes[i].m_x) - vec3(body.m_nodes[0].m_x));
    return edges;
}

double largestDifference(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    double largest = a.size() == b.size() ? 0 : HUGE_VAL;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) largest = std::max(largest, norm(a[i] - b[i]));
    return largest;
}

std::vector<btScalar> bitsOf(const btSoftBody& body)
{
    std::vector<btScalar> bits;
    for (int i = 0; i < body.m_nodes.size(); ++i)
        for (const btVector3& a : {body.m_nodes[i].m_x, body.m_nodes[i].m_v})
            bits.insert(bits.end(), {a.x(), a.y(), a.z()});
    return bits;
}

std::vector<btScalar> bitsOf(const btRigidBody& body)
{
    std::vector<btScalar> bits;
    const btMatrix3x3& basis = body.getWorldTransform().getBasis();
    for (const btVector3& a : {basis[0], basis[1], basis[2], body.getWorldTransform().getOrigin(),
                               body.getLinearVelocity(), body.getAngularVelocity()})
        bits.insert(bits.end(), {a.x(), a.y(), a.z()});
    return bits;
}

Vec3 impulseOn(const btFemSoftBodySolver& solver, const btSoftBody& body, const btCollisionObject* other)
{
    const btAlignedObjectArray<btFemContact>& contacts = solver.contacts(&body);
    Vec3 sum;
    for (int k = 0; k < contacts.size(); ++k)
        if (!other || contacts[k].m_other == other) sum += vec3(contacts[k].m_impulse);
    return sum;
}

}  // namespace bullet_fem
