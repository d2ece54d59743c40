// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <string>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/each_world.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

btSoftBody& addCube(SoftWorld& world)
{
    return addUnitCube(world, btVector3(0, 0, 0));
}

class Loads : public EachWorld
{
};

INSTANTIATE_TEST_SUITE_P(Worlds, Loads, eachWorld(), nameOfWorld);

class Steps : public EachWorld
{
};

INSTANTIATE_TEST_SUITE_P(Worlds, Steps, eachWorld(), nameOfWorld);

TEST_P(Loads, AForceOfTheUserAcceleratesByForceOverMass)
{
    FemWorld world(GetParam(), btVector3(0, 0, 0));
    btSoftBody& cube = addCube(world);
    const double mass = massOf(cube);
    for (int k = 0; k < 60; ++k)
    {
        cube.m_nodes[0].m_f += btVector3(0, btScalar(3 * mass), 0);  // on a corner
        world.step();
        EXPECT_EQ(cube.m_nodes[0].m_f, btVector3(0, 0, 0));  // it acts for one step
        EXPECT_NEAR(velocityOf(cube).y, 3 * (k + 1) * double(kStep), 1e-6 * 3);
    }
    cube.addForce(btVector3(btScalar(2 * mass), 0, 0));
    const double before = velocityOf(cube).x;
    world.step();
    EXPECT_GT(velocityOf(cube).x - before, 1e-3);
}

// In a deformable world the gravity is that of its forces.
class LoadsOfTheWorldInfo : public EachWorld
{
};

INSTANTIATE_TEST_SUITE_P(Worlds, LoadsOfTheWorldInfo, testing::Values(WorldClass::softRigid, WorldClass::softMultiBody),
                         nameOfWorld);

TEST_P(LoadsOfTheWorldInfo, GravityIsThatOfTheBodysOwn)
{
    FemWorld world(GetParam());
    btSoftBodyWorldInfo moon = world.info();
    moon.m_gravity = btVector3(0, 0, btScalar(-1.62));
    btSoftBody& onEarth = addCube(world);
    btSoftBody* made = btFemHelpers::createBox(moon, btVector3(5, 0, 0), btVector3(0.5, 0.5, 0.5), btScalar(0.5));
    btSoftBody& onMoon = world.addSoft(made);
    world.step(60);
    EXPECT_NEAR(velocityOf(onEarth).z, -kGravity * 60 * kStep, 1e-5 * kGravity);
    EXPECT_NEAR(velocityOf(onMoon).z, -1.62 * 60 * kStep, 1e-5 * 1.62);
    EXPECT_NEAR(centerOf(onEarth).z, -kGravity * kStep * kStep * 60 * 60 / 2, 1e-5 * kGravity);
}

TEST_P(Loads, WindPushesAndDragFollowsBulletsCoefficient)
{
    double speed[2];
    for (const int k : {0, 1})
    {
        FemWorld world(GetParam(), btVector3(0, 0, 0));
        btSoftBody& cube = addCube(world);
        cube.m_cfg.aeromodel = btSoftBody::eAeroModel::F_TwoSided;
        cube.m_cfg.kDG = btScalar(k == 0 ? 0.05 : 0.1);
        cube.setWindVelocity(btVector3(20, 0, 0));
        cube.setVelocity(btVector3(0, 1, 0));  // Bullet limits wind on a node to the impulse that stops it
        world.step(10);
        speed[k] = velocityOf(cube).x;
    }
    EXPECT_GT(speed[0], 1e-4);
    EXPECT_NEAR(speed[1] / speed[0], 2, 0.05);
}

TEST_P(Loads, BulletsDampingSlowsAFlyingBodyAsItDoesBulletsBodies)
{
    FemWorld world(GetParam(), btVector3(0, 0, 0));
    btSoftBody& cube = addCube(world);
    (GetParam() == WorldClass::deformable ? cube.m_cfg.drag : cube.m_cfg.kDP) = btScalar(0.02);  // as Bullet's bodies
    cube.setVelocity(btVector3(1, 0, 0));
    world.step(50);
    EXPECT_NEAR(velocityOf(cube).x, std::pow(0.98, 50), 1e-4);
}

TEST_P(Loads, UserSetVelocitiesAreTakenOver)
{
    FemWorld world(GetParam(), btVector3(0, 0, 0));
    btSoftBody& cube = addCube(world);
    cube.setVelocity(btVector3(1, 2, 3));
    world.step(10);
    EXPECT_LT(norm(velocityOf(cube) - Vec3{1, 2, 3}), 1e-6);
    cube.addVelocity(btVector3(-1, 0, 0));
    world.step(10);
    EXPECT_LT(norm(velocityOf(cube) - Vec3{0, 2, 3}), 1e-6);
    cube.addVelocity(btVector3(0, 0, 1), 3);  // a node
    const double share = 1 / (cube.m_nodes[3].m_im * massOf(cube));
    world.step(1);
    EXPECT_NEAR(velocityOf(cube).z, 3 + share, 1e-5);
}

