// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <vector>

#include "btBulletDynamicsCommon.h"
#include "tools/scene/scene_description.h"

namespace bullet_fem
{

/// The joints of a scene in a world, with their motors. It owns them.
class SceneJoints
{
public:
    /// Joins two bodies, which must live longer, or one and btTypedConstraint::getFixedBody(), by what must live longer
    /// and is no anchor. step: of the world [s].
    void add(btDynamicsWorld& world, const SceneConstraint& from, btRigidBody& body, btRigidBody& to, double step);
    void removeFrom(btDynamicsWorld& world);

    /// Sets the motors' speeds of a step whose middle is at this time [s].
    void apply(double middle);

private:
    struct Joint
    {
        std::unique_ptr<btTypedConstraint> m_joint;
        const SceneConstraint* m_from;
        double m_speed;  // now [rad/s], [m/s]
    };
    std::vector<Joint> m_joints;
};

}  // namespace bullet_fem
