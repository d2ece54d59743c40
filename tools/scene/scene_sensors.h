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

/// Reaction on a soft body, or the sum over its fragments: mean over the last step (see btFemReaction).
struct SceneReaction
{
    Vec3 m_force;   ///< [N]
    Vec3 m_moment;  ///< about the sensor's reference point [N m]
};

/// The sensors of a scene.
class SceneSensors
{
public:
    /// Adds a sensor on bodies in their initial state: for the anchors to a rigid body or, if `to` is null, for pinned
    /// nodes. Throws std::runtime_error with its name if no node is held so. The description must outlive this object.
    void add(const SceneSensor& from, const std::vector<btSoftBody*>& bodies, const btRigidBody* to);

    int count() const { return static_cast<int>(m_sensors.size()); }
    const std::string& name(int k) const { return m_sensors[k].m_from->m_name; }
    Vec3 about(int k) const { return m_sensors[k].m_about; }  ///< [m]
    SceneReaction read(const btFemSoftBodySolver& fem, int k) const;

private:
    /// A body and the nodes to which the sensor applies.
    struct Part
    {
        const btSoftBody* m_body;
        std::vector<int> m_nodes;
    };
    struct Sensor
    {
        const SceneSensor* m_from;
        const btRigidBody* m_to;  // null: pinned nodes
        std::vector<Part> m_parts;
        Vec3 m_about;  // [m]
    };
    std::vector<Sensor> m_sensors;
};

}  // namespace bullet_fem
