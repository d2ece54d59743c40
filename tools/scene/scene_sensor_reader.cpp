// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/scene_sensor_reader.h"

#include "tools/scene/scene_place_reader.h"

namespace bullet_fem
{

SceneSensor readSensor(const JsonCursor& at)
{
    at.onlyMembers({"name", "body", "nodes", "to", "about"});
    SceneSensor sensor;
    sensor.m_name = at["name"].text();
    sensor.m_body = at["body"].text();
    if (at.has("nodes") && at.has("to"))
        at["nodes"].fail("is given with 'to', whose anchors are meant; give one of them");
    if (at.has("to")) sensor.m_to = at["to"].text();
    sensor.m_everywhere = !at.has("nodes");
    if (at.has("nodes")) sensor.m_box = readBox(at["nodes"]);
    sensor.m_placed = at.has("about");
    at.read("about", {-1e6, 1e6}, sensor.m_about);
    return sensor;
}

}  // namespace bullet_fem
