// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/btFemSoftBodySolver.h"
#include "tools/scene/scene_description.h"

namespace bullet_fem
{

/// The springs of a scene, each active for a limited time.
class SceneSprings
{
public:
    /// Adds a spring to an FEM body or, if the body is divided, to the fragment whose surface is nearest to the
    /// spring's point. The description must outlive this object.
    void add(const std::vector<btSoftBody*>& bodies, const SceneSpring& from);

    /// Attaches, moves and releases springs for the step that begins at this time [s].
    void apply(btFemSoftBodySolver& fem, double time);

private:
    struct Spring
    {
        const SceneSpring* m_from;
        btSoftBody* m_body;
        btFemSpring m_spring;
        int m_handle;   // 0: not attached
        Vec3 m_target;  // present target [m]
    };
    std::vector<Spring> m_springs;
};

}  // namespace bullet_fem
