// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "BulletDynamics/ConstraintSolver/btSolverBody.h"
#include "LinearMath/btAlignedObjectArray.h"
#include "bullet_bridge/rigid/rigid_proxies.h"

namespace bullet_fem
{

/// Carries velocities between the rigid proxies of a contact problem and the bodies of Bullet's rigid solver while it
/// iterates, links of multibodies included. A solver body's velocity is m_linearVelocity + delta +
/// m_externalForceImpulse in single precision; what it cannot hold is kept here and added again.
class SolverBodies
{
public:
    /// To be called when the solver has set its bodies up: from then on rigid proxy k is solver body
    /// rigid.movableBody(k)->getCompanionId() of `pool`. Starts from what was cut off in the last step.
    /// `linkDeltas`: see ArticulatedBodies::beginSolve; null for a solver that has no multibodies.
    void begin(RigidProxies& rigid, btAlignedObjectArray<btSolverBody>& pool,
               btAlignedObjectArray<btScalar>* linkDeltas);

    /// The solver bodies' velocities become the rigid proxies'.
    void read(std::vector<RigidProxy>& rigidProxies);

    /// What was added to the rigid proxies' velocities since read() is added to the solver bodies'.
    void write(const std::vector<RigidProxy>& rigidProxies);

    /// Keeps what was cut off for the next step.
    void end(RigidProxies& rigid);

private:
    struct Link
    {
        int m_solverBody = -1;                       // -1: immovable
        Vec3 m_linear, m_angular;                    // as read
        Vec3 m_linearRemainder, m_angularRemainder;  // cut off
    };

    btAlignedObjectArray<btSolverBody>* m_pool = nullptr;
    RigidProxies* m_multiBodies = nullptr;  // null: none
    std::vector<Link> m_links;
};

}  // namespace bullet_fem
