// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/body/fem_soft_body.h"
#include "bullet_bridge/rigid/impact_groups.h"
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
/// that the contact has lost. Free bodies that touch get those of all their patches at once. Speeds are those of the
/// bodies' rigid motions at the centre of the contact patch. State is kept in ContactMemory::m_impacts.
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

    /// See ImpactPatches; of the last note().
    double impactStressOf(std::size_t body) const { return m_patches.stressOf(body); }

    /// Call at the end of the step, after bodies have moved. Applies due rebounds and forgets impacts that are over.
    /// `bodies` are all bodies of note() in this step; `step` [s]. Clears the rigid proxies of `rigid`.
    void give(const std::vector<FemSoftBody*>& bodies, WorldObjects& world, RigidProxies& rigid, double step);

    /// The rebounds that the last call of give() has applied.
    const std::vector<GivenRebound>& given() const { return m_given; }

private:
    static constexpr int kUsualRebounds = 16;  // in a step; more allocate memory, once

    // An impact that is not over, with the rigid proxies of its sides.
    struct Live
    {
        FemSoftBody* m_fem;
        Impact* m_impact;
        FemSoftBody* m_otherSoft = nullptr;
        const btCollisionObject* m_otherRigid = nullptr;
        int m_first = -1, m_second = -1;  // proxies; a held side has one of its own
        bool m_isReady = false;           // contact no longer drives the two apart
        bool m_isOver = false;

        bool hasOther() const { return m_otherSoft || m_otherRigid; }
        ImpactSide side() const { return {m_fem, m_impact->m_component, nullptr}; }
        ImpactSide otherSide() const
        {
            return m_otherSoft ? ImpactSide{m_otherSoft, m_impact->m_otherComponent, nullptr}
                               : ImpactSide{nullptr, -1, m_otherRigid};
        }
    };

    void notePatch(const ImpactScene& scene, std::size_t k, double least);
    static bool meet(const ImpactScene& scene, const ImpactPatch& patch, double least, Impact& impact);
    void findOther(Live& live, const std::vector<FemSoftBody*>& bodies, WorldObjects& world) const;
    void listLive(const std::vector<FemSoftBody*>& bodies, WorldObjects& world);
    void setProxies(double step);
    int proxyOf(const ImpactSide& side) const;
    Vec3 patchVelocity(const Live& live) const;
    void turnNormal(const Live& live, double step) const;
    void follow(Live& live, double step) const;
    bool isOneGroup(const Live& a, const Live& b) const;
    void partGroup(std::size_t first);
    double energyFor(const Live& live) const;
    double energyForGroup(const std::vector<Live*>& parting);
    bool part(const std::vector<Live*>& parting);
    void move(const std::vector<Live*>& parting);

    ImpactPatches m_patches;
    ImpactGroups m_groups;
    RigidProxies* m_rigid = nullptr;
    std::vector<Live> m_live;
    std::vector<Live*> m_parting;
    std::vector<ImpactSide> m_sides;
    std::vector<int> m_proxyOf;  // of the sides
    ContactProblem m_problem;    // rigid objects, soft components, sides that are held
    std::vector<RigidProxy> m_before;
    std::vector<Rebound> m_rebounds;
    ReboundSystem m_system;
    std::vector<int> m_pressed;  // proxies
    std::vector<GivenRebound> m_given;
};

}  // namespace bullet_fem
