// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <tuple>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

class Squeezed
    : public testing::TestWithParam<std::tuple<Coupling, double, double>>  // Young's modulus [Pa], speed [m/s]
{
protected:
    // Maximum node speed of a light box on the floor over the speed of the heavy ball that falls beside its middle.
    static double thrown(double offset)
    {
        const auto& [coupling, young, speed] = GetParam();
        FemWorld world(WorldClass::softRigid, coupling);
        world.addFloorBox();
        SoftBox box;
        box.m_size = {0.22, 0.22, kHeight};
        box.m_cells = {2, 2, 1};
        box.m_center = {offset, offset / 3, kHeight / 2};
        box.m_youngModulus = btScalar(young);
        box.m_density = 64;
        const btSoftBody& light = addSoftBox(world, world.fem(), box);
        btSoftBody* ball = btFemHelpers::createFromTetMesh(world.info(), makeSphere(kRadius, 4));
        ball->translate({0, 0, btScalar(kHeight + kRadius + 0.05)});
        ball->m_cfg.collisions = light.m_cfg.collisions;
        for (int i = 0; i < ball->m_nodes.size(); ++i) ball->m_nodes[i].m_v = {0, 0, btScalar(-speed)};
        btFemMaterial material;
        material.m_youngModulus = btScalar(1e6);
        material.m_density = 1000;
        world.fem().setMaterial(ball, material);
        world.addSoft(ball);
        double fastest = 0;
        for (int k = 0; k < 60; ++k)
        {
            world.step();
            fastest = std::max(fastest, fastestNode(light));
        }
        return fastest / speed;
    }

    static constexpr double kHeight = 0.13, kRadius = 0.275;  // [m]
};

// An elastic wall would give twice the speed, and a body squeezed out sideways gets more.
TEST_P(Squeezed, ALightBodyIsNotShotAway)
{
    for (const double offset : {0.0, 0.1, 0.2, 0.3}) EXPECT_LT(thrown(offset), 5) << "offset " << offset << " m";
}

std::string nameOfSqueezed(const testing::TestParamInfo<Squeezed::ParamType>& info)
{
    const auto& [coupling, young, speed] = info.param;
    return couplingName(coupling) + std::to_string(static_cast<int>(young / 1000)) + "kPaAt" +
           std::to_string(static_cast<int>(speed));
}

INSTANTIATE_TEST_SUITE_P(Boxes, Squeezed,
                         testing::Combine(testing::Values(Coupling::swap, Coupling::coupled),
                                          testing::Values(1e5, 2.4e5, 1e6), testing::Values(4.0, 6.5, 9.0)),
                         nameOfSqueezed);

}  // namespace
}  // namespace bullet_fem
