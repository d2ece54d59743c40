// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/scene_state.h"

#include "fem/common/message.h"

namespace bullet_fem
{
namespace
{

void restoreRigid(const SceneState::Rigid& state, btRigidBody& body, btSoftRigidDynamicsWorld& world)
{
    body.setWorldTransform(state.m_pose);
    body.setInterpolationWorldTransform(state.m_pose);
    body.setLinearVelocity(state.m_velocity);
    body.setAngularVelocity(state.m_spin);
    body.setInterpolationLinearVelocity(state.m_velocity);
    body.setInterpolationAngularVelocity(state.m_spin);
    body.updateInertiaTensor();
    body.clearForces();
    body.forceActivationState(state.m_activation);
    body.setDeactivationTime(state.m_stillFor);
    world.getPairCache()->cleanProxyFromPairs(body.getBroadphaseHandle(), world.getDispatcher());
    world.updateSingleAabb(&body);
}

}  // namespace

SceneState stateOf(const SceneWorld& world)
{
    SceneState state;
    state.m_steps = world.steps();
    if (world.softCount() > 0) world.fem().saveState(state.m_soft);
    for (int i = 0; i < world.rigidCount(); ++i)
    {
        const btRigidBody& body = world.rigid(i);
        state.m_rigid.push_back({body.getWorldTransform(), body.getLinearVelocity(), body.getAngularVelocity(),
                                 body.getActivationState(), body.getDeactivationTime()});
    }
    return state;
}

void restore(const SceneState& state, SceneWorld& world)
{
    if (static_cast<int>(state.m_rigid.size()) != world.rigidCount())
        reject("the state has ", state.m_rigid.size(), " rigid bodies, and the scene ", world.rigidCount(),
               "; restore it where there are as many");
    if (world.softCount() > 0) world.fem().restoreState(state.m_soft.data(), state.m_soft.size());
    for (int i = 0; i < world.rigidCount(); ++i)
        restoreRigid(state.m_rigid[static_cast<std::size_t>(i)], world.rigid(i), world.world());
    world.setSteps(state.m_steps);
}

}  // namespace bullet_fem
