// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include "BulletSoftBody/btDefaultSoftBodySolver.h"
#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "plugin/scenes/each_world.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{
namespace
{

/// Cloth, rope, a balloon and clusters that fall on rigid bodies and on each other.
std::vector<btSoftBody*> addPlainBodies(SoftWorld& world)
{
    world.addFloorBox();
    RigidSettings stone;
    stone.m_mass = 5;
    stone.m_transform = at(btScalar(0.2), 0, 3);
    world.addRigid(new btBoxShape(btVector3(btScalar(0.4), btScalar(0.4), btScalar(0.4))), stone);
    stone.m_transform = at(5, 0, btScalar(0.5));
    world.addRigid(new btSphereShape(btScalar(0.5)), stone);

    btSoftBodyWorldInfo& info = world.info();
    btSoftBody* cloth = btSoftBodyHelpers::CreatePatch(info, btVector3(-2, -2, 2), btVector3(2, -2, 2),
                                                       btVector3(-2, 2, 2), btVector3(2, 2, 2), 12, 12, 1 + 2, true);
    cloth->m_cfg.collisions |= btSoftBody::fCollision::VF_SS;
    btSoftBody* rope = btSoftBodyHelpers::CreateRope(info, btVector3(5, -2, 2), btVector3(5, 2, 2), 16, 0);
    btSoftBody* ball = btSoftBodyHelpers::CreateEllipsoid(info, btVector3(-5, 0, 2), btVector3(1, 1, 1), 128);
    ball->m_cfg.kPR = 500;
    ball->m_cfg.kDF = 1;
    ball->setTotalMass(10, true);
    const btScalar corners[] = {-1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1, 0, 0, 1};
    const int triangles[] = {0, 2, 1, 0, 3, 2, 0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4};
    btSoftBody* pyramid = btSoftBodyHelpers::CreateFromTriMesh(info, corners, triangles, 6);
    pyramid->translate(btVector3(0, 6, 2));
    pyramid->generateBendingConstraints(2);
    btSoftBody* clusters = btSoftBodyHelpers::CreateEllipsoid(info, btVector3(0, -6, 2), btVector3(1, 1, 1), 96);
    clusters->m_cfg.collisions = btSoftBody::fCollision::CL_RS + btSoftBody::fCollision::CL_SS;
    clusters->generateClusters(8);
    std::vector<btSoftBody*> bodies = {cloth, rope, ball, pyramid, clusters};
    for (btSoftBody* body : bodies) world.addSoft(body);
    return bodies;
}

// In a deformable world its own solver moves them.
class PlainBodies : public EachWorld
{
};

INSTANTIATE_TEST_SUITE_P(Worlds, PlainBodies, testing::Values(WorldClass::softRigid, WorldClass::softMultiBody),
                         nameOfWorld);

TEST_P(PlainBodies, MoveBitForBitAsWithBulletsOwnSolverBesideAFemBody)
{
    btDefaultSoftBodySolver plain;
    btFemSoftBodySolver fem;
    SoftWorld plainWorld(GetParam(), plain), femWorld(GetParam(), fem);
    const std::vector<btSoftBody*> expected = addPlainBodies(plainWorld), bodies = addPlainBodies(femWorld);
    btSoftBody& cube = femWorld.addSoft(btFemHelpers::createBox(femWorld.info(), btVector3(40, 40, btScalar(0.6)),
                                                                btVector3(0.5, 0.5, 0.5), btScalar(0.5)));
    for (int k = 0; k < 600; ++k)
    {
        plainWorld.step();
        femWorld.step();
        for (std::size_t b = 0; b < bodies.size(); ++b)
            ASSERT_EQ(bitsOf(*bodies[b]), bitsOf(*expected[b])) << "body " << b << ", step " << k;
    }
    for (const btSoftBody* body : bodies)
    {
        EXPECT_FALSE(fem.isFem(body));
        EXPECT_EQ(fem.stepReport(body).m_nodes, 0);
        EXPECT_EQ(fem.contacts(body).size(), 0);
    }
    EXPECT_TRUE(fem.isFem(&cube));
    EXPECT_GT(fem.contacts(&cube).size(), 0);
    EXPECT_LT(lowestHeight(*bodies[0]), 0.5);  // they fell, and stayed on the ground
}

// Bodies with the flag collide with FEM bodies: see ClothOnFemBodies.
TEST_P(PlainBodies, LeaveFemBodiesAloneWithoutTheSoftBodyFlag)
{
    std::vector<btScalar> bits[2];
    for (const int k : {0, 1})
    {
        FemWorld world(GetParam());
        world.addFloorBox();
        btSoftBody& cube = world.addSoft(btFemHelpers::createBox(world.info(), btVector3(0, 0, btScalar(0.51)),
                                                                 btVector3(0.5, 0.5, 0.5), btScalar(0.25)));
        cube.m_cfg.collisions |= btSoftBody::fCollision::VF_SS;
        if (k == 1)
        {
            const btScalar z = btScalar(1.2);
            world.addSoft(btSoftBodyHelpers::CreatePatch(world.info(), btVector3(-1, -1, z), btVector3(1, -1, z),
                                                         btVector3(-1, 1, z), btVector3(1, 1, z), 8, 8, 0, true));
        }
        world.step(120);
        bits[k] = bitsOf(cube);
    }
    EXPECT_EQ(bits[0], bits[1]);
}

}  // namespace
}  // namespace bullet_fem
