// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/joints/btFemActuatorConversion.h"

#include <stdexcept>
#include <string>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body/soft_body_mesh.h"
#include "bullet_fem/btFemActuators.h"
#include "bullet_fem/btFemVectors.h"
#include "fem/common/attempt.h"

using namespace bullet_fem;

Chamber coreChamber(const btFemChamber& given)
{
    if (given.m_triangles.size() % 3 != 0)
        throw std::invalid_argument("m_triangles has " + std::to_string(given.m_triangles.size()) +
                                    " nodes; give three a triangle");
    Chamber chamber;
    for (std::size_t k = 0; k < given.m_triangles.size(); k += 3)
        chamber.m_triangles.push_back({given.m_triangles[k], given.m_triangles[k + 1], given.m_triangles[k + 2]});
    chamber.m_isSealed = given.m_sealed;
    chamber.m_pressure = given.m_pressure;
    chamber.m_gas = given.m_gas;
    chamber.m_outsidePressure = given.m_outsidePressure;
    return chamber;
}

Cable coreCable(const btFemCable& given)
{
    Cable cable;
    for (const btFemCablePoint& point : given.m_points)
    {
        CablePoint corePoint;
        for (int a = 0; a < 4; ++a)
        {
            corePoint.m_nodes[a] = point.m_nodes[a];
            corePoint.m_weights[a] = point.m_weights[a];
        }
        cable.m_points.push_back(corePoint);
    }
    cable.m_tension = given.m_tension;
    cable.m_stiffness = given.m_stiffness;
    cable.m_restLength = given.m_restLength;
    return cable;
}

Fibres coreFibres(const btFemFibres& given)
{
    Fibres fibres;
    fibres.m_elements = given.m_tets;
    for (const btVector3& direction : given.m_directions) fibres.m_directions.push_back(vec3(direction));
    fibres.m_activation = given.m_activation;
    return fibres;
}

Expansion coreExpansion(const btFemExpansion& given)
{
    Expansion expansion;
    expansion.m_elements = given.m_tets;
    expansion.m_strain = given.m_strain;
    return expansion;
}

bool btFemChamber::find(const btSoftBody* body, std::vector<btFemChamber>& cavities, std::string* why)
{
    const auto search = [&]
    {
        cavities.clear();
        if (!body || body->m_tetras.size() == 0)
            throw std::invalid_argument(
                "btFemChamber::find: the soft body is null or has no tetrahedra; make it with btFemHelpers");
        for (const std::vector<Triangle>& triangles : findCavities(tetMeshOf(*body)))
        {
            btFemChamber chamber;
            for (const Triangle& t : triangles)
                chamber.m_triangles.insert(chamber.m_triangles.end(), t.begin(), t.end());
            cavities.push_back(chamber);
        }
    };
    return attempt(why, search);
}
