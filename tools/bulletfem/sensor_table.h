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

/// Readings of a scene's sensors in a run: a table with a line a step, and the last and largest values. Nothing is
/// written where there are no sensors.
class SensorTable
{
public:
    /// The world must live longer. Throws std::runtime_error if sensors.csv cannot be made in the folder, which must be
    /// there.
    SensorTable(const SceneWorld& world, const std::string& folder);

    /// After a step.
    void take();
    /// Gives the file its name, and adds that to the files.
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
