// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/scene_actuators.h"

#include <limits>
#include <stdexcept>
#include <string>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/btFemVectors.h"

namespace bullet_fem
{
namespace
{

int nodeNear(const btSoftBody& body, const Vec3& place)
{
    int nearest = 0;
    for (int i = 1; i < body.m_nodes.size(); ++i)
        if (norm(vec3(body.m_nodes[i].m_x) - place) < norm(vec3(body.m_nodes[nearest].m_x) - place)) nearest = i;
    return nearest;
}

// The tetrahedra whose centre is in the box; empty if the actuator acts everywhere.
std::vector<int> tetsIn(const btSoftBody& body, const SceneActuator& from)
{
    std::vector<int> tets;
    for (int e = 0; e < body.m_tetras.size() && !from.m_everywhere; ++e)
    {
        btVector3 middle(0, 0, 0);
        for (const btSoftBody::Node* node : body.m_tetras[e].m_n) middle += node->m_x / 4;
        if (from.m_box.contains(vec3(middle))) tets.push_back(e);
    }
    if (tets.empty() && !from.m_everywhere)
        throw std::runtime_error(
            "the region of an actuator holds no element's middle at the start; move or enlarge it");
    return tets;
}

std::vector<int> addChambers(btFemSoftBodySolver& fem, btSoftBody& body, const SceneActuator& from)
{
    std::vector<btFemChamber> cavities;
    btFemChamber::find(&body, cavities);
    const auto count = static_cast<int>(cavities.size());
    if (count == 0) throw std::runtime_error("it has no cavity for a chamber; give its mesh a closed inner surface");
    if (from.m_cavity >= count)
        throw std::runtime_error("it has no cavity " + std::to_string(from.m_cavity) + " for a chamber, but " +
                                 std::to_string(count) + ", counted from 0");
    std::vector<int> handles;
    for (int k = 0; k < count; ++k)
        if (from.m_cavity < 0 || from.m_cavity == k) handles.push_back(fem.addChamber(&body, cavities[k]));
    return handles;
}

int addCable(btFemSoftBodySolver& fem, btSoftBody& body, const SceneActuator& from)
{
    btFemCable cable;
    for (const Vec3& point : from.m_points) cable.m_points.emplace_back(nodeNear(body, point));
    cable.m_stiffness = btScalar(from.m_stiffness);
    cable.m_restLength = from.m_stiffness > 0 ? btScalar(from.m_value.at(0)) : 0;
    return fem.addCable(&body, cable);
}

int addFibres(btFemSoftBodySolver& fem, btSoftBody& body, const SceneActuator& from)
{
    btFemFibres fibres;
    fibres.m_tets = tetsIn(body, from);
    fibres.m_directions = {bulletVector(from.m_direction)};
    return fem.addFibres(&body, fibres);
}

int addExpansion(btFemSoftBodySolver& fem, btSoftBody& body, const SceneActuator& from)
{
    btFemExpansion expansion;
    expansion.m_tets = tetsIn(body, from);
    return fem.addExpansion(&body, expansion);
}

void setValue(btFemSoftBodySolver& fem, btSoftBody* body, int handle, const SceneActuator& from, double value)
{
    const auto number = btScalar(value);
    switch (from.m_kind)
    {
        case SceneActuator::Kind::chamber:
            fem.setChamberPressure(body, handle, number);
            break;
        case SceneActuator::Kind::cable:
            if (from.m_stiffness > 0)
                fem.setCableRestLength(body, handle, number);
            else
                fem.setCableTension(body, handle, number);
            break;
        case SceneActuator::Kind::fibres:
            fem.setActivation(body, handle, number);
            break;
        case SceneActuator::Kind::expansion:
            fem.setExpansion(body, handle, number);
            break;
    }
}

}  // namespace

void SceneActuators::add(btFemSoftBodySolver& fem, btSoftBody& body, const SceneActuator& from)
{
    Actuator added{&from, &body, {}};
    switch (from.m_kind)
    {
        case SceneActuator::Kind::chamber:
            added.m_handles = addChambers(fem, body, from);
            break;
        case SceneActuator::Kind::cable:
            added.m_handles = {addCable(fem, body, from)};
            break;
        case SceneActuator::Kind::fibres:
            added.m_handles = {addFibres(fem, body, from)};
            break;
        case SceneActuator::Kind::expansion:
            added.m_handles = {addExpansion(fem, body, from)};
            break;
    }
    m_actuators.push_back(std::move(added));
}

void SceneActuators::begin(double time)
{
    for (Actuator& actuator : m_actuators)
    {
        actuator.m_now = std::numeric_limits<double>::quiet_NaN();
        actuator.m_isSealed = time >= actuator.m_from->m_sealedFrom;
    }
}

void SceneActuators::apply(btFemSoftBodySolver& fem, double time)
{
    for (Actuator& actuator : m_actuators)
    {
        const SceneActuator& from = *actuator.m_from;
        if (actuator.m_isSealed) continue;
        if (time >= from.m_sealedFrom)
        {
            for (const int handle : actuator.m_handles) fem.sealChamber(actuator.m_body, handle);
            actuator.m_isSealed = true;
            continue;
        }
        const double value = from.m_value.at(time);
        if (value == actuator.m_now) continue;  // unchanged values must not wake a sleeping body
        for (const int handle : actuator.m_handles) setValue(fem, actuator.m_body, handle, from, value);
        actuator.m_now = value;
    }
}

}  // namespace bullet_fem
