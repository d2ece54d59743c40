// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Energy of free bodies over many steps: 10^4, or 10^5 with BULLETFEM_LONG_RUNS.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "fem/scenes/free_bodies.h"

namespace bullet_fem
{
namespace
{

#ifdef BULLETFEM_LONG_RUNS
constexpr int kEnergySteps = 100000;
#else
constexpr int kEnergySteps = 10000;
#endif
constexpr double kPi = 3.14159265358979323846;

// A state from which a bar is released.
struct Release
{
    const char* m_name;
    double m_bend = 0, m_twist = 0;  // [rad]
    double m_stretch = 1;            // along its axis [-]
    Vec3 m_spin = {};                // [rad/s]
    bool m_yields = false;
};

void PrintTo(const Release& release, std::ostream* out)
{
    *out << release.m_name;
}

class FreeEnergy : public testing::TestWithParam<std::tuple<Release, double, double, bool>>  // E [Pa], damping, varying
{
protected:
    static Body makeReleased()
    {
        const auto& [release, young, damping, isVarying] = GetParam();
        Material material = barMaterial(young, 0);
        if (release.m_yields) material.m_yieldStress = 0.02 * young;
        Body body = makeBody(makeFreeBar({8, 1, 1}), material);
        if (release.m_bend > 0) bend(body, release.m_bend);
        if (release.m_twist > 0) twist(body, release.m_twist);
        for (Vec3& x : body.m_state.m_x) x.x *= release.m_stretch;
        rotate(body, rotationAbout({3, 2, -1}, 0.37));
        spin(body, release.m_spin);
        return body;
    }
};

// Without material damping. Steps vary by four: every third one is a quarter.
TEST_P(FreeEnergy, NeverGrows)
{
    Body body = makeReleased();
    StepSettings settings;
    settings.m_numericalDamping = std::get<2>(GetParam());
    const double start = mechanicalEnergy(body);
    double highest = 0;
    for (int k = 0; k < kEnergySteps; ++k)
    {
        settings.m_step = std::get<3>(GetParam()) && k % 3 == 2 ? 1.0 / 240 : 1.0 / 60;
        step(body, settings);
        if (k > 100 && k % 10 > 0) continue;
        highest = std::max(highest, mechanicalEnergy(body) / start);
        ASSERT_LT(highest, 1.01) << "step " << k;
    }
    ASSERT_TRUE(std::isfinite(mechanicalEnergy(body)));
    RecordProperty("energy", std::to_string(highest));
}

std::string nameOfReleased(const testing::TestParamInfo<FreeEnergy::ParamType>& suite)
{
    const auto& [release, young, damping, isVarying] = suite.param;
    return std::string(release.m_name) + "_" + nameOfYoung(young) + "_" + nameOfDamping(damping) +
           (isVarying ? "_VaryingSteps" : "");
}

INSTANTIATE_TEST_SUITE_P(Bars, FreeEnergy,
                         testing::Combine(testing::Values(Release{"Spinning", 0, 0, 1, {2, 1, 20}},
                                                          Release{"Stretched", 0, 0, 1.2, {3, 5, 4}},
                                                          Release{"Ring", 1.8 * kPi},
                                                          Release{"Twisted", 0, kPi, 1, {1, 2, 3}},
                                                          Release{"Yielding", kPi, 0, 1, {2, 1, 3}, true}),
                                          testing::Values(1e5, 1e7), testing::Values(0, 1), testing::Bool()),
                         nameOfReleased);

}  // namespace
}  // namespace bullet_fem
