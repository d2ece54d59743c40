// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/body/fem_soft_body.h"
#include "bullet_bridge/rigid/rigid_proxies.h"
#include "bullet_fem/fem/contact/elastic_rebound.h"

namespace bullet_fem
{

/// A contact problem with its bodies and rigid proxies, before its impulses are applied.
struct ImpactScene
{
    const ContactProblem& m_problem;
    const std::vector<FemSoftBody*>& m_bodies;
    const RigidProxies& m_rigid;
    double m_step;  ///< [s]

    /// True if a contact is between two bodies that may rebound: not of a body with itself, nor with nodes of cloth,
    /// which are no objects of m_rigid.
    bool isPair(const ContactPoint& contact) const;

    /// The speed at which a contact closes as the step begins [m/s]; < 0: it opens.
    double approachOf(const ContactPoint& contact) const;

    /// The connected component that a point belongs to.
    int componentOf(const SurfacePoint& point) const;

    /// The rigid proxy of an object with its velocity as the step begins, without the forces of the step.
    RigidProxy before(int rigidProxy) const;
};

/// The contact points between a connected component of a body and one other object. Between two soft bodies, the one of
/// smaller broadphase id is the first.
struct ImpactPatch
{
    int m_body = 0, m_component = 0, m_otherBody = -1, m_otherComponent = -1, m_rigidProxy = -1;
    double m_restitution = 0;  ///< set coefficient of restitution [-]
    double m_push = 0;         ///< sum of the normal impulses [N s]
    Vec3 m_point, m_normal;    ///< sums weighted by normal impulse

    bool isOf(const ImpactPatch& b) const
    {
        return m_body == b.m_body && m_component == b.m_component && m_otherBody == b.m_otherBody &&
               m_otherComponent == b.m_otherComponent && m_rigidProxy == b.m_rigidProxy;
    }
};

/// The patches of a contact problem that may rebound: with a coefficient of restitution set, or of bodies that meet at
/// speed. Keeps scratch only.
class ImpactPatches
{
public:
    static constexpr int kUsualPatches = 64;  ///< more allocate memory, once

    /// `isElastic`: bodies without a coefficient of restitution rebound, too.
    explicit ImpactPatches(bool isElastic) : m_isElastic(isElastic) { m_patches.reserve(kUsualPatches); }

    bool isElastic() const { return m_isElastic; }

    /// Collects the patches: if any bodies meet at speed, all. Bodies meet at speed if they have impacts, or a pressed
    /// point approaches the other side faster than `least` [m/s].
    void gather(const ImpactScene& scene, double least);

    /// The largest stress of a wave that an impact of this step starts in a body of the scene [Pa]; 0 without impact.
    /// With the speed v at which a pressed contact closes as the step begins, faster than `least`, v Z Z' / (Z + Z'),
    /// where Z and Z' are the impedances of both (waveImpedance), and v Z against rigid objects.
    double stressOf(std::size_t body) const { return m_stresses[body]; }

    const std::vector<ImpactPatch>& patches() const { return m_patches; }

    /// Adds the elastic response of both sides of a patch. False if it is not known.
    bool addResponse(const ImpactScene& scene, const ImpactPatch& patch, PatchResponse& response);

private:
    static ImpactPatch patchOf(const ImpactScene& scene, const ContactPoint& contact);
    double impedanceOf(const ImpactScene& scene, int body);
    void findStresses(const ImpactScene& scene, double least);
    bool anyMeets(const ImpactScene& scene);
    bool addSide(const ImpactScene& scene, const ImpactPatch& patch, int body, PatchResponse& response);

    const bool m_isElastic;
    std::vector<ImpactPatch> m_patches;
    std::vector<double> m_stresses, m_impedances;  // per body; impedance 0: not known yet
    std::vector<Vec3> m_impulses;                  // per node of one body, by a unit impulse on the patch [-]
};

}  // namespace bullet_fem
