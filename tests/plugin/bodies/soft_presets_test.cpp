// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Cubes of the presets stand on a plane, at sizes of games (docs/manual.md, How stiff must my body be). With
// BULLETFEM_SLOW_TEST the meshes are finer, which takes a minute.
#include <gtest/gtest.h>

#include <string>
#include <tuple>

#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

#ifdef BULLETFEM_SLOW_TEST
constexpr int kCellsAcross = 8;
#else
constexpr int kCellsAcross = 4;
#endif
constexpr int kStepsOfStanding = 240;

struct Preset
{
    const char* m_name;
    btFemMaterial (*m_make)();
};

const Preset kPresets[] = {{"rubber", btFemMaterial::rubber}, {"foam", btFemMaterial::foam},
                           {"jelly", btFemMaterial::jelly},   {"flesh", btFemMaterial::flesh},
                           {"wood", btFemMaterial::wood},     {"clay", btFemMaterial::clay},
                           {"lead", btFemMaterial::lead},     {"mildFoam", btFemMaterial::mildFoam}};

class SoftPresets : public testing::TestWithParam<std::tuple<Preset, Coupling>>
{
};

// Cubes stay finite and above the plane, without fault flags, and their centres settle above a tenth of the edge.
TEST_P(SoftPresets, StandOnAPlane)
{
    const auto& [preset, coupling] = GetParam();
    for (const double edge : {.3, 1.0, 2.0, 4.0})
    {
        FemWorld world(WorldClass::softRigid, coupling);
        world.addPlane();
        SoftBox box;
        box.m_size = {edge, edge, edge};
        box.m_cells = {kCellsAcross, kCellsAcross, kCellsAcross};
        box.m_center = {0, 0, edge / 2};
        btSoftBody& cube = addSoftBox(world, world.fem(), box);
        world.fem().setMaterial(&cube, preset.m_make());
        for (int k = 0; k < kStepsOfStanding; ++k)
        {
            world.step();
            ASSERT_TRUE(allFinite(cube)) << edge << " m, step " << k;
            ASSERT_GT(lowestHeight(cube), -.01 * edge) << edge << " m, step " << k;
            ASSERT_FALSE(world.fem().stepReport(&cube).m_flags &
                         (BT_FEM_TOO_SOFT | BT_FEM_INSIDE_OUT | BT_FEM_PENETRATING | BT_FEM_NOT_CONVERGED))
                << edge << " m, step " << k;
        }
        EXPECT_GT(centerOf(cube).z, .1 * edge) << edge << " m";
        EXPECT_LT(centerOf(cube).z, .51 * edge) << edge << " m";
    }
}

INSTANTIATE_TEST_SUITE_P(
    Presets, SoftPresets,
    testing::Combine(testing::ValuesIn(kPresets), testing::Values(Coupling::swap, Coupling::coupled)),
    [](const auto& suite)
    { return std::string(std::get<0>(suite.param).m_name) + "_" + couplingName(std::get<1>(suite.param)); });

}  // namespace
}  // namespace bullet_fem
