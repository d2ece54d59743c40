// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// A factor is only a preconditioner: a stale one costs iterations, and the solution stays right.
#include <gtest/gtest.h>

#include <functional>

#include "fem/scenes/elasticity_scenes.h"

namespace bullet_fem
{
namespace
{

struct Change
{
    const char* m_name;
    std::function<void(Body&, StepSettings&)> m_apply;
};

void PrintTo(const Change& change, std::ostream* out)
{
    *out << change.m_name;
}

class StaleFactor : public testing::TestWithParam<Change>
{
protected:
    static Body makeBeam()
    {
        Material material = elasticMaterial(1e5, 0.3);
        material.m_stiffnessDamping = 0.01;
        Body body = makeBody(makeBox({1, 0.4, 0.4}, {5, 2, 2}), material, [](const Vec3& X) { return X.x == 0; });
        setGravity(body, {0, 0, -9.81});
        for (Vec3& v : body.m_loads.m_targetVelocity) v = {0, 0.2, 0};
        return body;
    }

    StaleFactor()
    {
        m_settings.m_tolerance = 1e-10;
        m_settings.m_maxIterations = 1000;
    }

    StepSettings m_settings;
    Body m_stale = makeBeam();
};

TEST_P(StaleFactor, GivesTheSolutionOfAFreshOne)
{
    GetParam().m_apply(m_stale, m_settings);
    FactorInput input;
    input.m_mass = m_stale.m_state.m_mass;
    input.m_fixed = m_stale.m_state.m_fixed;
    input.m_step = m_settings.m_step;
    Body fresh(BodyModel::create(m_stale.m_model->sharedShape(), input));
    fresh.m_state = m_stale.m_state;
    fresh.m_loads = m_stale.m_loads;
    int staleIterations = 0, freshIterations = 0;
    for (int k = 0; k < 10; ++k)
    {
        const SolveReport a = step(m_stale, m_settings), b = step(fresh, m_settings);
        EXPECT_EQ(a.m_stop, SolveStop::converged) << k;
        EXPECT_EQ(b.m_stop, SolveStop::converged) << k;
        staleIterations += a.m_iterations;
        freshIterations += b.m_iterations;
    }
    const double moved = largestDistance(fresh.m_state.m_x, fresh.m_model->mesh().restPositions());
    EXPECT_GT(moved, 1e-3);
    EXPECT_LE(largestDistance(m_stale.m_state.m_x, fresh.m_state.m_x), 1e-7 * moved);  // 1e-10 times a condition of 1e3
    EXPECT_GE(staleIterations, freshIterations);
}

void fixTip(Body& body, bool fixed)
{
    const std::vector<Vec3>& X = body.m_model->mesh().restPositions();
    for (std::size_t i = 0; i < X.size(); ++i)
        if (X[i].x == 1) body.m_state.m_fixed[i] = fixed;
}

const Change kChanges[] = {
    {"StepHalved", [](Body&, StepSettings& settings) { settings.m_step /= 2; }},
    {"StepTimesFour", [](Body&, StepSettings& settings) { settings.m_step *= 4; }},
    {"MassesTimesTen",
     [](Body& body, StepSettings&)
     {
         for (double& m : body.m_state.m_mass) m *= 10;
     }},
    {"MassesRandom",
     [](Body& body, StepSettings&)
     {
         RandomVectors random(1);
         for (double& m : body.m_state.m_mass) m *= 1.1 + random.next().x;
     }},
    {"OneHeavyNode", [](Body& body, StepSettings&) { body.m_state.m_mass.back() *= 1000; }},
    {"TipFixed", [](Body& body, StepSettings&) { fixTip(body, true); }},
    {"OneNodeReleased", [](Body& body, StepSettings&) { body.m_state.m_fixed[0] = 0; }},
    {"AllReleased", [](Body& body, StepSettings&) { body.m_state.m_fixed.assign(body.m_state.m_fixed.size(), 0); }},
    {"ClampMovedToTheTip",
     [](Body& body, StepSettings&)
     {
         body.m_state.m_fixed.assign(body.m_state.m_fixed.size(), 0);
         fixTip(body, true);
     }},
    {"MoreMassDamping", [](Body& body, StepSettings&) { body.m_loads.m_massDamping = 50; }},
};

INSTANTIATE_TEST_SUITE_P(Changes, StaleFactor, testing::ValuesIn(kChanges),
                         [](const auto& suite) { return std::string(suite.param.m_name); });

}  // namespace
}  // namespace bullet_fem
