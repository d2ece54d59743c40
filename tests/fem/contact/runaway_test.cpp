// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// On the low-memory path the compliance of stiff, light bodies is too inexact to be definite: sweeps over it can run
// away. Such bodies are let go of for the step.
#include <gtest/gtest.h>

#include <random>

#include "fem/scenes/contact_scene.h"

namespace bullet_fem
{
namespace
{

constexpr double kLongStep = 0.05, kYoung = 1e8, kDensity = 10;  // [s], [Pa], [kg/m3]

// A plate of 27 g, its lower face on points whose normals differ.
class Plate : public ContactScene
{
public:
    explicit Plate(unsigned seed, double gap = 0)
    {
        Material material = elasticMaterial(kYoung, 0.3);
        material.m_density = kDensity;
        const Body onFullPath = makeBody(makeBox({0.3, 0.3, 0.03}, {6, 6, 1}), material, {}, kLongStep);
        FactorInput input = onFullPath.m_model->factorInput();
        input.m_choice = FactorChoice::lowMemory;
        m_body = Body(BodyModel::create(onFullPath.m_model->sharedShape(), input));
        m_cache = makeComplianceCache(m_body.m_model);
        m_settings.m_step.m_step = kLongStep;
        m_settings.m_step.m_tolerance = 1e-3;
        m_settings.m_sweeps = 50;
        std::mt19937 generator(seed);
        const auto number = [&generator] { return generator() / 2147483648.0 - 1; };
        setVelocity({2 * number(), 2 * number(), -1});
        for (int node = 0; node < 49; ++node) touchNode(node, gap, 0.3);
        for (ContactPoint& contact : m_contacts)
        {
            const double x = 0.3 * number(), y = 0.3 * number();
            const Vec3 n = {x, y, 1};
            contact.m_normal = (1 / norm(n)) * n;
        }
    }
};

TEST(Runaway, OfAStiffLightBodyOnTheLowMemoryPathIsLetGo)
{
    for (unsigned seed = 0; seed < 70; ++seed)
    {
        Plate plate(seed);
        const ContactReport report = plate.solve();
        EXPECT_FALSE(report.m_converged) << seed;
        for (const Vec3& v : velocity(plate.m_body)) ASSERT_LT(norm(v), 20) << seed;  // it came with at most 3 m/s
    }
}

// What has sunk in and does not close any more is pushed apart by sweeps of its own, which run away as well.
TEST(Runaway, OfItsPositionCorrectionsIsLetGo)
{
    for (unsigned seed = 0; seed < 10; ++seed)
    {
        Plate plate(seed, -0.02);
        plate.setVelocity({0, 0, 0.03});
        makeBall(plate.m_obstacles[0], 10, 0.5);
        EXPECT_TRUE(plate.solve().m_converged) << seed;
        EXPECT_LT(norm(plate.m_obstacles[0].m_pushLinear), 1) << seed;
        EXPECT_LT(norm(plate.m_obstacles[0].m_pushAngular), 1) << seed;
        finishStep(plate.m_body, plate.m_settings.m_step);
        for (const Vec3& x : plate.m_body.m_state.m_x) ASSERT_LT(norm(x), 1) << seed;
    }
}

}  // namespace
}  // namespace bullet_fem
