// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/btFemSoftBodySolver.h"
#include "tools/scene/scene_description.h"

namespace bullet_fem
{

/// The actuators of a scene's bodies and their values over time.
class SceneActuators
{
public:
    /// Adds an actuator to an FEM body. The description must outlive this object. Throws std::invalid_argument or
    /// std::runtime_error if the cavity does not exist or the region has no elements.
    void add(btFemSoftBodySolver& fem, btSoftBody& body, const SceneActuator& from);

    /// Sets the values at a time [s].
    void apply(btFemSoftBodySolver& fem, double time);
    /// Call after the clock was set; `time` is when values were last set [s]. All values are set anew, and chambers
    /// that were sealed later are opened again.
    void begin(double time);

private:
    struct Actuator
    {
        const SceneActuator* m_from;
        btSoftBody* m_body;
        std::vector<int> m_handles;  // several if the actuator drives all cavities
        double m_now = 0;            // present value
        bool m_isSealed = false;
    };
    std::vector<Actuator> m_actuators;
};

}  // namespace bullet_fem
