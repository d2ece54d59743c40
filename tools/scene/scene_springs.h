// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/btFemSoftBodySolver.h"
#include "tools/scene/scene_description.h"

namespace bullet_fem
{

/// The springs of a scene, which come and go.
class SceneSprings
{
public:
    /// Adds one to a body that is FEM, or, of a body in pieces, to the piece whose surface is nearest to its place. The
    /// description must live longer.
    void add(const std::vector<btSoftBody*>& bodies, const SceneSpring& from);

    /// Holds, moves and lets go what the step that begins at this time [s] needs.
    void apply(btFemSoftBodySolver& fem, double time);

private:
    struct Spring
    {
        const SceneSpring* m_from;
        btSoftBody* m_body;
        btFemSpring m_spring;
        int m_handle;   // 0: it does not hold
        Vec3 m_target;  // now [m]
    };
    std::vector<Spring> m_springs;
};

}  // namespace bullet_fem
