// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/each_world.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

using testing::Test;

/// Tetrahedra appended as by a Bullet program, without checks.
btSoftBody* makeByHand(SoftWorld& world, const std::vector<btVector3>& x, const std::vector<std::array<int, 4>>& tets)
{
    auto* body = new btSoftBody(&world.info(), int(x.size()), x.data(), nullptr);
    for (const std::array<int, 4>& t : tets) body->appendTetra(t[0], t[1], t[2], t[3]);
    return body;
}

constexpr int kStepsToLook = 32;  // all elements are checked within these steps, as BT_FEM_INSIDE_OUT documents

const std::vector<btVector3> kCorners = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {0, 0, 2}};

struct BadMesh
{
    const char* m_name;
    std::vector<btVector3> m_positions;
    std::vector<std::array<int, 4>> m_tets;
    const char* m_says;
};

class BadMeshTest : public EachWorldWith<BadMesh>
{
};

TEST_P(BadMeshTest, IsFlaggedWithItsReasonAndNothingCrashes)
{
    FemWorld world(worldClass());
    btFemSoftBodySolver& fem = world.fem();
    world.addFloorBox();
    btSoftBody& body = world.addSoft(makeByHand(world, value().m_positions, value().m_tets));
    btSoftBody& good = world.addSoft(btFemHelpers::createBox(world.info(), btVector3(3, 0, btScalar(0.51)),
                                                             btVector3(0.5, 0.5, 0.5), btScalar(0.5)));
    world.step(60);
    EXPECT_FALSE(fem.isFem(&body));
    EXPECT_TRUE(fem.stepReport(&body).m_flags & BT_FEM_REJECTED);
    const std::string message = fem.stepReport(&body).m_message;
    EXPECT_NE(message.find(value().m_says), std::string::npos) << message;
    EXPECT_EQ(fem.stepReport(&good).m_flags, 0);
    EXPECT_TRUE(allFinite(good));
}

const btScalar kNoNumber = std::numeric_limits<btScalar>::quiet_NaN();

INSTANTIATE_TEST_SUITE_P(
    Meshes, BadMeshTest,
    testing::Combine(
        eachWorld(),
        testing::Values(
            BadMesh{"flatElement", {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}}, {{0, 1, 2, 3}}, "degenerate"},
            BadMesh{"nodeTwice", kCorners, {{0, 1, 2, 3}, {0, 1, 2, 2}}, "element 1"},
            BadMesh{"nanAtTheStart", {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {0, kNoNumber, 2}}, {{0, 1, 2, 3}}, "finite"})),
    nameOfWorldWith([](const BadMesh& mesh) { return mesh.m_name; }));

class Meshes : public EachWorld
{
};

INSTANTIATE_TEST_SUITE_P(Worlds, Meshes, eachWorld(), nameOfWorld);

class DefaultMaterial : public EachWorld
{
};

INSTANTIATE_TEST_SUITE_P(Worlds, DefaultMaterial, eachWorld(), nameOfWorld);

class ChangedMaterial : public EachWorld
{
};

INSTANTIATE_TEST_SUITE_P(Worlds, ChangedMaterial, eachWorld(), nameOfWorld);

class Detail : public EachWorld
{
};

INSTANTIATE_TEST_SUITE_P(Worlds, Detail, eachWorld(), nameOfWorld);

TEST_P(Meshes, ARejectedBodyIsTriedAgainWhenItGetsAMaterial)
{
    FemWorld world(GetParam(), btVector3(0, 0, 0));
    btFemSoftBodySolver& fem = world.fem();
    btSoftBody& body = world.addSoft(makeByHand(world, {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}}, {{0, 1, 2, 3}}));
    world.step(2);
    ASSERT_TRUE(fem.stepReport(&body).m_flags & BT_FEM_REJECTED);
    body.m_nodes[3].m_x = btVector3(0, 0, 2);
    fem.setMaterial(&body, btFemMaterial());
    world.step(2);
    EXPECT_TRUE(fem.isFem(&body));
    EXPECT_EQ(fem.stepReport(&body).m_flags & BT_FEM_REJECTED, 0);
}

