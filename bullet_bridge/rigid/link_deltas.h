// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "LinearMath/btAlignedObjectArray.h"
#include "bullet_bridge/rigid/articulated_bodies.h"

namespace bullet_fem
{

/// Exchanges the velocities of links with Bullet's multibody solver during its iterations: its rows and the impulses of
/// soft bodies change joint velocities in one array of single precision.
class LinkDeltas
{
public:
    /// Call within Bullet's solver once its rows are set up. `deltas` are the changes of the multibodies' velocities by
    /// the rows, indexed by companion id. Impulses of soft bodies are added to them, so that Bullet's rows see these;
    /// ArticulatedBodies::apply() hands them to the multibodies. Both must outlive the solve.
    void begin(ArticulatedBodies& bodies, btAlignedObjectArray<btScalar>& deltas);
    /// Sets the rigid proxies' velocities to the present ones of the links.
    void read(std::vector<RigidProxy>& rigidProxies);
    /// Adds the impulses that the rigid proxies got since begin() or the last call.
    void write(const std::vector<RigidProxy>& rigidProxies);

private:
    double changeIn(std::size_t tree, int k) const;

    // Impulses of a link's rigid proxy when they were written last.
    struct Written
    {
        Vec3 m_impulse, m_angularImpulse;
    };

    ArticulatedBodies* m_bodies = nullptr;
    btAlignedObjectArray<btScalar>* m_deltas = nullptr;  // Bullet's array
    std::vector<double> m_beyond;    // per tree, per coordinate: part of the applied change that is not in *m_deltas
    std::vector<double> m_solved;    // scratch of read
    std::vector<Written> m_written;  // per link
};

}  // namespace bullet_fem
