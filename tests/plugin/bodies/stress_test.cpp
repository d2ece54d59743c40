// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>

#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/clamped_beam.h"
#include "plugin/scenes/scene_measures.h"

namespace bullet_fem
{
namespace
{

using Stresses = btAlignedObjectArray<btFemStress>;
using Scalars = btAlignedObjectArray<btScalar>;

Vec3 centreOf(const btSoftBody& body, int tet)
{
    Vec3 sum;
    for (const btSoftBody::Node* node : body.m_tetras[tet].m_n) sum += vec3(node->m_x);
    return 0.25 * sum;
}

// A body fixed at its upper end carries at each height the weight below: rho g z per m2 of section. At some distance
// from the upper end, where contraction is free, that is the von Mises stress, too.
TEST(StressOfABody, HangingBodyCarriesTheWeightBelow)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem);
    SoftBox box;
    box.m_size = {1, 1, 4};
    box.m_cells = {2, 2, 8};
    box.m_center = {0, 0, 2};
    btSoftBody& bar = addSoftBox(world, fem, box);
    btFemMaterial material;
    material.m_youngModulus = btScalar(1e7);
    material.m_density = 1000;
    material.m_massDamping = 20;
    fem.setMaterial(&bar, material);
    for (int i = 0; i < bar.m_nodes.size(); ++i)
        if (bar.m_nodes[i].m_x.z() > btScalar(3.999)) bar.setMass(i, 0);
    world.step(120);
    Stresses stress;
    Scalars vonMises;
    ASSERT_TRUE(fem.getStress(&bar, stress));
    ASSERT_TRUE(fem.getVonMises(&bar, vonMises));
    ASSERT_EQ(stress.size(), bar.m_tetras.size());
    ASSERT_EQ(vonMises.size(), bar.m_tetras.size());
    double carried = 0, expected = 0;
    for (int e = 0; e < stress.size(); ++e)
    {
        const double z = centreOf(bar, e).z;
        const bool inside = z > 1 && z < 3;
        carried += inside * double(stress[e].m_zz);
        expected += inside * 1000 * kGravity * z;
        EXPECT_NEAR(double(vonMises[e]), double(stress[e].vonMises()), 1e-5 * double(vonMises[e]));
        EXPECT_LT(inside * std::fabs(double(vonMises[e]) / (1000 * kGravity * z) - 1), 0.3);
    }
    EXPECT_NEAR(carried / expected, 1, 0.01);
}

TEST(StressOfABody, IsLargestAtTheClampOfABeam)
{
    ClampedBeam::Settings settings;
    settings.m_massDamping = 5;
    settings.m_youngModulus = btScalar(1e7);
    ClampedBeam beam(settings);
    beam.step(120);
    Scalars perNode;
    Stresses stress;
    ASSERT_TRUE(beam.fem().getNodeVonMises(&beam.body(), perNode));
    ASSERT_TRUE(beam.fem().getNodeStress(&beam.body(), stress));
    ASSERT_EQ(perNode.size(), beam.body().m_nodes.size());
    int hottest = 0;
    for (int i = 0; i < perNode.size(); ++i)
        if (perNode[i] > perNode[hottest]) hottest = i;
    const btVector3 place = beam.body().m_nodes[hottest].m_x;
    EXPECT_LT(place.x(), btScalar(-1.5));  // the range is -2 to 2
    EXPECT_GT(std::fabs(place.z()), btScalar(0.45));
    EXPECT_NEAR(double(perNode[hottest]), double(stress[hottest].vonMises()), 1e-5 * double(perNode[hottest]));
    // Tension above, compression below; three cells through the thickness give .7 of M / W (docs/theory.md).
    const double fibre = 1000 * kGravity * 4 * 4 / 2 * 6;
    EXPECT_NEAR(double(perNode[hottest]) / fibre, 0.7, 0.1);
    EXPECT_GT(double(stress[hottest].m_xx) * place.z(), 0);
}