TEST_P(Meshes, InvertedElementsAreTurnedAndFlagged)
{
    FemWorld world(GetParam());
    btFemSoftBodySolver& fem = world.fem();
    btSoftBody& body = world.addSoft(makeByHand(world, kCorners, {{0, 1, 3, 2}}));
    world.step(30);
    EXPECT_TRUE(fem.isFem(&body));
    EXPECT_EQ(fem.stepReport(&body).m_flags, BT_FEM_TURNED_TETS);
    EXPECT_NEAR(velocityOf(body).z, -kGravity * 30 * kStep, 1e-4);
    EXPECT_NEAR((body.m_nodes[1].m_x - body.m_nodes[0].m_x).length(), 1, 1e-4);
}

TEST_P(Meshes, SliversAreFlagged)
{
    const auto flagsOf = [](double height)
    {
        FemWorld world(GetParam());
        btSoftBody& body = world.addSoft(
            makeByHand(world, {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {0, 0, 1 + btScalar(height)}}, {{0, 1, 2, 3}}));
        world.step(2);
        EXPECT_TRUE(world.fem().isFem(&body));
        return world.fem().stepReport(&body).m_flags;
    };
    const double least = 6e-3 * std::sqrt(8.0);  // [m]: volumes of a thousandth of the longest edge cubed
    EXPECT_EQ(flagsOf(1.01 * least), 0);
    EXPECT_EQ(flagsOf(0.99 * least), BT_FEM_SLIVERS);
}

TEST_P(Meshes, InvertedElementIsFlaggedUntilItRecovers)
{
    FemWorld world(GetParam(), btVector3(0, 0, 0));
    btSoftBody& body = world.addSoft(makeByHand(world, kCorners, {{0, 1, 2, 3}}));
    world.step();
    EXPECT_EQ(world.fem().stepReport(&body).m_flags, 0);
    const btVector3 corner = body.m_nodes[3].m_x;
    const btVector3 mirrored(corner.x(), corner.y(), 2 * body.m_nodes[0].m_x.z() - corner.z());
    for (int i = 0; i < 4; ++i) world.fem().setNodeTarget(&body, i, i == 3 ? mirrored : body.m_nodes[i].m_x);
    world.step(kStepsToLook);
    EXPECT_TRUE(world.fem().stepReport(&body).m_flags & BT_FEM_INSIDE_OUT);
    world.fem().setNodeTarget(&body, 3, corner);
    world.step(2 * kStepsToLook);
    EXPECT_FALSE(world.fem().stepReport(&body).m_flags & BT_FEM_INSIDE_OUT);
}

TEST_P(Meshes, UnconnectedComponentsMoveOnTheirOwn)
{
    FemWorld world(GetParam(), btVector3(0, 0, 0));
    btFemSoftBodySolver& fem = world.fem();
    std::vector<btVector3> x = kCorners;
    for (const btVector3& corner : kCorners) x.push_back(corner + btVector3(3, 0, 0));
    btSoftBody& body = world.addSoft(makeByHand(world, x, {{0, 1, 2, 3}, {4, 5, 6, 7}}));
    for (int i = 0; i < 8; ++i) body.m_nodes[i].m_v = btVector3(0, i < 4 ? 1 : -2, 0);
    world.step(60);
    EXPECT_EQ(fem.stepReport(&body).m_flags, BT_FEM_SEVERAL_PIECES);
    for (int i = 0; i < 8; ++i) EXPECT_NEAR(body.m_nodes[i].m_x.y() - x[i].y(), i < 4 ? 1 : -2, 1e-4) << i;
}

