// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
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

constexpr double kRadius = 0.1, kSpeed = 3, kRestitution = 0.9;  // [m], [m/s], [-]

// Offset of the paths over the distance of the centres, density of the ball at rest over that of the other, cells
// along a ball, steps per second.
using EccentricCase = std::tuple<Coupling, double, double, int, int>;

class EccentricImpact : public testing::TestWithParam<EccentricCase>
{
protected:
    static btSoftBody& addBall(FemWorld& world, const btVector3& center, double density, int cells)
    {
        btSoftBody* ball = btFemHelpers::createFromTetMesh(world.info(), makeSphere(kRadius, cells));
        ball->translate(center);
        btFemMaterial material;
        material.m_youngModulus = btScalar(1e7);
        material.m_density = btScalar(density);
        material.m_stiffnessDamping = 0;
        world.fem().setMaterial(ball, material);
        ball->m_cfg.kDF = 0;
        ball->m_cfg.collisions |= btSoftBody::fCollision::VF_SS;
        ball->setRestitution(btScalar(std::sqrt(kRestitution)));
        return world.addSoft(ball);
    }

    static double spinOf(const btSoftBody& ball)
    {
        const Motion motion = motionOf(ball);
        const Vec3 spin = motion.m_angular - cross(centerOf(ball), motion.m_linear);
        return norm(spin) / (0.4 * massOf(ball) * kRadius * kRadius);
    }
};

// Frictionless balls that meet off-centre part with the restitution along the line of their centres: the normal turns
// with this line until they part. Facets leave some spin, also where the paths meet.
TEST_P(EccentricImpact, ReturnsTheSpeedAlongTheLineOfCentres)
{
    const auto& [coupling, offset, ratio, cells, rate] = GetParam();
    FemWorld world(WorldClass::softRigid, coupling, {0, 0, 0});
    const double aside = 2 * kRadius * offset;
    btSoftBody& ball = addBall(world, {btScalar(-0.25), btScalar(aside), 0}, 1000, cells);
    btSoftBody& other = addBall(world, {0, 0, 0}, ratio * 1000, cells);
    ball.setVelocity({btScalar(kSpeed), 0, 0});
    const Vec3 along = {std::sqrt(1 - offset * offset), -offset, 0};
    world.step(rate / 2, btScalar(1) / btScalar(rate));
    const double share = dot(velocityOf(other) - velocityOf(ball), along) / (kSpeed * along.x);
    EXPECT_NEAR(share, kRestitution, rate < 240 ? 0.15 : 0.1);
    const double rolling = kSpeed / kRadius, most = rate < 240 ? 0.3 : 0.2;
    EXPECT_LT(spinOf(ball), most * rolling);
    EXPECT_LT(spinOf(other), most * rolling);
}

std::string nameOfEccentric(const testing::TestParamInfo<EccentricCase>& suite)
{
    const auto& [coupling, offset, ratio, cells, rate] = suite.param;
    return std::string(couplingName(coupling)) + "_" + std::to_string(int(100 * offset)) + "_" +
           std::to_string(int(ratio)) + "_" + std::to_string(cells) + "_" + std::to_string(rate);
}

INSTANTIATE_TEST_SUITE_P(Balls, EccentricImpact,
                         testing::Combine(testing::Values(Coupling::swap, Coupling::coupled),
                                          testing::Values(0.0, 0.3, 0.5), testing::Values(1.0, 8.0),
                                          testing::Values(10), testing::Values(60, 240)),
                         nameOfEccentric);

}  // namespace
}  // namespace bullet_fem
