// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/body/fem_soft_body.h"
#include "bullet_bridge/rigid/impact_patches.h"
#include "bullet_bridge/rigid/world_objects.h"

namespace bullet_fem
{

/// Largest ContactSettings::m_tolerance of a problem with restitution [-]: the solver's error would be missing in the
/// rebound. With 3e-3, stiff cubes rebounded at half of the set restitution.
constexpr double kReboundTolerance = 3e-5;

/// True if some contact has a coefficient of restitution above 0.
bool mayRebound(const ContactProblem& problem);

/// A rebound's impulse, as contact reports list it. A side that cannot move, by pins or a support, passes it on.
struct GivenRebound
{
    FemSoftBody* m_body = nullptr;                ///< null: it cannot move
    FemSoftBody* m_otherBody = nullptr;           ///< null: rigid, or it cannot move
    const btCollisionObject* m_object = nullptr;  ///< the body's
    Impact m_impact;                              ///< before it was forgotten
    Vec3 m_impulse;                               ///< on the body [N s]
};

/// Restitution. The contact solve itself has none, and the step damps the elastic rebound of bodies. When contact no
/// longer drives two colliding bodies apart, and they separate more slowly than the coefficient of restitution demands,
/// the one that is set or that of their elasticity, one impulse on both adds the missing speed, with at most the energy
/// that the contact has lost. Speeds are those of the bodies' rigid motions at the centre of the contact patch. State
/// is kept in ContactMemory::m_impacts.
class Rebounds
{
public:
    /// `isElastic`: bodies without a coefficient of restitution rebound by their elasticity.
    explicit Rebounds(bool isElastic);

    /// Call after contact is solved, before its impulses are applied. Notes impacts that begin with an approach faster
    /// than `least` [m/s], and those that still last. `bodies` are those of the problem; `rigid` has its rigid proxies;
    /// `step` [s].
    void note(const ContactProblem& problem, const std::vector<FemSoftBody*>& bodies, const RigidProxies& rigid,
              double step, double least);

    /// Call at the end of the step, after bodies have moved. Applies due rebounds and forgets impacts that are over.
    /// `bodies` are all bodies of note() in this step; `step` [s]. Clears the rigid proxies of `rigid`.
    void give(const std::vector<FemSoftBody*>& bodies, WorldObjects& world, RigidProxies& rigid, double step);

    /// The rebounds that the last call of give() has applied.
    const std::vector<GivenRebound>& given() const { return m_given; }

private:
    static constexpr int kUsualRebounds = 16;  // in a step; more allocate memory, once

    // The other side of an impact, if it still exists.
    struct Other
    {
        FemSoftBody* m_soft = nullptr;
        const btCollisionObject* m_rigid = nullptr;
    };

    // The rigid motions of both sides as the step begins.
    struct Sides
    {
        RigidProxy m_first, m_second;

        double approachAt(const Impact& impact) const
        {
            return dot(impact.m_normal, m_second.velocityAt(impact.m_point) - m_first.velocityAt(impact.m_point));
        }
    };

    static Sides sidesOf(const ImpactScene& scene, const ImpactPatch& patch);
    void notePatch(const ImpactScene& scene, const ImpactPatch& patch, double least);
    void findRestitution(const ImpactScene& scene, const ImpactPatch& patch, Impact& impact);
    static bool meet(const ImpactScene& scene, const ImpactPatch& patch, double least, Impact& impact);
    static const RigidProxy* supportOf(const ImpactScene& scene, int body, int component, const Vec3& against);
    static const RigidProxy* supportOf(const ImpactScene& scene, int rigidProxy, const Vec3& against);
    Other otherOf(const FemSoftBody& fem, const Impact& impact, const std::vector<FemSoftBody*>& bodies,
                  WorldObjects& world) const;
    Vec3 patchVelocity() const;
    void turnNormal(Impact& impact, double step) const;
    bool follow(FemSoftBody& fem, Impact& impact, const Other& other, RigidProxies& rigid, double step);
    void setPair(const FemSoftBody& fem, const Impact& impact, const Other& other, RigidProxies& rigid, double step);
    bool part(FemSoftBody& fem, const Impact& impact, const Other& other, RigidProxies& rigid, double step);

    ImpactPatches m_patches;
    ContactProblem m_problem;  // of both sides: the other, then the body
    std::vector<GivenRebound> m_given;
};

}  // namespace bullet_fem
