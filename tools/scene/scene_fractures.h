// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/btFemFracture.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "tools/scene/scene_description.h"
#include "tools/scene/scene_forces.h"

namespace bullet_fem
{

/// What became of a soft body that may split.
struct SceneSplits
{
    const btSoftBody* m_body = nullptr;
    int m_nodes = 0;            ///< at the start
    int m_count = 0;            ///< how often it has split, in as many steps
    int m_parts = 1;            ///< that it hangs together in
    std::vector<int> m_copyOf;  ///< of every node that came since: the node before it that it was split from
};

/// The soft bodies of a scene that may split.
class SceneFractures
{
public:
    /// Gives a body, which is FEM, its strength; nothing if it has none. Throws what btFemFracture::setStrength throws.
    void add(btFemSoftBodySolver& fem, btSoftBody& body, const SceneFracture& from);

    /// After a step: takes what has split, and lets forces follow.
    void update(btFemSoftBodySolver& fem, SceneForces& forces);

    const std::vector<SceneSplits>& bodies() const { return m_bodies; }
    /// Of a body; null if it does not split.
    const SceneSplits* find(const btSoftBody& body) const;
    /// Of all bodies.
    int count() const;

private:
    std::vector<SceneSplits> m_bodies;
};

}  // namespace bullet_fem
