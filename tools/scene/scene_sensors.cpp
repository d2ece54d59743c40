// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/scene_sensors.h"

#include <stdexcept>
#include <utility>

#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/btFemVectors.h"

namespace bullet_fem
{
namespace
{

std::vector<int> heldNodes(const btSoftBody& body, const SceneSensor& from, const btRigidBody* to)
{
    std::vector<int> nodes;
    for (int k = 0; to && k < body.m_anchors.size(); ++k)
        if (body.m_anchors[k].m_body == to) nodes.push_back(int(body.m_anchors[k].m_node - &body.m_nodes[0]));
    for (int i = 0; !to && i < body.m_nodes.size(); ++i)
        if (body.m_nodes[i].m_im == 0 && (from.m_everywhere || from.m_box.contains(vec3(body.m_nodes[i].m_x))))
            nodes.push_back(i);
    return nodes;
}

}  // namespace

void SceneSensors::add(const SceneSensor& from, const std::vector<btSoftBody*>& bodies, const btRigidBody* to)
{
    Sensor sensor = {&from, to, {}, {}};
    int count = 0;
    for (const btSoftBody* body : bodies)
    {
        sensor.m_parts.push_back({body, heldNodes(*body, from, to)});
        for (const int node : sensor.m_parts.back().m_nodes) sensor.m_about += vec3(body->m_nodes[node].m_x), ++count;
    }
    if (count == 0)
        throw std::runtime_error("the sensor '" + from.m_name + "' finds no node of '" + from.m_body + "' that is " +
                                 (to ? "anchored to '" + from.m_to + "'; add an anchor"
                                     : std::string("pinned there; add 'pins', or move or enlarge its box")));
    sensor.m_about = from.m_placed ? from.m_about : (1. / count) * sensor.m_about;
    m_sensors.push_back(std::move(sensor));
}

SceneReaction SceneSensors::read(const btFemSoftBodySolver& fem, int k) const
{
    const Sensor& sensor = m_sensors[k];
    const btVector3 about = bulletVector(sensor.m_about);
    SceneReaction sum;
    for (const Part& part : sensor.m_parts)
    {
        const btFemReaction reaction =
            sensor.m_to ? fem.anchorReaction(part.m_body, sensor.m_to, about)
                        : fem.reaction(part.m_body, part.m_nodes.data(), int(part.m_nodes.size()), about);
        sum.m_force += vec3(reaction.m_force);
        sum.m_moment += vec3(reaction.m_moment);
    }
    return sum;
}

}  // namespace bullet_fem
