// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/scene_forces.h"

#include <stdexcept>
#include <utility>

#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/btFemFracture.h"
#include "bullet_fem/btFemVectors.h"

namespace bullet_fem
{

void SceneForces::add(const SceneForce& from, btRigidBody& body)
{
    m_forces.push_back({&from, &body, {}, {}});
}

void SceneForces::add(const SceneForce& from, const std::vector<btSoftBody*>& bodies)
{
    Force force = {&from, nullptr, bodies, {}};
    double sum = 0;
    for (btSoftBody* soft : bodies)
        for (int i = 0; i < soft->m_nodes.size(); ++i)
        {
            const btSoftBody::Node& node = soft->m_nodes[i];
            if (node.m_im <= 0 || !(from.m_everywhere || from.m_box.contains(vec3(node.m_x)))) continue;
            force.m_nodes.push_back({soft, i, from.m_everywhere ? 1 / double(node.m_im) : 1.0});
            sum += force.m_nodes.back().m_share;
        }
    if (force.m_nodes.empty())
        throw std::runtime_error("'" + from.m_body +
                                 "': the box of a force holds no free node at the start; move or enlarge it");
    for (Share& node : force.m_nodes) node.m_share /= sum;
    m_forces.push_back(std::move(force));
}

void SceneForces::follow(const btFemSplit& split)
{
    for (Force& force : m_forces)
        for (std::size_t k = 0, before = force.m_nodes.size(); k < before; ++k)
        {
            const Share bore = force.m_nodes[k];
            if (bore.m_soft != split.m_body) continue;
            const auto massOf = [&](int node) { return 1 / double(bore.m_soft->m_nodes[node].m_im); };
            double whole = massOf(bore.m_node);
            for (std::size_t c = 0; c < split.m_copyOf.size(); ++c)
                if (split.m_copyOf[c] == bore.m_node) whole += massOf(split.m_firstNode + int(c));
            force.m_nodes[k].m_share = bore.m_share * massOf(bore.m_node) / whole;
            for (std::size_t c = 0; c < split.m_copyOf.size(); ++c)
            {
                const int copy = split.m_firstNode + int(c);
                if (split.m_copyOf[c] == bore.m_node)
                    force.m_nodes.push_back({bore.m_soft, copy, bore.m_share * massOf(copy) / whole});
            }
        }
}

void SceneForces::apply(double time, double step) const
{
    const double now = time + 1e-6 * step;  // a step that begins at m_to is excluded in spite of rounding
    for (const Force& force : m_forces)
    {
        if (now < force.m_from->m_from || now >= force.m_from->m_to) continue;
        if (force.m_rigid)
        {
            force.m_rigid->activate();
            force.m_rigid->applyCentralForce(bulletVector(force.m_from->m_force));
        }
        for (btSoftBody* soft : force.m_soft) soft->activate();
        for (const Share& node : force.m_nodes)
            node.m_soft->addForce(bulletVector(node.m_share * force.m_from->m_force), node.m_node);
    }
}

}  // namespace bullet_fem
