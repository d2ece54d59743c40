// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Collisions of soft balls without friction, off their centres.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <tuple>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

constexpr double kBallRadius = 0.1, kBallSpeed = 3;  // [m], [m/s]
constexpr double kSetRestitution = 0.9;

// Two equal balls without gravity: the first runs past the centre of the second at a distance.
class OffCentreBalls
{
public:
    OffCentreBalls(double offset, double young, int rate)
        : m_offset(offset), m_rate(rate), m_world(WorldClass::softRigid, Coupling::coupled, btVector3(0, 0, 0))
    {
        m_first = &add({-0.35, offset, 0}, young);
        m_second = &add({0, 0, 0}, young);
        m_first->setVelocity(btVector3(btScalar(kBallSpeed), 0, 0));
    }

    // Separation over approach speed, both along the line of centres at their first touch.
    double restitution()
    {
        m_world.step(m_rate * 5 / 6, btScalar(1.0 / m_rate));
        const double sine = m_offset / (2 * kBallRadius), cosine = std::sqrt(1 - sine * sine);
        const Vec3 line = {cosine, -sine, 0};
        return dot(velocityOf(*m_second) - velocityOf(*m_first), line) / (kBallSpeed * cosine);
    }

private:
    btSoftBody& add(const Vec3& center, double young)
    {
        btSoftBody* ball = btFemHelpers::createFromTetMesh(m_world.info(), makeSphere(kBallRadius, 6));
        ball->translate(btVector3(btScalar(center.x), btScalar(center.y), btScalar(center.z)));
        btFemMaterial material;
        material.m_youngModulus = btScalar(young);
        material.m_poissonRatio = btScalar(0.3);
        material.m_density = 1000;
        material.m_stiffnessDamping = 0;
        m_world.fem().setMaterial(ball, material);
        ball->setRestitution(btScalar(std::sqrt(kSetRestitution)));
        ball->m_cfg.kDF = 0;
        ball->m_cfg.collisions |= btSoftBody::fCollision::VF_SS;
        return m_world.addSoft(ball);
    }

    double m_offset;  // [m]
    int m_rate;       // [1/s]
    FemWorld m_world;
    btSoftBody *m_first, *m_second;
};

// The line of centres turns while the balls press each other.
TEST(OffCentreBall, ReturnsTheSetRestitutionAlongTheLineOfCentres)
{
    for (const double offset : {0.0, 0.03, 0.06, 0.1})
        EXPECT_NEAR(OffCentreBalls(offset, 1e7, 240).restitution(), kSetRestitution, 0.07) << offset;
}

// Stiff balls in long steps part with most of the energy in vibrations that the step does not resolve.
TEST(OffCentreBall, WaitsForTheEnergyOfVibrations)
{
    EXPECT_GT(OffCentreBalls(0.1, 1e8, 60).restitution(), 0.4);
}

}  // namespace
}  // namespace bullet_fem
