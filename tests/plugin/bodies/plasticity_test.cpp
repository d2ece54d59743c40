// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Plastic and relaxing bodies in Bullet's worlds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "bullet_fem/btFemHelpers.h"
#include "plugin/record/btFemBodyRecord.h"
#include "plugin/record/btFemCoupling.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/snapshot_scene.h"

namespace bullet_fem
{
namespace
{

btFemMaterial softClay()
{
    btFemMaterial clay = btFemMaterial::clay();
    clay.m_stiffnessDamping = btScalar(0.005);
    return clay;
}

// A panel of 1 x 1 x 0.2 m on the ground, and a ball of 400 kg that falls on its middle from 0.1 m above.
class DentedPanel
{
public:
    DentedPanel(Coupling coupling, const btFemMaterial& material) : m_scene(coupling)
    {
        m_scene.m_world.addPlane();
        m_panel = &m_scene.add({{1, 1, 0.2}, {10, 10, 2}, {0, 0, 0.1}});
        m_scene.m_fem.setMaterial(m_panel, material);
        m_ball = &m_scene.m_world.addRigid(new btSphereShape(btScalar(0.3)), {400, at(0, 0, btScalar(0.6))});
        m_scene.m_rigid.push_back(m_ball);
    }

    void takeBallAway()
    {
        m_scene.m_rigid.clear();
        m_scene.m_world.deleteRigid(*m_ball);
    }

    // Depth of the middle of the upper face below the midpoints of its edges [m], at half the length.
    double dent(double length = 1) const
    {
        const double x = length / 2;
        return (height(x, 0) + height(-x, 0) + height(0, x) + height(0, -x)) / 4 - height(0, 0);
    }

    double largestPlasticStrain() const
    {
        btAlignedObjectArray<btScalar> strain;
        if (!m_scene.m_fem.getPlasticStrain(m_panel, strain)) return 0;
        EXPECT_EQ(strain.size(), m_panel->m_tetras.size());
        btScalar largest = 0;
        for (int e = 0; e < strain.size(); ++e) largest = std::max(largest, strain[e]);
        return double(largest);
    }

