// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <tuple>

#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/random_program.h"
#include "plugin/scenes/scene_measures.h"

namespace bullet_fem
{
namespace
{

constexpr int kPrograms = 5, kActs = 250;

// BULLETFEM_RANDOM_PROGRAMS=first,count in the environment selects others.
struct Seeds
{
    unsigned m_first = 1;
    int m_count = kPrograms;

    Seeds()
    {
        const char* text = std::getenv("BULLETFEM_RANDOM_PROGRAMS");
        if (!text) return;
        char* end = nullptr;
        m_first = static_cast<unsigned>(std::strtoul(text, &end, 10));
        if (*end == ',') m_count = std::atoi(end + 1);
    }
};

class AnyProgram : public testing::TestWithParam<std::tuple<WorldClass, Coupling>>
{
};

// After any call sequence nodes and rigid bodies are finite after a step. Inactive bodies keep the values written to
// them.
TEST_P(AnyProgram, NeitherCrashesNorSpreadsBadNumbers)
{
    const Seeds seeds;
    int refusals = 0;
    for (int k = 0; k < seeds.m_count; ++k)
    {
        const unsigned seed = seeds.m_first + static_cast<unsigned>(k);
        RandomProgram program(std::get<0>(GetParam()), std::get<1>(GetParam()), seed);
        for (int a = 0; a < kActs; ++a)
        {
            program.act(static_cast<unsigned>(a));
            if (std::string("step") != program.lastAct()) continue;
            for (const btSoftBody* body : program.soft())
                ASSERT_TRUE(allFinite(*body) || !body->isActive()) << "program " << seed << ", act " << a;
            for (const btRigidBody* body : program.rigid())
            {
                ASSERT_TRUE(isFinite(vec3(body->getWorldTransform().getOrigin())))
                    << "program " << seed << ", act " << a;
                ASSERT_TRUE(isFinite(vec3(body->getLinearVelocity()))) << "program " << seed << ", act " << a;
            }
        }
        refusals += program.refusals();
    }
    EXPECT_GT(refusals, 0);  // some input was bad
}

INSTANTIATE_TEST_SUITE_P(Worlds, AnyProgram,
                         testing::Values(std::tuple(WorldClass::softRigid, Coupling::swap),
                                         std::tuple(WorldClass::softRigid, Coupling::coupled),
                                         std::tuple(WorldClass::softMultiBody, Coupling::swap),
                                         std::tuple(WorldClass::deformable, Coupling::swap)),
                         [](const auto& suite) {
                             return std::string(worldName(std::get<0>(suite.param))) + "_" +
                                    couplingName(std::get<1>(suite.param));
                         });

}  // namespace
}  // namespace bullet_fem
