// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{

/// What of a world's state is Bullet's own: motion and sleep of rigid bodies, bounds and pairs of the broad phase. Not
/// what contacts between rigid bodies remember: restore() lets go of them. To continue from a state with such contacts
/// to the bit, restore it once as it is taken.
class BulletState
{
public:
    explicit BulletState(SoftWorld& world);

    /// Puts it back; the world must hold the same objects.
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
    int m_cleanUpAt, m_newPairs;  // old pairs are taken out a few a step, from here on; the order of pairs follows
};

}  // namespace bullet_fem
