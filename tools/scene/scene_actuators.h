// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/btFemSoftBodySolver.h"
#include "tools/scene/scene_description.h"

namespace bullet_fem
{

/// The actuators of a scene's bodies, in motion.
class SceneActuators
{
public:
    /// Adds one to a body that is FEM. The description must live longer. Throws std::invalid_argument or
    /// std::runtime_error: a cavity that the body has not, a region without elements.
    void add(btFemSoftBodySolver& fem, btSoftBody& body, const SceneActuator& from);

    /// Sets the values of a time [s].
    void apply(btFemSoftBodySolver& fem, double time);
    /// The clock was set, and `time` was when values were set last [s]: all are set anew, and chambers that were sealed
    /// later are open again.
    void begin(double time);

private:
    struct Actuator
    {
        const SceneActuator* m_from;
        btSoftBody* m_body;
        std::vector<int> m_handles;  // more than one of all cavities
        double m_now = 0;            // the value that it has
        bool m_isSealed = false;
    };
    std::vector<Actuator> m_actuators;
};

}  // namespace bullet_fem
