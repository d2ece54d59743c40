// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Grounds of duplicated, degenerate and non-manifold triangles, of values that are not finite, and of nothing.
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <tuple>
#include <vector>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"
#include "plugin/scenes/ground_kinds.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

enum class Fault
{
    duplicated,
    duplicatedInverted,  // with the other winding
    degenerate,          // points and lines
    fins,                // four triangles at an edge
    slivers,
    notFinite
};

const char* nameOf(Fault fault)
{
    const char* names[] = {"Duplicated", "DuplicatedInverted", "Degenerate", "Fins", "Slivers", "NotFinite"};
    return names[static_cast<int>(fault)];
}

using Corner = btVector3;

void addCell(std::vector<Corner>& corners, const Corner& low, const Corner& high, bool inverted = false)
{
    const Corner a(low.x(), high.y(), 0), b(high.x(), low.y(), 0);
    if (inverted)
        corners.insert(corners.end(), {low, high, b, low, a, high});
    else
        corners.insert(corners.end(), {low, b, high, low, high, a});
}

std::vector<Corner> trianglesWith(Fault fault)
{
    std::vector<Corner> corners;
    for (int i = -2; i < 2; ++i)
        for (int j = -2; j < 2; ++j)
        {
            const Corner low(btScalar(i), btScalar(j), 0), high(btScalar(i + 1), btScalar(j + 1), 0);
            if (fault != Fault::slivers) addCell(corners, low, high);
            if (fault == Fault::duplicated) addCell(corners, low, high);
            if (fault == Fault::duplicatedInverted) addCell(corners, low, high, true);
        }
    for (int k = 0; k < 400 && fault == Fault::slivers; ++k)
        addCell(corners, {btScalar(k * 0.01 - 2), -2, 0}, {btScalar((k + 1) * 0.01 - 2), 2, 0});
    for (int k = 0; k < 20; ++k)
    {
        const Corner p(btScalar(k * 0.1 - 1), btScalar(k * 0.05), 0), along(1, 0, 0);
        if (fault == Fault::degenerate) corners.insert(corners.end(), {p, p, p, p, p + along, p + along / 2});
        if (fault == Fault::fins)
            for (const btScalar height : {btScalar(-0.01), btScalar(0)})
                corners.insert(corners.end(), {p, p + along, p + Corner(0, 1, height)});
    }
    if (fault == Fault::notFinite)
        corners.insert(corners.end(), {{0, 0, std::numeric_limits<btScalar>::quiet_NaN()}, {1, 0, 0}, {0, 1, 0}});
    return corners;
}

// Fault, GImpact mesh or not, coupling.
class BadGround : public testing::TestWithParam<std::tuple<Fault, bool, Coupling>>
{
};

TEST_P(BadGround, CarriesACubeAndATetrahedron)
{
    const auto [fault, gimpact, coupling] = GetParam();
    if (gimpact && fault == Fault::notFinite) return;  // Bullet's tree of boxes loses all its triangles
    Grounds grounds;
    FemWorld world(WorldClass::softRigid, coupling);
    btRigidBody& ground = grounds.addTriangles(world, trianglesWith(fault), gimpact);
    SoftBox box;
    box.m_size = {0.4, 0.4, 0.4};
    box.m_cells = {2, 2, 2};
    box.m_center = {0.1, 0.1, 0.3};
    btSoftBody& cube = addSoftBox(world, world.fem(), box);
    btSoftBody* made = btFemHelpers::createFromTetMesh(
        world.info(), TetMesh({{-1, 0.3, 0.1}, {-0.7, 0.3, 0.1}, {-0.8, 0.6, 0.1}, {-0.8, 0.4, 0.4}}, {{0, 1, 2, 3}}));
    world.fem().setMaterial(made, btFemMaterial());
    btSoftBody& tetrahedron = world.addSoft(made);
    world.step(180);
    for (btSoftBody* body : {&cube, &tetrahedron})
    {
        EXPECT_TRUE(allFinite(*body));
        EXPECT_GT(lowestHeight(*body), -1e-3);
        EXPECT_LT(fastestNode(*body), 1e-2);
        EXPECT_NEAR(world.fem().contactForce(body, &ground).z() / (massOf(*body) * kGravity), 1, 1e-2);
    }
}

INSTANTIATE_TEST_SUITE_P(Faults, BadGround,
                         testing::Combine(testing::Values(Fault::duplicated, Fault::duplicatedInverted,
                                                          Fault::degenerate, Fault::fins, Fault::slivers,
                                                          Fault::notFinite),
                                          testing::Bool(), testing::Values(Coupling::swap, Coupling::coupled)),
                         [](const auto& suite)
                         {
                             return std::string(nameOf(std::get<0>(suite.param))) +
                                    (std::get<1>(suite.param) ? "_GImpact_" : "_Mesh_") +
                                    couplingName(std::get<2>(suite.param));
                         });

}  // namespace
}  // namespace bullet_fem
