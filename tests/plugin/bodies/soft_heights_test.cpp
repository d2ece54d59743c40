// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The heights in the table of docs/manual.md, How stiff must my body be.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

constexpr double kSizes[] = {.1, .3, 1, 2, 4, 10};  // [m]
constexpr int kSizeCount = 6, kStepsToRest = 720;

struct Heights
{
    const char* m_name;
    btFemMaterial (*m_make)();
    btFemElasticLaw m_law;
    double m_documented[kSizeCount];  // for each size, as a share of it; 0: collapses
};

constexpr btFemElasticLaw kHooke = btFemElasticLaw::hooke, kNeoHooke = btFemElasticLaw::neoHooke;
const Heights kHeights[] = {{"jelly", btFemMaterial::jelly, kNeoHooke, {.95, .86, .66, .51, .37, .25}},
                            {"flesh", btFemMaterial::flesh, kNeoHooke, {.99, .97, .92, .85, .73, .55}},
                            {"foam", btFemMaterial::foam, kHooke, {1, 1, 1, .99, .98, .96}},
                            {"rubber", btFemMaterial::rubber, kHooke, {1, 1, 1, .99, .99, .97}},
                            {"jellyOfHooke", btFemMaterial::jelly, kHooke, {.95, .84, 0, 0, 0, 0}},
                            {"fleshOfHooke", btFemMaterial::flesh, kHooke, {.99, .97, .91, .81, 0, 0}}};

// Root of f in [low, high]; f(low) > 0.
template <class F>
double rootOf(double low, double high, const F& f)
{
    for (int k = 0; k < 100; ++k)
    {
        const double middle = (low + high) / 2;
        (f(middle) > 0 ? low : high) = middle;
    }
    return low;
}

// Height over H of a column under its weight in uniaxial stress, integrated over its length: stretches s along and l
// across fulfil mu (l^2 - 1) + lambda / 2 (J^2 - 1) = 0, and the pressure on the rest area is mu (l^2 - s^2) / s.
double heightOfColumn(const btFemMaterial& m, double weightStrain)
{
    if (m.m_law == btFemElasticLaw::hooke) return 1 - weightStrain / 2;
    const double E = m.m_youngModulus, nu = m.m_poissonRatio;
    const double mu = E / (2 * (1 + nu)), lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
    const auto pressure = [&](double s)
    {
        const auto across = [&](double square)
        { return -mu * (square - 1) - lambda / 2 * (s * s * square * square - 1); };
        return mu * (rootOf(0, 4 / (s * s), across) - s * s) / s;
    };
    double height = 0;
    constexpr int kSlices = 200;
    for (int k = 0; k < kSlices; ++k)
    {
        const double load = weightStrain * E * (k + .5) / kSlices;
        height += rootOf(.01, 1, [&](double s) { return pressure(s) > load ? 1.0 : -1.0; }) / kSlices;
    }
    return height;
}

class SoftHeights : public testing::TestWithParam<Heights>
{
};

TEST_P(SoftHeights, AreThoseOfTheManual)
{
    for (int k = 0; k < kSizeCount; ++k)
    {
        const double size = kSizes[k];
        FemWorld world(WorldClass::softRigid, Coupling::coupled);
        world.addPlane().setFriction(btScalar(.5));  // Bullet's default friction, as below
        SoftBox box;
        box.m_size = {size, size, size};
        box.m_center = {0, 0, size / 2};
        box.m_friction = btScalar(.2);
        btSoftBody& cube = addSoftBox(world, world.fem(), box);
        btFemMaterial material = GetParam().m_make();
        material.m_law = GetParam().m_law;
        const double weightStrain = material.m_density * kGravity * size / material.m_youngModulus;
        const bool collapses = GetParam().m_documented[k] == 0;
        if (!collapses) material.m_massDamping = 1;  // to settle
        world.fem().setMaterial(&cube, material);
        const btSoftBody::Node* top = nullptr;
        for (int i = 0; i < cube.m_nodes.size(); ++i)
            if (norm(vec3(cube.m_nodes[i].m_x) - Vec3{0, 0, size}) < .01 * size) top = &cube.m_nodes[i];
        ASSERT_NE(top, nullptr);
        int flags = 0;
        for (int step = 0; step < kStepsToRest; ++step)
        {
            world.step();
            flags |= world.fem().stepReport(&cube).m_flags;
        }
        EXPECT_EQ((flags & BT_FEM_TOO_SOFT) != 0, collapses) << size << " m";
        EXPECT_EQ((flags & BT_FEM_INSIDE_OUT) != 0, collapses) << size << " m";
        if (collapses) continue;
        EXPECT_NEAR(top->m_x.z() / size, GetParam().m_documented[k], .015) << size << " m";
        // The plane's friction constrains the lower face of a cube, unlike a column's.
        EXPECT_NEAR(top->m_x.z() / size, heightOfColumn(material, weightStrain), .07) << size << " m";
    }
}

INSTANTIATE_TEST_SUITE_P(Presets, SoftHeights, testing::ValuesIn(kHeights),
                         [](const auto& suite) { return std::string(suite.param.m_name); });

}  // namespace
}  // namespace bullet_fem
