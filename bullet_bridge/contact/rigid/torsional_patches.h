// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/body/fem_soft_body.h"

namespace bullet_fem
{

/// Rolling and spinning friction between FEM bodies and rigid objects: gathers the contacts of each two that look in
/// about one direction, as the faces of a box do, in patches. The coefficients are Bullet's, with kDF for the friction
/// of the soft body [m]:
///     kDF times the object's getRollingFriction(), plus the body's own times the object's getFriction(),
/// and likewise for spinning. CF_ANISOTROPIC_ROLLING_FRICTION of the object scales rolling friction along its axes.
/// Grows, never shrinks.
class TorsionalPatches
{
public:
    /// Adds those of all bodies to a problem whose first contacts are the bodies', one body after another, with the
    /// indices of rigid proxies set.
    void append(const std::vector<FemSoftBody*>& bodies, ContactProblem& problem);

private:
    struct Patch
    {
        Vec3 m_first;            // normal of its first contact [-]
        Vec3 m_normal;           // sum of normals, by their impulses [N s]
        Vec3 m_touchingNormal;   // sum of those of points that touch [-]
        bool m_touches = false;  // it has such
        int m_torsion = -1;      // its index in the problem
    };

    /// Contacts of a body with one object.
    struct Pair
    {
        const FemSoftBody& m_fem;
        const btCollisionObject& m_object;
        std::size_t m_begin, m_end;  // among the body's
        std::size_t m_offset;        // of the body's contacts in the problem
        double m_rolling, m_spinning;
    };

    void appendPair(int body, const Pair& pair, ContactProblem& problem);
    void gather(const Pair& pair, const ContactProblem& problem);
    void appendPatch(int body, const Pair& pair, int patch, ContactProblem& problem);
    void collectNodes(const Pair& pair, int patch, const ContactProblem& problem);
    void addNodes(const FemSoftBody& fem, const SurfacePoint& point);

    std::vector<Patch> m_patches;  // of a pair
    std::vector<int> m_patchOf;    // per contact of the pair
    std::vector<int> m_nodes;      // of a patch, ascending
};

}  // namespace bullet_fem
