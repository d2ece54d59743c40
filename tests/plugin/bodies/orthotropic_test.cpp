// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
// Orthotropic bodies in Bullet's worlds (docs/materials.md, Orthotropic).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/snapshot_scene.h"
#include "plugin/scenes/soft_boxes.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

using testing::HasSubstr;

constexpr double kStiffAlong = 8e5, kSoftAcross = 5e4;            // [Pa]
constexpr double kEdgeOfFibrous = 0.5, kDensityOfFibrous = 1000;  // [m], [kg/m3]

// Poisson's ratios are 0, so that a cube on a rough floor is a column under its weight.
btFemMaterial fibrous(const btVector3& along)
{
    btFemMaterial material =
        btFemMaterial::transverselyIsotropic(btScalar(kStiffAlong), btScalar(kSoftAcross), 0, 0, btScalar(3e4));
    material.m_density = btScalar(kDensityOfFibrous);
    material.m_stiffnessDamping = btScalar(0.01);
    material.m_orthotropic.m_along = along;
    material.m_orthotropic.m_across = btVector3(btScalar(0.3), 1, btScalar(0.2));
    return material;
}

SoftBox fibrousBox(double height)
{
    SoftBox box;
    box.m_size = {kEdgeOfFibrous, kEdgeOfFibrous, kEdgeOfFibrous};
    box.m_center = {0, 0, height + kEdgeOfFibrous / 2};
    return box;
}

// Displacement of the upper face by the weight.
double sagOf(const btSoftBody& cube)
{
    double top = 0;
    int count = 0;
    for (int i = 0; i < cube.m_nodes.size(); ++i)
        if (double(cube.m_nodes[i].m_x.z()) > 0.9 * kEdgeOfFibrous) top += double(cube.m_nodes[i].m_x.z()), ++count;
    return kEdgeOfFibrous - top / count;
}

double sagOfColumn(double young)
{
    return kDensityOfFibrous * kGravity * kEdgeOfFibrous * kEdgeOfFibrous / (2 * young);
}

class OrthotropicInWorlds : public testing::TestWithParam<Coupling>
{
};

// It falls, its contact force is its weight, and its sag follows the stiffness along the fibres, or across them.
TEST_P(OrthotropicInWorlds, ADroppedCubeStandsOnItsFibresOrAcrossThem)
{
    for (const bool stands : {true, false})
    {
        FemWorld world(WorldClass::softRigid, GetParam());
        btRigidBody& floor = world.addFloorBox();
        btSoftBody& cube = addSoftBox(world, world.fem(), fibrousBox(0.1));
        world.fem().setMaterial(&cube, fibrous(stands ? btVector3(0, 0, -2) : btVector3(1, 0, 0)));
        world.step(400);
        ASSERT_TRUE(world.fem().isFem(&cube));
        const double weight = massOf(cube) * kGravity;
        EXPECT_NEAR(world.fem().contactForce(&cube, &floor).z(), weight, 0.01 * weight) << stands;
        EXPECT_LT(fastestNode(cube), 0.01);
        const double expected = sagOfColumn(stands ? kStiffAlong : kSoftAcross);
        EXPECT_NEAR(sagOf(cube), expected, 0.03 * expected + 2e-4) << stands;
        btAlignedObjectArray<btFemStress> stress;
        world.fem().getStress(&cube, stress);
        ASSERT_EQ(stress.size(), cube.m_tetras.size());
        double mean = 0;
        for (int e = 0; e < stress.size(); ++e) mean += double(stress[e].m_zz) / stress.size();
        EXPECT_NEAR(mean, -kDensityOfFibrous * kGravity * kEdgeOfFibrous / 2, 0.05 * 2500);
    }
}

// The material axes belong to the rest shape: rotating a prepared body rotates them.
TEST_P(OrthotropicInWorlds, FibresTurnWithTheBody)
{
    FemWorld world(WorldClass::softRigid, GetParam());
    world.addFloorBox();
    btSoftBody& cube = addSoftBox(world, world.fem(), fibrousBox(0));
    world.fem().setMaterial(&cube, fibrous({1, 0, 0}));
    world.fem().prepare(&cube, kStep);
    const btVector3 center(0, 0, btScalar(kEdgeOfFibrous / 2));
    cube.translate(-center);
    cube.rotate(btQuaternion(btVector3(0, 1, 0), SIMD_HALF_PI));
    cube.translate(center + btVector3(0, 0, btScalar(0.01)));
    world.step(300);
    EXPECT_NEAR(sagOf(cube), sagOfColumn(kStiffAlong), 0.03 * sagOfColumn(kStiffAlong) + 2e-4);
}

INSTANTIATE_TEST_SUITE_P(Couplings, OrthotropicInWorlds, testing::Values(Coupling::swap, Coupling::coupled),
                         [](const auto& suite) { return std::string(couplingName(suite.param)); });

// Fibres whose direction varies in space.
btFemMaterial windingMaterial(const btVector3& centroid)
{
    return fibrous({1, btScalar(2) * centroid.x(), btScalar(0.5) - centroid.y()});
}

