// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <vector>

#include "btBulletDynamicsCommon.h"
#include "tools/scene/scene_description.h"

namespace bullet_fem
{

/// The joints of a scene's world with their motors; owns the joints.
class SceneJoints
{
public:
    /// Adds a joint between two bodies, which must outlive it, or a body and btTypedConstraint::getFixedBody(). `from`
    /// must outlive this object and must not be an anchor. step: of the world [s].
    void add(btDynamicsWorld& world, const SceneConstraint& from, btRigidBody& body, btRigidBody& to, double step);
    void removeFrom(btDynamicsWorld& world);

    /// Sets the motors' speeds for a step whose midpoint is at this time [s].
    void apply(double middle);

private:
    struct Joint
    {
        std::unique_ptr<btTypedConstraint> m_joint;
        const SceneConstraint* m_from;
        double m_speed;  // present value [rad/s], [m/s]
    };
    std::vector<Joint> m_joints;
};

}  // namespace bullet_fem