    SnapshotScene m_scene;
    btSoftBody* m_panel;
    btRigidBody* m_ball;

private:
    // Height of the uppermost node near a place.
    double height(double x, double y) const
    {
        double highest = -1;
        for (int i = 0; i < m_panel->m_nodes.size(); ++i)
        {
            const btVector3& at = m_panel->m_nodes[i].m_x;
            if (std::hypot(double(at.x()) - x, double(at.y()) - y) < 0.05) highest = std::max(highest, double(at.z()));
        }
        return highest;
    }
};

class PlasticityOfABody : public testing::TestWithParam<Coupling>
{
};

TEST_P(PlasticityOfABody, APanelStaysDented)
{
    btFemMaterial elastic = softClay();
    elastic.m_yieldStress = std::numeric_limits<btScalar>::infinity();
    DentedPanel clay(GetParam(), softClay()), rubber(GetParam(), elastic);
    for (DentedPanel* panel : {&clay, &rubber})
    {
        panel->m_scene.m_world.step(60);
        panel->takeBallAway();
        panel->m_scene.m_world.step(60);
    }
    // Clay bears about 3 sigma_y under a ball (Tabor 1951), on the area 2 pi R d: d lies between 14 mm, from the ball's
    // weight, and 68 mm, from its kinetic energy.
    EXPECT_GT(clay.dent(), 0.014);
    EXPECT_LT(clay.dent(), 0.068);
    EXPECT_GT(clay.largestPlasticStrain(), 0.05);
    EXPECT_LT(std::fabs(rubber.dent()), 0.001);
    EXPECT_EQ(rubber.largestPlasticStrain(), 0);
    const double dent = clay.dent();
    clay.m_scene.m_world.step(60);
    EXPECT_NEAR(clay.dent(), dent, 1e-4);
}

// Neither its weight nor a rotation causes plastic strain.
TEST_P(PlasticityOfABody, RestingPanelDoesNotYield)
{
    DentedPanel clay(GetParam(), softClay());
    clay.takeBallAway();
    clay.m_scene.m_world.step(60);
    EXPECT_EQ(clay.largestPlasticStrain(), 0);
}

// Restored while the ball indents the panel: the run continues bitwise equal, with equal plastic strains.
TEST_P(PlasticityOfABody, ADentIsRestored)
{
    DentedPanel clay(GetParam(), softClay());
    SnapshotScene& scene = clay.m_scene;
    scene.m_world.step(10);
    ASSERT_GT(scene.contacts(), 0);
    ASSERT_GT(clay.largestPlasticStrain(), 0.01);
    const double strain = clay.largestPlasticStrain();
    const SnapshotScene::Saved saved = scene.saveAll();
    const std::vector<double> bits = scene.run(50);
    const double dent = clay.dent();
    ASSERT_NE(clay.largestPlasticStrain(), strain);
    scene.restore(saved);
    EXPECT_EQ(clay.largestPlasticStrain(), strain);
    EXPECT_TRUE(scene.save() == saved.m_fem);
    EXPECT_TRUE(scene.run(50) == bits);
    EXPECT_EQ(clay.dent(), dent);
}

// Bullet's scale() makes the present shape the rest shape: the scaled dent is part of it, and does not grow.
TEST_P(PlasticityOfABody, ADentIsScaled)
{
    DentedPanel clay(GetParam(), softClay());
    clay.m_scene.m_world.step(60);
    clay.takeBallAway();
    clay.m_scene.m_world.step(60);
    const double dent = clay.dent(), strain = clay.largestPlasticStrain();
    clay.m_panel->scale(btVector3(2, 2, 2));
    clay.m_scene.m_world.step(60);
    EXPECT_NEAR(clay.dent(2), 2 * dent, 0.1 * dent);
    EXPECT_EQ(clay.largestPlasticStrain(), strain);
}

// A new material with a new factor keeps the dent.
TEST_P(PlasticityOfABody, ADentOutlivesTheMaterial)
{
    DentedPanel clay(GetParam(), softClay());
    clay.m_scene.m_world.step(60);
    clay.takeBallAway();
    clay.m_scene.m_world.step(60);
    const double dent = clay.dent();
    btFemMaterial fired = softClay();
    fired.m_youngModulus *= 2;
    fired.m_yieldStress = std::numeric_limits<btScalar>::infinity();
    clay.m_scene.m_fem.setMaterial(clay.m_panel, fired);
    clay.m_scene.m_world.step(60);
    EXPECT_NEAR(clay.dent(), dent, 0.05 * dent);
}

INSTANTIATE_TEST_SUITE_P(Couplings, PlasticityOfABody, testing::Values(Coupling::swap, Coupling::coupled),
                         [](const auto& suite) { return couplingName(suite.param); });

TEST(PlasticityOfBodies, BadMaterialsAreRefused)
{
    const auto why = [](btScalar btFemMaterial::*member, double value)
    {
        btFemMaterial material;
        material.*member = btScalar(value);
        std::string text;
        EXPECT_FALSE(material.valid(&text));
        return text;
    };
    EXPECT_NE(why(&btFemMaterial::m_yieldStress, 0).find("yield stress [Pa] is 0, outside (0, inf]"),
              std::string::npos);
    EXPECT_NE(why(&btFemMaterial::m_plasticCreep, 0).find("plastic creep [1/s] is 0"), std::string::npos);
    EXPECT_NE(why(&btFemMaterial::m_hardeningModulus, -1).find("hardening modulus [Pa] is -1"), std::string::npos);
    EXPECT_NE(why(&btFemMaterial::m_mostPlasticStrain, 1).find("largest plastic strain [-] is 1"), std::string::npos);
}

// A body's model has the exact material parameters; the maximum share has no exact binary representation.
TEST(PlasticityOfBodies, MaterialsComeWhole)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem);
    btSoftBody& cube = addUnitCube(world, {0, 0, 3});
    btFemMaterial material = btFemMaterial::lead();
    material.m_plasticCreep = 3;
    material.m_mostPlasticStrain = btScalar(0.25);
    material.m_relaxation[0] = {btScalar(0.99), 2};
    fem.setMaterial(&cube, material);
    world.step();
    const Material& own = btFemCoupling::record(fem, cube)->fem().m_body.m_model->shape().m_material;
    EXPECT_EQ(own.m_yieldStress, 5.5e6);
    EXPECT_EQ(own.m_hardeningModulus, 20e6);
    EXPECT_EQ(own.m_plasticCreep, 3);
    EXPECT_EQ(own.m_mostPlasticStrain, 0.25);
    EXPECT_EQ(own.relaxationTerms(), 1);
    EXPECT_EQ(own.m_relaxation[0].m_share, 0.99);
    EXPECT_EQ(own.m_relaxation[0].m_time, 2);
}

TEST(RelaxationOfBodies, BoundsAreTakenInEveryPrecision)
{
    btFemMaterial material;
    material.m_relaxation[0] = {btScalar(0.33), btScalar(1e-6)};
    material.m_relaxation[1] = {btScalar(0.33), 1};
    material.m_relaxation[2] = {btScalar(0.33), btScalar(1e9)};
    std::string why;
    EXPECT_TRUE(material.valid(&why)) << why;
    material.m_relaxation[0].m_time = btScalar(9e-7);
    EXPECT_FALSE(material.valid());
    material.m_relaxation[0] = {btScalar(0.34), 1};
    EXPECT_FALSE(material.valid()) << "1 in total";
}

