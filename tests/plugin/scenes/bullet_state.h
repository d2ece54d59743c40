// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{

/// Bullet's part of a world's state: motion and sleep of rigid bodies, bounds and pairs of the broad phase. Without the
/// warm starts of contacts between rigid bodies, which restore() clears. To continue bitwise equal from a state with
/// such contacts, restore it once when it is saved.
class BulletState
{
public:
    explicit BulletState(SoftWorld& world);

    /// Restores the state; the world must contain an unchanged set of objects.
    void restore(SoftWorld& world) const;

private:
    struct Rigid
    {
        btRigidBody* m_body;
        btTransform m_place, m_interpolatedPlace;
        btVector3 m_velocity, m_spin, m_interpolatedVelocity, m_interpolatedSpin;
        btScalar m_hitFraction, m_deactivationTime;
        int m_activation;
    };
    struct Bounds
    {
        btBroadphaseProxy* m_proxy;
        btVector3 m_low, m_high;
    };
    struct Pair
    {
        btBroadphaseProxy *m_first, *m_second;
    };

    std::vector<Rigid> m_rigid;
    std::vector<Bounds> m_bounds;
    std::vector<Pair> m_pairs;    // in order
    int m_cleanUpAt, m_newPairs;  // old pairs are removed a few a step, from here on; the order of pairs depends on it
};

}  // namespace bullet_fem
