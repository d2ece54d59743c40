// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/scene_actuator_reader.h"

#include "tools/scene/scene_curve_reader.h"
#include "tools/scene/scene_place_reader.h"

namespace bullet_fem
{
namespace
{

void readChamber(const JsonCursor& at, SceneActuator& actuator)
{
    at.onlyMembers({"kind", "body", "cavity", "pressure", "sealedFrom"});
    at.read("cavity", 0, 1000, actuator.m_cavity);
    actuator.m_value = readCurve(at["pressure"], {-101325, 1e8});
    at.read("sealedFrom", {0, 1e30}, actuator.m_sealedFrom);
}

void readCable(const JsonCursor& at, SceneActuator& actuator)
{
    at.onlyMembers({"kind", "body", "through", "tension", "stiffness", "restLength"});
    for (const JsonCursor& point : at["through"].items()) actuator.m_points.push_back(point.vector({-1e6, 1e6}));
    if (actuator.m_points.size() < 2) at["through"].expected("an array of at least two places");
    if (at.has("tension") == at.has("stiffness")) at.fail("must have one of: tension, stiffness");
    if (at.has("tension") && at.has("restLength"))
        at["restLength"].fail("is given, but only a cable with 'stiffness' has one; leave it out");
    at.read("stiffness", {0, 1e12, true}, actuator.m_stiffness);
    actuator.m_value = at.has("tension") ? readCurve(at["tension"], {0, 1e9}) : readCurve(at["restLength"], {0, 1e6});
}

void readRegion(const JsonCursor& at, SceneActuator& actuator)
{
    actuator.m_everywhere = !at.has("region");
    if (!actuator.m_everywhere) actuator.m_box = readBox(at["region"]);
}

}  // namespace

SceneActuator readActuator(const JsonCursor& at)
{
    SceneActuator actuator;
    actuator.m_kind = static_cast<SceneActuator::Kind>(at["kind"].choice({"chamber", "cable", "fibres", "expansion"}));
    switch (actuator.m_kind)
    {
        case SceneActuator::Kind::chamber:
            readChamber(at, actuator);
            break;
        case SceneActuator::Kind::cable:
            readCable(at, actuator);
            break;
        case SceneActuator::Kind::fibres:
            at.onlyMembers({"kind", "body", "region", "direction", "activation"});
            readRegion(at, actuator);
            actuator.m_direction = at["direction"].direction();
            actuator.m_value = readCurve(at["activation"], {-1e13, 1e13});
            break;
        case SceneActuator::Kind::expansion:
            at.onlyMembers({"kind", "body", "region", "strain"});
            readRegion(at, actuator);
            actuator.m_value = readCurve(at["strain"], {-0.9, 9});
            break;
    }
    actuator.m_body = at["body"].text();
    return actuator;
}

}  // namespace bullet_fem
