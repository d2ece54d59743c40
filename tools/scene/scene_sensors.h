// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/fem/common/vec3.h"
#include "tools/scene/scene_description.h"

class btRigidBody;

namespace bullet_fem
{

/// Reaction on a soft body, or the sum over its chunks: mean of the last step, on the body (see btFemReaction).
struct SceneReaction
{
    Vec3 m_force;   ///< [N]
    Vec3 m_moment;  ///< about the sensor's place [N m]
};

/// The sensors of a scene.
class SceneSensors
{
public:
    /// Adds one on bodies as they are at the start, of the anchors to a rigid body or, if that is null, of pinned
    /// nodes. Throws std::runtime_error, naming it, if no node is held so. The description must live longer.
    void add(const SceneSensor& from, const std::vector<btSoftBody*>& bodies, const btRigidBody* to);

    int count() const { return static_cast<int>(m_sensors.size()); }
    const std::string& name(int k) const { return m_sensors[k].m_from->m_name; }
    Vec3 about(int k) const { return m_sensors[k].m_about; }  ///< [m]
    SceneReaction read(const btFemSoftBodySolver& fem, int k) const;

private:
    /// A body with those of its nodes that are meant.
    struct Part
    {
        const btSoftBody* m_body;
        std::vector<int> m_nodes;
    };
    struct Sensor
    {
        const SceneSensor* m_from;
        const btRigidBody* m_to;  // null: of pinned nodes
        std::vector<Part> m_parts;
        Vec3 m_about;  // [m]
    };
    std::vector<Sensor> m_sensors;
};

}  // namespace bullet_fem