TEST(OrthotropicBodies, DirectionFieldsMoveWithTheSameBitsOnAnyNumberOfThreads)
{
    std::vector<btScalar> expected;
    for (const int threads : {1, 2, 3, 8})
    {
        btFemSolverInfo info;
        info.m_threads = threads;
        FemWorld world(WorldClass::softRigid, Coupling::coupled, {0, 0, btScalar(-kGravity)}, info);
        world.addFloorBox();
        btSoftBody& cube = addSoftBox(world, world.fem(), fibrousBox(0.05));
        world.fem().setMaterials(&cube, windingMaterial);
        world.step(60);
        if (threads == 1) expected = bitsOf(cube);
        EXPECT_TRUE(bitsOf(cube) == expected) << threads;
    }
}

TEST(OrthotropicBodies, SavedStatesContinueAndAreRefusedByOtherFibres)
{
    SnapshotScene scene;
    scene.m_world.addPlane();
    btSoftBody& cube = scene.add(fibrousBox(0.05));
    scene.m_fem.setMaterials(&cube, windingMaterial);
    scene.m_world.step(20);
    const std::vector<unsigned char> saved = scene.save();
    scene.m_world.step(30);
    const std::vector<btScalar> expected = bitsOf(cube);
    scene.m_fem.restoreState(saved.data(), saved.size());
    scene.m_world.step(30);
    EXPECT_TRUE(bitsOf(cube) == expected);

    scene.m_fem.setMaterial(&cube, fibrous({1, 0, 0}));
    scene.m_world.step();
    std::string why;
    EXPECT_FALSE(scene.m_fem.restoreState(saved.data(), saved.size(), &why));
    EXPECT_NE(why, "");
}

// A definition gives another body the motion of the saved one, for each law.
TEST(OrthotropicBodies, DefinitionsKeepTheLaw)
{
    btFemMaterial gel = fibrous({1, 0, 0});
    gel.m_law = btFemElasticLaw::neoHooke;
    gel.m_youngModulus = btScalar(kSoftAcross);
    for (const btFemMaterial& material : {fibrous({0, 1, btScalar(0.5)}), gel})
    {
        std::vector<btScalar> moved[2];
        std::vector<unsigned char> saved;
        for (const bool copied : {false, true})
        {
            SnapshotScene scene;
            scene.m_world.addPlane();
            btSoftBody& cube = scene.add(fibrousBox(0.05));
            if (copied)
                scene.m_fem.applyDefinition(&cube, saved.data(), saved.size());
            else
            {
                scene.m_fem.setMaterial(&cube, material);
                scene.m_fem.prepare(&cube, kStep);
                scene.m_fem.saveDefinition(&cube, saved);
            }
            scene.m_world.step(30);
            moved[copied] = bitsOf(cube);
        }
        double farthest = 0;  // masses are stored as 1 / m
        for (std::size_t k = 0; k < moved[0].size(); ++k)
            farthest = std::max(farthest, std::fabs(double(moved[0][k] - moved[1][k])));
        EXPECT_LT(farthest, 1e-5) << static_cast<int>(material.m_law);  // Hooke's law would differ by some millimetres
    }
}

TEST(OrthotropicBodies, BadConstantsAreRefusedAndNothingChanges)
{
    FemWorld world(WorldClass::softRigid);
    btSoftBody& cube = addSoftBox(world, world.fem(), fibrousBox(0));
    world.fem().setMaterial(&cube, fibrous({1, 0, 0}));
    std::vector<unsigned char> before, after;
    world.fem().saveDefinition(&cube, before);
    const auto refusal = [&](void (*spoil)(btFemMaterial&))
    {
        btFemMaterial material = fibrous({1, 0, 0});
        spoil(material);
        std::string why;
        EXPECT_FALSE(world.fem().setMaterial(&cube, material, &why));
        EXPECT_THROW(world.fem().setMaterial(&cube, material), std::invalid_argument);
        return why;
    };
    EXPECT_THAT(refusal([](btFemMaterial& m) { m.m_orthotropic.m_young[1] = -1; }), HasSubstr("E2 [Pa] is -1"));
    EXPECT_THAT(refusal([](btFemMaterial& m) { m.m_orthotropic.m_poisson[0] = 5; }), HasSubstr("sqrt(E1 / E2)"));
    EXPECT_THAT(refusal([](btFemMaterial& m) { m.m_orthotropic.m_along = btVector3(0, 0, 0); }),
                HasSubstr("axis 1 is (0, 0, 0)"));
    EXPECT_THAT(refusal([](btFemMaterial& m) { m.m_yieldStress = 100; }), HasSubstr("orthotropic law"));
    EXPECT_THAT(refusal([](btFemMaterial& m) { m.m_law = static_cast<btFemElasticLaw>(50); }), HasSubstr("[0, "));
    world.fem().saveDefinition(&cube, after);
    EXPECT_TRUE(before == after);
}

}  // namespace
}  // namespace bullet_fem