// Zero to single precision, in which a step with a tolerance of 1e-3 computes strains.
TEST(StressOfABody, IsZeroAtRestForATurnedBody)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem, btVector3(0, 0, 0));
    btSoftBody& cube = addUnitCube(world, btVector3(0, 0, 0));
    world.step();
    btTransform turn;
    turn.setIdentity();
    turn.setRotation(btQuaternion(btVector3(1, 2, 3).normalized(), btScalar(2.5)));
    cube.transform(turn);
    world.step(3);
    Scalars vonMises;
    ASSERT_TRUE(fem.getVonMises(&cube, vonMises));
    for (int e = 0; e < vonMises.size(); ++e) EXPECT_LT(vonMises[e], 1e6 * 20 * FLT_EPSILON);
}

TEST(StressOfABody, IsThereOnceTheBodyIsPrepared)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem);
    btSoftBody& cube = addUnitCube(world, btVector3(0, 0, 1));
    Scalars vonMises;
    EXPECT_FALSE(fem.getVonMises(&cube, vonMises));
    for (int i = 0; i < cube.m_nodes.size(); ++i) cube.m_nodes[i].m_x.setX(cube.m_nodes[i].m_x.x() * btScalar(1.01));
    fem.prepare(&cube, kStep);
    ASSERT_TRUE(fem.getVonMises(&cube, vonMises));
    const double shear = 1e6 / 2.6;  // of the default material, nu .3
    for (int e = 0; e < vonMises.size(); ++e) EXPECT_NEAR(double(vonMises[e]), 2 * shear * 0.01, 0.02 * shear * 0.01);
}

// The nodes of the lower face carry the weight.
TEST(ContactForcesOfNodes, CarryTheWeight)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem);
    btRigidBody& plane = world.addPlane();
    btSoftBody& cube = addUnitCube(world, btVector3(0, 0, btScalar(0.501)));
    btAlignedObjectArray<btVector3> forces;
    EXPECT_FALSE(fem.getContactForces(&cube, forces));
    world.step(120);
    ASSERT_TRUE(fem.getContactForces(&cube, forces));
    ASSERT_EQ(forces.size(), cube.m_nodes.size());
    btVector3 sum(0, 0, 0);
    for (int i = 0; i < forces.size(); ++i)
    {
        sum += forces[i];
        EXPECT_EQ(forces[i].z() > 0, cube.m_nodes[i].m_x.z() < btScalar(0.1)) << i;
    }
    const double weight = massOf(cube) * kGravity;
    EXPECT_NEAR(double(sum.z()), weight, 1e-3 * weight);
    EXPECT_LT(double((sum - fem.contactForce(&cube, &plane)).length()), 1e-5 * weight);
    cube.appendNode(btVector3(5, 5, 5), 1);
    EXPECT_FALSE(fem.getContactForces(&cube, forces));
    EXPECT_EQ(forces.size(), 0);
}

TEST(StressOfABody, IsMissingForOtherBodies)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem);
    btSoftBody& cube = addUnitCube(world, btVector3(0, 0, 3));
    btSoftBody& rope = world.addSoft(btSoftBodyHelpers::CreateRope(world.info(), {0, 0, 0}, {1, 0, 0}, 4, 0));
    world.step();
    Stresses stress;
    Scalars scalars;
    ASSERT_TRUE(fem.getStress(&cube, stress));
    ASSERT_TRUE(fem.getNodeVonMises(&cube, scalars));
    EXPECT_FALSE(fem.getStress(&rope, stress));
    EXPECT_FALSE(fem.getNodeVonMises(nullptr, scalars));
    EXPECT_EQ(stress.size(), 0);
    EXPECT_EQ(scalars.size(), 0);

    cube.appendNode(btVector3(5, 5, 5), 1);
    EXPECT_FALSE(fem.getNodeStress(&cube, stress));
    EXPECT_EQ(stress.size(), 0);
}

}  // namespace
}  // namespace bullet_fem
