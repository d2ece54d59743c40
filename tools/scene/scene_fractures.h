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

/// Splits of a soft body so far.
struct SceneSplits
{
    const btSoftBody* m_body = nullptr;
    int m_nodes = 0;            ///< initial number
    int m_count = 0;            ///< number of steps in which it split
    int m_parts = 1;            ///< number of connected parts
    std::vector<int> m_copyOf;  ///< for each added node, the earlier node that it copies
};

/// The soft bodies of a scene that can split.
class SceneFractures
{
public:
    /// Sets the strength of an FEM body; does nothing if `from` has none. Throws the exceptions of
    /// btFemFracture::setStrength.
    void add(btFemSoftBodySolver& fem, btSoftBody& body, const SceneFracture& from);

    /// Call after a step: records new splits and redistributes forces.
    void update(btFemSoftBodySolver& fem, SceneForces& forces);

    const std::vector<SceneSplits>& bodies() const { return m_bodies; }
    /// Splits of a body; null if it cannot split.
    const SceneSplits* find(const btSoftBody& body) const;
    /// Number of splits of all bodies.
    int count() const;

private:
    std::vector<SceneSplits> m_bodies;
};

}  // namespace bullet_fem