TEST_P(Loads, TranslateInMidRunTeleportsWithoutDeforming)
{
    std::vector<Vec3> shape[2];
    Vec3 pin[2];
    for (const int k : {0, 1})
    {
        FemWorld world(GetParam());
        btFemSoftBodySolver& fem = world.fem();
        btSoftBody& cube = addCube(world);
        cube.setMass(0, 0);  // pins follow
        world.step(30);
        if (k == 1) cube.translate(btVector3(10, 20, 5));
        world.step(5);
        shape[k] = edgesOf(cube);
        pin[k] = vec3(cube.m_nodes[0].m_x);
        EXPECT_EQ(fem.stepReport(&cube).m_flags, 0);
    }
    EXPECT_LT(norm(pin[1] - pin[0] - Vec3{10, 20, 5}), 1e-5);
    EXPECT_LT(largestDifference(shape[0], shape[1]),
              1e-4);  // the rounding of positions 20 m away, times some stiffness
}

TEST_P(Loads, RotateTurnsTheBodyAndItsShapeStays)
{
    FemWorld world(GetParam(), btVector3(0, 0, 0));
    btSoftBody& cube = addCube(world);
    world.step(2);
    const btQuaternion turn(btVector3(1, 2, 3).normalized(), btScalar(1.3));
    cube.rotate(turn);
    const std::vector<Vec3> shape = edgesOf(cube);
    world.step(60);
    EXPECT_LT(largestDifference(shape, edgesOf(cube)), 1e-4);
    EXPECT_LT(fastestNode(cube), 1e-3);
}

TEST_P(Steps, SubStepsFallAsFarAsSingleOnes)
{
    FemWorld world(GetParam());
    btFemSoftBodySolver& fem = world.fem();
    btSoftBody& cube = addCube(world);
    for (int k = 0; k < 20; ++k) world.bullet().stepSimulation(btScalar(0.05), 10, btScalar(1) / 120);
    const double n = 120;
    EXPECT_NEAR(centerOf(cube).z, -kGravity * n * n / 2 / (120 * 120), 0.02 * kGravity / 2);
    EXPECT_NEAR(velocityOf(cube).z, -kGravity, 0.02 * kGravity);
    EXPECT_EQ(fem.stepReport(&cube).m_flags, 0);
}

TEST_P(Steps, TimescaleIsAFactorOnTheStepOfABody)
{
    FemWorld world(GetParam());
    btSoftBody& cube = addCube(world);
    cube.m_cfg.timescale = btScalar(0.5);
    world.step(1);
    EXPECT_EQ(world.fem().stepReport(&cube).m_flags, 0);  // factored for this step
    world.step(59);
    const double h = 0.5 * kStep;
    EXPECT_NEAR(velocityOf(cube).z, -kGravity * 60 * h, 1e-4);
    EXPECT_NEAR(centerOf(cube).z, -kGravity * h * h * 60 * 60 / 2, 1e-4);
}

TEST_P(Steps, ChangedStepIsFlaggedAsStaleUntilRefactored)
{
    FemWorld world(GetParam());
    btFemSoftBodySolver& fem = world.fem();
    btSoftBody& cube = addCube(world);
    cube.setMass(0, 0);
    world.step(10);
    EXPECT_EQ(fem.stepReport(&cube).m_flags, 0);
    world.step(10, btScalar(1) / 100);
    EXPECT_EQ(fem.stepReport(&cube).m_flags, BT_FEM_STALE_FACTOR);
    EXPECT_LT(fem.stepReport(&cube).m_residual, 1e-3);
    fem.refactor(&cube);
    world.step(1, btScalar(1) / 100);
    EXPECT_EQ(fem.stepReport(&cube).m_flags, 0);
    EXPECT_TRUE(allFinite(cube));
}

// A body in contact is refactored at once if the step differs much from the factor's.
TEST_P(Steps, RecurringStepsInContactAreRefactored)
{
    FemWorld world(GetParam());
    btFemSoftBodySolver& fem = world.fem();
    world.addPlane(btScalar(-0.501));
    btSoftBody& cube = addCube(world);
    world.step(30);
    int refactored = 0;
    for (int k = 0; k < 40; ++k)
    {
        world.step(1, btScalar(1) / (k % 2 == 0 ? 60 : 120));
        refactored += (fem.stepReport(&cube).m_flags & BT_FEM_REFACTORED) != 0;
    }
    EXPECT_EQ(refactored, 39);
    EXPECT_TRUE(allFinite(cube));
}

// --- Queries without exceptions ---

TEST(Valid, ReportsTheErrorsOfSetMaterial)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem);
    std::string why;
    EXPECT_TRUE(btFemSoftBodySolver::valid(&addCube(world), &why)) << why;
    EXPECT_FALSE(btFemSoftBodySolver::valid(nullptr, &why));
    EXPECT_NE(why.find("null"), std::string::npos) << why;

    const btVector3 corners[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    btSoftBody flat(&world.info(), 4, corners, nullptr);
    EXPECT_FALSE(btFemSoftBodySolver::valid(&flat, &why));
    EXPECT_NE(why.find("no tetrahedra"), std::string::npos) << why;
    flat.appendTetra(0, 1, 2, 3);
    EXPECT_FALSE(btFemSoftBodySolver::valid(&flat, &why));
    EXPECT_NE(why.find("element 0"), std::string::npos) << why;
    EXPECT_FALSE(btFemSoftBodySolver::valid(&flat));
}

}  // namespace
}  // namespace bullet_fem