// Depth [m] of the dent that a kinematic ball of 0.2 m radius leaves when it is pressed by 20 mm into clay 0.1 m thick
// on a rigid base, where it loses contact, and the force at that depth [N].
std::pair<double, double> dentOf(int cellsAcross)
{
    constexpr double kRadius = 0.2, kThick = 0.1, kDepth = 0.02, kStep = 1.0 / 240;
    btFemSoftBodySolver fem;
    SoftWorld world(fem, Coupling::coupled, btVector3(0, 0, 0));
    const int n = cellsAcross;
    btSoftBody& panel = addSoftBox(world, fem, {{0.3, 0.3, kThick}, {3 * n, 3 * n, n}, {0, 0, kThick / 2}});
    fem.setMaterial(&panel, softClay());
    for (int i = 0; i < panel.m_nodes.size(); ++i)
        if (panel.m_nodes[i].m_x.z() < btScalar(1e-3)) panel.setMass(i, 0);
    const auto poseAt = [&](double depth) { return at(0, 0, btScalar(kThick + kRadius - depth)); };
    btRigidBody& ball = world.addRigid(new btSphereShape(btScalar(kRadius)), {0, poseAt(-1e-3)});
    ball.setCollisionFlags(ball.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    const auto force = [&] { return -double(fem.contactForce(&panel, &ball).z()); };
    const auto moveTo = [&](double depth)
    {
        ball.getMotionState()->setWorldTransform(poseAt(depth));
        world.step(1, btScalar(kStep));
    };
    for (int k = 0; k <= 240; ++k) moveTo(kDepth * k / 240);
    for (int k = 0; k < 24; ++k) moveTo(kDepth);
    const double held = force();
    double depth = kDepth;
    while (depth > 0 && force() > 0.02 * held) moveTo(depth -= 1e-4);
    return {depth, held};
}

// Both are resolved by cells of 50 mm as by those of 25 mm; the elastic part springs back.
TEST(PlasticityOfBodies, DentsAreAlikeAtTwoMeshSizes)
{
    const auto [coarse, coarseForce] = dentOf(2);
    const auto [fine, fineForce] = dentOf(4);
    EXPECT_NEAR(coarse / fine, 1, 0.05);
    EXPECT_NEAR(coarseForce / fineForce, 1, 0.1);
    EXPECT_LT(fine, 0.019);
    EXPECT_GT(fine, 0.015);
}

// A cube at rest on the ground sags more as its modulus relaxes: half the modulus, twice the sag.
TEST(RelaxationOfBodies, ACubeSinksSlowly)
{
    btFemSoftBodySolver fem(implicitEuler());
    SoftWorld world(fem);
    world.addPlane();
    btSoftBody& cube = addSoftBox(world, fem, {{1, 1, 1}, {3, 3, 3}, {0, 0, 0.5}});
    cube.m_cfg.kDF = 0;  // it also widens
    btFemMaterial material;
    material.m_youngModulus = btScalar(2e5);
    material.m_poissonRatio = 0;
    material.m_massDamping = 2;
    material.m_relaxation[0] = {btScalar(0.5), 2};
    material.m_bending = btFemBending::plain;
    fem.setMaterial(&cube, material);
    const auto top = [&cube]
    {
        double sum = 0;
        int count = 0;
        for (int i = 0; i < cube.m_nodes.size(); ++i)
        {
            if (cube.m_nodes[i].m_q.z() < btScalar(0.9)) continue;
            sum += double(cube.m_nodes[i].m_x.z());
            ++count;
        }
        return sum / count;
    };
    // nu = 0, initially rho g L^2 / 2 E. With G at half of its initial value and the bulk modulus E / 3 constant, E(t)
    // = 9 K G / (3 K + G) = .6 E; shear contributes 2/3 of the column's stiffness K + 4/3 G at nu = 0.
    const double fast = 1000 * kGravity / 2 / 2e5;
    world.step(1200);
    EXPECT_NEAR(1 - top(), fast / 0.6, 0.05 * fast);
}

TEST(PlasticityOfBodies, OtherBodiesHaveNoPlasticStrain)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem);
    btAlignedObjectArray<btScalar> strain;
    strain.push_back(3);
    EXPECT_FALSE(fem.getPlasticStrain(nullptr, strain));
    EXPECT_EQ(strain.size(), 0);
    btSoftBody& cube = addUnitCube(world, {0, 0, 3});
    EXPECT_FALSE(fem.getPlasticStrain(&cube, strain));
    world.step();
    EXPECT_FALSE(fem.getPlasticStrain(&cube, strain));
    fem.setMaterial(&cube, softClay());
    world.step();
    ASSERT_TRUE(fem.getPlasticStrain(&cube, strain));
    EXPECT_EQ(strain.size(), cube.m_tetras.size());
    for (int e = 0; e < strain.size(); ++e) EXPECT_EQ(strain[e], 0);
}

}  // namespace
}  // namespace bullet_fem
