// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "BulletDynamics/ConstraintSolver/btSolverBody.h"
#include "LinearMath/btAlignedObjectArray.h"
#include "bullet_bridge/rigid/link_deltas.h"
#include "bullet_bridge/rigid/rigid_proxies.h"

namespace bullet_fem
{

/// Exchanges velocities between the rigid proxies of a contact problem and the bodies of Bullet's rigid solver during
/// its iterations, links of multibodies included. The velocity of a solver body is m_linearVelocity + delta +
/// m_externalForceImpulse in single precision; the rounding error is kept here and added again.
class SolverBodies
{
public:
    /// Call after the solver has set up its bodies: rigid proxy k is then solver body
    /// movableBody(rigid.object(k))->getCompanionId() of `pool`. Starts with the rounding errors of the last step.
    /// `linkDeltas`: see LinkDeltas::begin; null for a solver without multibodies.
    void begin(RigidProxies& rigid, btAlignedObjectArray<btSolverBody>& pool,
               btAlignedObjectArray<btScalar>* linkDeltas);

    /// Per body of the pool: index of its rigid proxy; -1: it has none.
    const std::vector<int>& proxyOf() const { return m_proxyOf; }

    /// Sets the rigid proxies' velocities to those of the solver bodies.
    void read(std::vector<RigidProxy>& rigidProxies);

    /// Adds the changes of the rigid proxies' velocities since read() to the solver bodies.
    void write(const std::vector<RigidProxy>& rigidProxies);

    /// Keeps the rounding errors for the next step. Resets changes that are not finite or too fast.
    void end(RigidProxies& rigid);

private:
    struct Link
    {
        int m_solverBody = -1;                       // -1: immovable
        Vec3 m_linear, m_angular;                    // velocity at the last read()
        Vec3 m_linearRemainder, m_angularRemainder;  // rounding errors
    };

    btAlignedObjectArray<btSolverBody>* m_pool = nullptr;
    bool m_hasLinks = false;
    LinkDeltas m_linkDeltas;
    std::vector<Link> m_links;
    std::vector<int> m_proxyOf;
};

}  // namespace bullet_fem
