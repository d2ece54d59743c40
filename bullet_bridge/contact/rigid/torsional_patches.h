// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/body/fem_soft_body.h"

namespace bullet_fem
{

/// Rolling and spinning friction between FEM bodies and rigid objects. The contacts of a pair with similar normals, as
/// those on one face of a box, form a patch. Coefficients are Bullet's, with kDF for the friction of the soft body [m]:
///     kDF times the object's getRollingFriction(), plus the body's getRollingFriction() times the object's
///     getFriction();
/// spinning friction uses getSpinningFriction() in that formula. CF_ANISOTROPIC_ROLLING_FRICTION of the object scales
/// rolling friction along its axes. Memory grows, never shrinks.
class TorsionalPatches
{
public:
    /// Appends the patches of all bodies to a problem whose first contacts are those of `bodies`, in their order, with
    /// the indices of rigid proxies set.
    void append(const std::vector<FemSoftBody*>& bodies, ContactProblem& problem);

private:
    struct Patch
    {
        Vec3 m_first;            // normal of its first contact [-]
        Vec3 m_normal;           // sum of normals, weighted by impulse [N s]
        Vec3 m_touchingNormal;   // sum of the normals of contact points [-]
        bool m_touches = false;  // some point is in contact
        int m_torsion = -1;      // index in the problem
    };

    /// Contacts of a body with one object.
    struct Pair
    {
        const FemSoftBody& m_fem;
        const btCollisionObject& m_object;
        std::size_t m_begin, m_end;  // range among the body's contacts
        std::size_t m_offset;        // of the body's first contact in the problem
        double m_rolling, m_spinning;
    };

    void appendPair(int body, const Pair& pair, ContactProblem& problem);
    void gather(const Pair& pair, const ContactProblem& problem);
    void appendPatch(int body, const Pair& pair, int patch, ContactProblem& problem);
    void collectNodes(const Pair& pair, int patch, const ContactProblem& problem);
    void addNodes(const FemSoftBody& fem, const SurfacePoint& point);

    std::vector<Patch> m_patches;  // of one pair
    std::vector<int> m_patchOf;    // per contact of the pair
    std::vector<int> m_nodes;      // of one patch, ascending
};

}  // namespace bullet_fem
