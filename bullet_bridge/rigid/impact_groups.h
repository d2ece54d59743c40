// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/rigid/impact_patches.h"
#include "bullet_fem/fem/contact/rebound.h"

namespace bullet_fem
{

/// A side of an impact: a connected component of a soft body, a rigid object, or neither.
struct ImpactSide
{
    FemSoftBody* m_soft = nullptr;
    int m_component = -1;  ///< of m_soft; -1: none
    const btCollisionObject* m_rigid = nullptr;

    bool isAny() const { return m_soft != nullptr || m_rigid != nullptr; }
    bool operator==(const ImpactSide& b) const
    {
        return m_soft == b.m_soft && m_component == b.m_component && m_rigid == b.m_rigid;
    }
};

/// The separation speed with which the two of an impact part [m/s].
inline double partingSpeedOf(const Impact& impact)
{
    return impact.m_restitution * approachOf(impact) + impact.m_passedOn;
}

/// Impacts at several patches at once: free bodies that touch pass an impact on to each other. Keeps scratch only.
class ImpactGroups
{
public:
    explicit ImpactGroups(ImpactPatches& patches);

    /// Starts a problem whose patches are gathered.
    void begin(const ImpactScene& scene);

    /// The impact of a patch: index in the list of its body. `isDue`: its restitution is to be found.
    void setImpact(std::size_t patch, std::size_t impact, bool isDue);

    /// Finds the restitution by elasticity of impacts that are due, and of those that pass them on.
    void find();

private:
    // Notes on a patch.
    struct Noted
    {
        int m_impact = -1;  // in the list of its body
        bool m_isDue = false;
        bool m_isKnown = false;  // its sides are known
        ImpactSide m_sides[2];   // that can move; none: held
        bool m_isFree = false;   // no pins, joints or constraints hold them
    };

    std::vector<Impact>& impactsOf(std::size_t patch) const
    {
        return m_scene->m_bodies[m_patches.patches()[patch].m_body]->m_memory.m_impacts;
    }
    Impact& impactOf(std::size_t patch) const { return impactsOf(patch)[m_noted[patch].m_impact]; }
    const Noted& notedOf(std::size_t patch);
    void collect(std::size_t seed);
    bool passesOn(std::size_t seed, std::size_t patch);
    void findGroup(std::size_t seed);
    void setProxies();
    void setRebounds();
    bool setUp();
    int proxyOf(const ImpactSide& side);
    void write(bool isParting);

    ImpactPatches& m_patches;
    const ImpactScene* m_scene = nullptr;
    std::vector<Noted> m_noted;
    std::vector<std::size_t> m_group;  // patches
    std::vector<ImpactSide> m_sides;   // of the group
    std::vector<int> m_proxyOf;        // of these
    std::vector<Rebound> m_rebounds;
    std::vector<double> m_parting;
    ContactProblem m_problem;
    ReboundSystem m_system;
    MeetingPatches m_meeting;
};

}  // namespace bullet_fem
