// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fem/common/output_file.h"
#include "tools/bulletfem/figures.h"
#include "tools/scene/scene_world.h"

namespace bullet_fem
{

/// Sensor readings of a run: a table with one line per step, and the last and largest values. Writes nothing for scenes
/// without sensors.
class SensorTable
{
public:
    /// The world must outlive this object. Throws std::runtime_error if sensors.csv cannot be created in the folder,
    /// which must exist.
    SensorTable(const SceneWorld& world, const std::string& folder);

    /// Call after each step.
    void take();
    /// Closes the file under its final name and appends that name to `files`.
    void finish(std::vector<std::string>& files);
    void tell(Figures& figures) const;

private:
    struct Sensor
    {
        SceneReaction m_last;
        double m_largestForce = 0, m_forceAt = 0;    // [N], [s]
        double m_largestMoment = 0, m_momentAt = 0;  // [N m], [s]
    };
    const SceneWorld& m_world;
    std::unique_ptr<OutputFile> m_file;  // null: no sensors
    std::vector<Sensor> m_sensors;
};

}  // namespace bullet_fem
