// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/scene_forces.h"

#include <stdexcept>
#include <utility>

#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "BulletSoftBody/btSoftBody.h"
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

void SceneForces::apply(double time, double step) const
{
    const double now = time + 1e-6 * step;  // steps that begin at a force's end are after it
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
