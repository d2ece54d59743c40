// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/body/fem_soft_body.h"
#include "bullet_bridge/rigid/rigid_proxies.h"
#include "bullet_bridge/rigid/world_objects.h"

namespace bullet_fem
{

/// ContactSettings::m_tolerance of a problem with restitution, at most [-]: what contact leaves of an impact would be
/// missing where it is given back. Stiff cubes came back with half of what is set at 3e-3.
constexpr double kReboundTolerance = 3e-5;

/// True if a contact has restitution.
bool mayRebound(const ContactProblem& problem);

/// Restitution. Contact itself gives nothing back: what bodies return with is their elasticity. When two bodies that
/// ran into each other are no longer driven apart by it, and part more slowly than the share set of the speed that they
/// met with, one impulse on both makes up for it, with no more energy than their contact has lost. Speeds are those of
/// the bodies' motions as wholes, at the middle of where they touch. What lasts is FemSoftBody::m_impacts.
class Rebounds
{
public:
    /// After contact is solved and before anybody has moved or felt it: notes which bodies begin to touch at more than
    /// `least` [m/s], and which still do. `bodies` are those of the problem, `rigid` has its rigid proxies.
    void note(const ContactProblem& problem, const std::vector<FemSoftBody*>& bodies, const RigidProxies& rigid,
              double least);

    /// As the step ends, when bodies have moved: gives what is due, and forgets what is over. `bodies` are all that
    /// were noted in this step. Afterwards `rigid` is without rigid proxies.
    void give(const std::vector<FemSoftBody*>& bodies, WorldObjects& world, RigidProxies& rigid, double step);

private:
    // The contact points of a piece of a body and what it touches.
    struct Patch
    {
        int m_body = 0, m_piece = 0, m_otherBody = -1, m_otherPiece = -1, m_rigidProxy = -1;
        double m_restitution = 0;  // [-]
        double m_push = 0;         // sum of the normal impulses [N s]
        Vec3 m_point, m_normal;    // sums, by normal impulses

        bool isOf(const Patch& b) const
        {
            return m_body == b.m_body && m_piece == b.m_piece && m_otherBody == b.m_otherBody &&
                   m_otherPiece == b.m_otherPiece && m_rigidProxy == b.m_rigidProxy;
        }
    };

    // What a body has run into, if it is still there.
    struct Other
    {
        FemSoftBody* m_soft = nullptr;
        const btCollisionObject* m_rigid = nullptr;
    };

    void gather(const ContactProblem& problem, const std::vector<FemSoftBody*>& bodies);
    // The rigid proxies of a problem, and how the step began.
    struct Scene
    {
        const ContactProblem& m_problem;
        const std::vector<FemSoftBody*>& m_bodies;
        const RigidProxies& m_rigid;
    };

    void notePatch(const Scene& scene, const Patch& patch, double least);
    static bool meet(const Scene& scene, const Patch& patch, double least, Impact& impact);
    static const RigidProxy* supportOf(const Scene& scene, int body, int piece, const Vec3& against);
    static const RigidProxy* supportOf(const Scene& scene, int rigidProxy, const Vec3& against);
    Other otherOf(const FemSoftBody& fem, const Impact& impact, const std::vector<FemSoftBody*>& bodies,
                  WorldObjects& world) const;
    bool follow(FemSoftBody& fem, Impact& impact, const Other& other, RigidProxies& rigid, double step);
    void setPair(const FemSoftBody& fem, const Impact& impact, const Other& other, RigidProxies& rigid, double step);
    bool part(FemSoftBody& fem, const Impact& impact, const Other& other, RigidProxies& rigid, double step);

    std::vector<Patch> m_patches;
    ContactProblem m_problem;  // of two: the other, and the body
};

}  // namespace bullet_fem
