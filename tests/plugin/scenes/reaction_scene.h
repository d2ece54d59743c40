// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{

/// The momentum balance of a FEM body with fixed nodes from its first step on, in steps of kStep.
class ReactionBalance
{
public:
    /// `mass` of each node, fixed ones included [kg].
    ReactionBalance(const btFemSoftBodySolver& fem, const btSoftBody& body, std::vector<double> mass)
        : m_fem(fem), m_body(body), m_mass(std::move(mass))
    {
        note();
    }

    /// Call before a step.
    void note()
    {
        m_linear = m_angular = {};
        addMomentum(1);
        m_linear = -m_linear;
        m_angular = -m_angular;
    }

    /// After the step: change of momentum / h - gravity - reactions - contacts - anchors; moments about the origin.
    /// Mass damping [1/s] acts on velocities of the nodes, by default those at the end.
    struct Error
    {
        Vec3 m_force, m_moment;
    };
    Error error(double massDamping = 0, const std::vector<Vec3>& velocity = {})
    {
        addMomentum(1);
        Error e = {(1 / double(kStep)) * m_linear, (1 / double(kStep)) * m_angular};
        const auto subtract = [&e](const Vec3& point, const Vec3& force)
        {
            e.m_force = e.m_force - force;
            e.m_moment = e.m_moment - cross(point, force);
        };
        for (int i = 0; i < m_body.m_nodes.size(); ++i)
        {
            const btSoftBody::Node& node = m_body.m_nodes[i];
            const Vec3 damped = velocity.empty() ? vec3(node.m_v) : velocity[i];
            subtract(0.5 * (vec3(node.m_q) + vec3(node.m_x)),
                     m_mass[i] * (Vec3{0, 0, -kGravity} - massDamping * damped));
        }
        const btFemReaction held = m_fem.reaction(&m_body, btVector3(0, 0, 0));
        e.m_force = e.m_force - vec3(held.m_force);
        e.m_moment = e.m_moment - vec3(held.m_moment);
        const btAlignedObjectArray<btFemContact>& contacts = m_fem.contacts(&m_body);
        for (int k = 0; k < contacts.size(); ++k)
            subtract(vec3(contacts[k].m_point), (1 / double(kStep)) * vec3(contacts[k].m_impulse));
        const btAlignedObjectArray<btFemAnchorReport>& anchors = m_fem.anchors(&m_body);
        for (int k = 0; k < anchors.size(); ++k)
            subtract(vec3(anchors[k].m_point), (1 / double(kStep)) * vec3(anchors[k].m_impulse));
        return e;
    }

    double weight() const
    {
        double sum = 0;
        for (double m : m_mass) sum += m * kGravity;
        return sum;
    }
    const std::vector<double>& mass() const { return m_mass; }

private:
    void addMomentum(double sign)
    {
        for (int i = 0; i < m_body.m_nodes.size(); ++i)
        {
            const Vec3 p = sign * m_mass[i] * vec3(m_body.m_nodes[i].m_v);
            m_linear += p;
            m_angular += cross(vec3(m_body.m_nodes[i].m_x), p);
        }
    }

    const btFemSoftBodySolver& m_fem;
    const btSoftBody& m_body;
    const std::vector<double> m_mass;
    Vec3 m_linear, m_angular;
};

/// Present masses of the nodes [kg], before they are pinned.
inline std::vector<double> nodeMasses(const btSoftBody& body)
{
    std::vector<double> mass;
    for (int i = 0; i < body.m_nodes.size(); ++i) mass.push_back(1 / double(body.m_nodes[i].m_im));
    return mass;
}

/// Nodes within the box between two corners [m].
inline std::vector<int> nodesWithin(const btSoftBody& body, const Vec3& low, const Vec3& high)
{
    std::vector<int> nodes;
    for (int i = 0; i < body.m_nodes.size(); ++i)
    {
        const Vec3 x = vec3(body.m_nodes[i].m_x);
        bool within = true;
        for (int c = 0; c < 3; ++c) within = within && x[c] > low[c] - 1e-5 && x[c] < high[c] + 1e-5;
        if (within) nodes.push_back(i);
    }
    return nodes;
}

inline void pin(btSoftBody& body, const std::vector<int>& nodes)
{
    for (int i : nodes) body.setMass(i, 0);
}

/// A beam of 2 x 0.5 x 0.5 m along x with its middle at the origin, of 1000 kg/m3.
inline SoftBox shortBeam(btScalar youngModulus = btScalar(1e6))
{
    SoftBox box;
    box.m_size = {2, 0.5, 0.5};
    box.m_cells = {8, 2, 2};
    box.m_youngModulus = youngModulus;
    return box;
}

}  // namespace bullet_fem
