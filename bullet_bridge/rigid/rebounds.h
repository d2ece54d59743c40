// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/body/fem_soft_body.h"
#include "bullet_bridge/rigid/rigid_proxies.h"
#include "bullet_bridge/rigid/world_objects.h"

namespace bullet_fem
{

/// Largest ContactSettings::m_tolerance of a problem with restitution [-]: the solver's error would be missing in the
/// rebound. With 3e-3, stiff cubes rebounded at half of the set restitution.
constexpr double kReboundTolerance = 3e-5;

/// True if some contact has a coefficient of restitution above 0.
bool mayRebound(const ContactProblem& problem);

/// Restitution. The contact solve itself has none: bodies rebound by their elasticity. When contact no longer drives
/// two colliding bodies apart, and they separate more slowly than the coefficient of restitution demands, one impulse
/// on both adds the missing speed, with at most the energy that the contact has lost. Speeds are those of the bodies'
/// rigid motions at the centre of the contact patch. State is kept in ContactMemory::m_impacts.
class Rebounds
{
public:
    /// Call after contact is solved, before its impulses are applied. Notes impacts that begin with an approach faster
    /// than `least` [m/s], and those that still last. `bodies` are those of the problem; `rigid` has its rigid proxies.
    void note(const ContactProblem& problem, const std::vector<FemSoftBody*>& bodies, const RigidProxies& rigid,
              double least);

    /// Call at the end of the step, after bodies have moved. Applies due rebounds and forgets impacts that are over.
    /// `bodies` are all bodies of note() in this step; `step` [s]. Clears the rigid proxies of `rigid`.
    void give(const std::vector<FemSoftBody*>& bodies, WorldObjects& world, RigidProxies& rigid, double step);

private:
    // The contact points between a connected component of a body and one other object.
    struct Patch
    {
        int m_body = 0, m_component = 0, m_otherBody = -1, m_otherComponent = -1, m_rigidProxy = -1;
        double m_restitution = 0;  // [-]
        double m_push = 0;         // sum of the normal impulses [N s]
        Vec3 m_point, m_normal;    // sums weighted by normal impulse

        bool isOf(const Patch& b) const
        {
            return m_body == b.m_body && m_component == b.m_component && m_otherBody == b.m_otherBody &&
                   m_otherComponent == b.m_otherComponent && m_rigidProxy == b.m_rigidProxy;
        }
    };

    // The other side of an impact, if it still exists.
    struct Other
    {
        FemSoftBody* m_soft = nullptr;
        const btCollisionObject* m_rigid = nullptr;
    };

    void gather(const ContactProblem& problem, const std::vector<FemSoftBody*>& bodies);
    // Context of a contact problem.
    struct Scene
    {
        const ContactProblem& m_problem;
        const std::vector<FemSoftBody*>& m_bodies;
        const RigidProxies& m_rigid;
    };

    void notePatch(const Scene& scene, const Patch& patch, double least);
    static bool meet(const Scene& scene, const Patch& patch, double least, Impact& impact);
    static const RigidProxy* supportOf(const Scene& scene, int body, int component, const Vec3& against);
    static const RigidProxy* supportOf(const Scene& scene, int rigidProxy, const Vec3& against);
    Other otherOf(const FemSoftBody& fem, const Impact& impact, const std::vector<FemSoftBody*>& bodies,
                  WorldObjects& world) const;
    bool follow(FemSoftBody& fem, Impact& impact, const Other& other, RigidProxies& rigid, double step);
    void setPair(const FemSoftBody& fem, const Impact& impact, const Other& other, RigidProxies& rigid, double step);
    bool part(FemSoftBody& fem, const Impact& impact, const Other& other, RigidProxies& rigid, double step);

    std::vector<Patch> m_patches;
    ContactProblem m_problem;  // of both sides: the other, then the body
};

}  // namespace bullet_fem
