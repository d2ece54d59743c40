// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Bodies that are far too soft for their size: their own weight turns elements inside out.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/ground_kinds.h"
#include "plugin/scenes/scene_measures.h"

namespace bullet_fem
{
namespace
{

// Ground, coupling, edge of the cube [m].
class CrushedCube : public testing::TestWithParam<std::tuple<GroundKind, Coupling, double>>
{
};

// Hooke's law has no pressure that grows without bound: inner nodes would hang below the ground from the surface, which
// lies on it.
TEST_P(CrushedCube, KeepsItsInnerNodesAboveTheGround)
{
    const auto [kind, coupling, edge] = GetParam();
    Grounds grounds;
    FemWorld world(WorldClass::softRigid, coupling);
    grounds.addFlat(world, kind, 3 * edge);
    const auto half = btScalar(edge / 2);
    btSoftBody* cube =
        btFemHelpers::createBox(world.info(), btVector3(0, 0, half), btVector3(half, half, half), half / 2);
    btFemMaterial material = btFemMaterial::jelly();
    material.m_law = btFemElasticLaw::hooke;
    world.fem().setMaterial(cube, material);
    world.addSoft(cube);
    double lowest = 0, lowestCenter = edge;
    for (int k = 0; k < 240; ++k)
    {
        world.step();
        lowest = std::min(lowest, lowestHeight(*cube));
        lowestCenter = std::min(lowestCenter, centerOf(*cube).z);
    }
    EXPECT_TRUE(world.fem().stepReport(cube).m_flags & BT_FEM_INSIDE_OUT);
    EXPECT_GT(lowestCenter, -0.002 * edge);
    EXPECT_GT(lowest, -0.05 * edge);  // within a step, before their elements are known to be inside out
    EXPECT_GT(lowestHeight(*cube), -0.02 * edge);
}

INSTANTIATE_TEST_SUITE_P(
    Grounds, CrushedCube,
    testing::Combine(testing::Values(GroundKind::plane, GroundKind::box, GroundKind::hull, GroundKind::compound,
                                     GroundKind::mesh, GroundKind::coarseMesh, GroundKind::gimpact,
                                     GroundKind::heightfield),
                     testing::Values(Coupling::swap, Coupling::coupled), testing::Values(1.0, 2.0, 4.0)),
    [](const auto& suite)
    {
        return std::string(nameOf(std::get<0>(suite.param))) + "_" + couplingName(std::get<1>(suite.param)) + "_" +
               std::to_string(std::lround(std::get<2>(suite.param))) + "m";
    });

}  // namespace
}  // namespace bullet_fem