// Own weight shortens a cube by rho g L^2 / (2 E): equal for E by kLST and by a material, and a tenth for ten times the
// E.
double sagOf(WorldClass worldClass, btScalar kLST, const btFemMaterial* material)
{
    FemWorld world(worldClass);
    btFemSoftBodySolver& fem = world.fem();
    btSoftBody* made =
        btFemHelpers::createBox(world.info(), btVector3(0, 0, btScalar(0.5)), btVector3(0.5, 0.5, 0.5), btScalar(0.25));
    made->m_materials[0]->m_kLST = kLST;
    if (material) fem.setMaterial(made, *material);
    for (int i = 0; i < made->m_nodes.size(); ++i)
        if (made->m_nodes[i].m_x.z() < btScalar(1e-6)) made->setMass(i, 0);
    const double top = centerOf(*made).z;
    btSoftBody& cube = world.addSoft(made);
    world.step(400);
    return top - centerOf(cube).z;
}

TEST_P(DefaultMaterial, IsAMegapascalTimesBulletsStiffness)
{
    btFemMaterial material;
    material.m_density = 0;
    for (const btScalar kLST : {btScalar(1), btScalar(0.5)})
    {
        material.m_youngModulus = btScalar(1e6) * kLST;
        const double sag = sagOf(GetParam(), kLST, nullptr);
        EXPECT_GT(sag, 1e-3);
        EXPECT_NEAR(sag, sagOf(GetParam(), 1, &material), 1e-3 * sag);
    }
    EXPECT_NEAR(sagOf(GetParam(), btScalar(0.5), nullptr) / sagOf(GetParam(), 1, nullptr), 2,
                0.05);  // nonlinear terms
}

TEST_P(DefaultMaterial, KeepsTheBodysOwnMasses)
{
    FemWorld world(GetParam(), btVector3(0, 0, 0));
    btSoftBody& body = world.addSoft(makeByHand(world, kCorners, {{0, 1, 2, 3}}));
    body.setTotalMass(7);
    world.step();
    EXPECT_NEAR(massOf(body), 7, 1e-5);
    body.m_nodes[0].m_f = btVector3(7, 0, 0);
    world.step();
    EXPECT_NEAR(velocityOf(body).x, 1 * kStep, 1e-6);
}

TEST_P(ChangedMaterial, ChangesOfItTakeEffectInTheNextStep)
{
    FemWorld world(GetParam(), btVector3(0, 0, 0));
    btFemSoftBodySolver& fem = world.fem();
    btSoftBody& cube = world.addSoft(
        btFemHelpers::createBox(world.info(), btVector3(0, 0, 0), btVector3(0.5, 0.5, 0.5), btScalar(0.5)));
    EXPECT_NEAR(massOf(cube), 1000, 0.01);
    world.step(2);
    btFemMaterial foam = btFemMaterial::foam();
    fem.setMaterial(&cube, foam);
    EXPECT_NEAR(massOf(cube), 40, 0.001);
    cube.m_nodes[0].m_f = btVector3(40, 0, 0);
    world.step();
    EXPECT_NEAR(velocityOf(cube).x, 1 * kStep, 1e-6);
    EXPECT_EQ(fem.stepReport(&cube).m_flags, 0);  // factored again
}

TEST_P(Detail, EveryOneCarriesTheWeightAndKeepsMomentum)
{
    for (const btFemDetail detail : {btFemDetail::nodalWarp, btFemDetail::globalWarp, btFemDetail::direct})
    {
        SCOPED_TRACE(int(detail));
        FemWorld world(GetParam());
        btFemSoftBodySolver& fem = world.fem();
        world.addPlane();
        btSoftBody& cube = world.addSoft(btFemHelpers::createBox(world.info(), btVector3(0, 0, btScalar(0.51)),
                                                                 btVector3(0.5, 0.5, 0.5), btScalar(0.25)));
        fem.setDetail(&cube, detail);
        world.step(180);
        EXPECT_NEAR(impulseOn(fem, cube).z / kStep, massOf(cube) * kGravity, 1e-3 * massOf(cube) * kGravity);
    }
}

}  // namespace
}  // namespace bullet_fem
