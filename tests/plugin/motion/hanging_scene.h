// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "plugin/scenes/anchor_scene.h"

namespace bullet_fem
{

inline constexpr double kLength = 0.3, kThickness = 0.1, kLinkMass = 1;  ///< of a link [m], [m], [kg]
inline constexpr double kPlate = 0.04;                                   ///< thickness of the plates between links [m]
inline constexpr double kDamping = 0.02;                                 ///< of stiffness [s]
inline constexpr double kRise = 2;                                       ///< duration of a slow loading [s]

/// The time course of the load.
enum class Loading
{
    slow,
    dropped
};

struct Chain
{
    double m_ratio;   ///< suspended mass over a link's mass [-]
    double m_strain;  ///< strain of the links under the whole load [-]
    int m_links;
    int m_frequency;  ///< [1/s]
};

/// Links with nine anchors at each end, plates of a link's mass between them, and a weight.
class HangingScene : public AnchorScene
{
public:
    HangingScene(Coupling coupling, const Chain& chain)
        : AnchorScene(coupling), m_step(1.0 / chain.m_frequency), m_roof(addPart(0, 0.1, 0.1))
    {
        const double hung = chain.m_ratio * kLinkMass, plates = (chain.m_links - 1) * kLinkMass;
        m_mass = hung + plates + chain.m_links * kLinkMass;
        const double E = m_mass * kGravity / (kThickness * kThickness * chain.m_strain);
        btRigidBody* upper = &m_roof;
        double top = 0;
        for (int k = 0; k < chain.m_links; ++k)
        {
            const bool isLast = k == chain.m_links - 1;
            const double half = isLast ? 0.2 : kPlate / 2;
            btRigidBody& lower = addPart(isLast ? hung : kLinkMass, half, top - kLength - half);
            m_links.push_back(&addLink(E, top));
            anchorAll(*m_links.back(), nodesAt(*m_links.back(), top), *upper);
            anchorAll(*m_links.back(), nodesAt(*m_links.back(), top - kLength), lower);
            m_parts.push_back(&lower);
            upper = &lower;
            top -= kLength + kPlate;
        }
    }

    void setGravity(double g)
    {
        m_world.bullet().setGravity(btVector3(0, 0, btScalar(-g)));
        m_world.info().m_gravity = btVector3(0, 0, btScalar(-g));
        for (btRigidBody* part : m_parts) part->setGravity(btVector3(0, 0, btScalar(-g)));
    }

    void step()
    {
        m_world.step(1, btScalar(m_step));
        for (const btSoftBody* link : m_links)
        {
            m_farthest = std::max(m_farthest, farthest(*link));
            m_flags |= m_fem.stepReport(link).m_flags;
        }
    }

    double reaction() const { return impulseOf(*m_links.front(), m_roof).z / m_step; }

    /// Kinetic and potential energy: elastic energy is never negative, so that the sum never exceeds its initial value
    /// [J].
    double energy() const
    {
        double sum = 0;
        for (const btSoftBody* link : m_links)
            sum += motionOf(*link).m_energy + massOf(*link) * kGravity * centerOf(*link).z;
        for (const btRigidBody* part : m_parts)
            sum += motionOf(*part).m_energy + kGravity * part->getCenterOfMassPosition().z() / part->getInvMass();
        return sum;
    }

    double m_step, m_mass = 0;  // [s]; total suspended mass [kg]
    double m_farthest = 0;      // maximum distance of an anchored node from its place [m]
    int m_flags = 0;
    std::vector<btRigidBody*> m_parts;

private:
    btRigidBody& addPart(double mass, double half, double height)
    {
        btRigidBody& body = m_world.addRigid(new btBoxShape(btVector3(btScalar(0.06), btScalar(0.06), btScalar(half))),
                                             {btScalar(mass), at(0, 0, btScalar(height))});
        body.setActivationState(DISABLE_DEACTIVATION);
        return body;
    }

    btSoftBody& addLink(double youngModulus, double top)
    {
        const btScalar half(kThickness / 2);
        btSoftBody& link =
            m_world.addSoft(btFemHelpers::createBox(m_world.info(), btVector3(0, 0, btScalar(top - kLength / 2)),
                                                    btVector3(half, half, btScalar(kLength / 2)), half));
        btFemMaterial material;
        material.m_youngModulus = btScalar(youngModulus);
        material.m_density = btScalar(kLinkMass / (kThickness * kThickness * kLength));
        material.m_stiffnessDamping = btScalar(kDamping);
        m_fem.setMaterial(&link, material);
        return link;
    }

    static double farthest(const btSoftBody& link)
    {
        double distance = 0;
        for (int k = 0; k < link.m_anchors.size(); ++k)
        {
            const btSoftBody::Anchor& anchor = link.m_anchors[k];
            const btVector3 place = anchor.m_body->getWorldTransform() * anchor.m_local;
            distance = std::max(distance, double(place.distance(anchor.m_node->m_x)));
        }
        return distance;
    }

    btRigidBody& m_roof;
    std::vector<btSoftBody*> m_links;
};

/// Suspends a chain and observes it.
class Hanging : public testing::TestWithParam<std::tuple<Coupling, Loading, Chain>>
{
protected:
    static void hang(double seconds)
    {
        const auto& [coupling, loading, chain] = GetParam();
        HangingScene scene(coupling, chain);
        const double start = scene.energy(), weight = scene.m_mass * kGravity;
        const int steps = static_cast<int>(std::lround(seconds * chain.m_frequency)), counted = steps / 4;
        double mean = 0, highest = start;
        for (int k = 0; k < steps; ++k)
        {
            if (loading == Loading::slow) scene.setGravity(kGravity * std::min(1.0, k * scene.m_step / kRise));
            scene.step();
            if (loading == Loading::dropped) highest = std::max(highest, scene.energy());
            if (k >= steps - counted) mean += scene.reaction() / (counted * weight);
        }
        EXPECT_EQ(scene.m_flags, 0);
        EXPECT_NEAR(mean, 1, 0.005);
        EXPECT_LT(scene.m_farthest, 1e-4);
        EXPECT_LT(highest - start, 1e-6 * weight * kLength);
    }
};

inline std::string nameOf(const testing::TestParamInfo<Hanging::ParamType>& suite)
{
    const auto& [coupling, loading, chain] = suite.param;
    const auto number = [](double value) { return std::to_string(std::lround(value)); };
    const std::string ratio = chain.m_ratio < 1 ? "1to" + number(1 / chain.m_ratio) : number(chain.m_ratio) + "to1";
    return couplingName(coupling) + std::string(loading == Loading::slow ? "_slow_" : "_dropped_") + ratio + "_strain" +
           number(1e4 * chain.m_strain) + "e4_" + std::to_string(chain.m_links) + "links_" +
           std::to_string(chain.m_frequency) + "Hz";
}

}  // namespace bullet_fem
