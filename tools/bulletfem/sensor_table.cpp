// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/bulletfem/sensor_table.h"

#include <cstdio>

namespace bullet_fem
{
namespace
{

// Quotes a table cell [RFC 4180].
std::string quoted(const std::string& text)
{
    std::string cell = "\"";
    for (const char c : text) cell += c == '"' ? std::string("\"\"") : std::string(1, c);
    return cell + '"';
}

nlohmann::json jsonOf(const Vec3& v)
{
    return {v.x, v.y, v.z};
}

}  // namespace

SensorTable::SensorTable(const SceneWorld& world, const std::string& folder)
    : m_world(world), m_sensors(static_cast<std::size_t>(world.sensors().count()))
{
    if (m_sensors.empty()) return;
    m_file = std::make_unique<OutputFile>(folder + "/sensors.csv");
    std::string line = "time [s]";
    for (int k = 0; k < world.sensors().count(); ++k)
        for (const char* column :
             {"force x [N]", "force y [N]", "force z [N]", "moment x [N m]", "moment y [N m]", "moment z [N m]"})
            line += ',' + quoted(world.sensors().name(k) + ' ' + column);
    line += '\n';
    m_file->write(line.data(), line.size());
}

void SensorTable::take()
{
    if (!m_file) return;
    char number[32];
    std::string line(number, static_cast<std::size_t>(std::snprintf(number, sizeof number, "%.9g", m_world.time())));
    for (int k = 0; k < m_world.sensors().count(); ++k)
    {
        Sensor& sensor = m_sensors[k];
        sensor.m_last = m_world.sensors().read(m_world.fem(), k);
        const double force = norm(sensor.m_last.m_force), moment = norm(sensor.m_last.m_moment);
        if (force > sensor.m_largestForce) sensor.m_largestForce = force, sensor.m_forceAt = m_world.time();
        if (moment > sensor.m_largestMoment) sensor.m_largestMoment = moment, sensor.m_momentAt = m_world.time();
        for (const Vec3& v : {sensor.m_last.m_force, sensor.m_last.m_moment})
            for (int c = 0; c < 3; ++c)
                line.append(number, static_cast<std::size_t>(std::snprintf(number, sizeof number, ",%.9g", v[c])));
    }
    line += '\n';
    m_file->write(line.data(), line.size());
}

void SensorTable::finish(std::vector<std::string>& files)
{
    if (!m_file) return;
    m_file->commit();
    files.push_back(m_file->path());
}

void SensorTable::tell(Figures& figures) const
{
    if (!m_file) return;
    nlohmann::json all = nlohmann::json::object();
    for (int k = 0; k < m_world.sensors().count(); ++k)
    {
        const Sensor& sensor = m_sensors[k];
        all[m_world.sensors().name(k)] = {
            {"force", jsonOf(sensor.m_last.m_force)},      {"moment", jsonOf(sensor.m_last.m_moment)},
            {"about", jsonOf(m_world.sensors().about(k))}, {"largestForce", sensor.m_largestForce},
            {"largestForceAt", sensor.m_forceAt},          {"largestMoment", sensor.m_largestMoment},
            {"largestMomentAt", sensor.m_momentAt}};
    }
    figures.add("sensors", all, "N, N m, s");
}

}  // namespace bullet_fem
