// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

constexpr double kShare = 0.16;  // compression of the slab if it were no wider than the box [-]

/// A box of 10 kg on a slab of 1 kg, which is compressed by 5 to 10 %, on a static floor.
struct BoxOnSlab
{
    explicit BoxOnSlab(Coupling coupling) : m_world(m_fem, coupling)
    {
        m_floor = &m_world.addFloorBox();
        SoftBox slab;
        slab.m_size = {0.5, 0.5, 0.1};
        slab.m_cells = {8, 8, 1};
        slab.m_center = {0, 0, 0.0505};
        slab.m_density = 40;
        slab.m_youngModulus = static_cast<btScalar>(m_weight / (0.3 * 0.3) / kShare);
        m_slab = &addSoftBox(m_world, m_fem, slab);
        RigidSettings settings;
        settings.m_mass = 10;
        settings.m_transform = at(0, 0, btScalar(0.1 + 0.1 + 0.001));
        m_box = &addRigidBox(m_world, {0.3, 0.3, 0.2}, settings);
    }

    // Force on the box [N].
    Vec3 force() { return vec3(-m_fem.contactForce(m_slab, m_box)); }

    const double m_weight = 10 * kGravity;  // of the box [N]
    btFemSoftBodySolver m_fem;
    SoftWorld m_world;
    btRigidBody* m_floor;
    btSoftBody* m_slab;
    btRigidBody* m_box;
};

class HeavyBoxOnLightSlabSlow : public testing::TestWithParam<Coupling>
{
};

// The stack is at rest, and in each frame the force on the box is its weight.
TEST_P(HeavyBoxOnLightSlabSlow, RestsInItsSettledPlace)
{
    BoxOnSlab scene(GetParam());
    EXPECT_NEAR(massOf(*scene.m_slab), 1, 1e-5);
    scene.m_world.step(300);
    const Vec3 settled = vec3(scene.m_box->getCenterOfMassPosition());
    EXPECT_NEAR(0.2 - settled.z, 0.0075, 0.0025);  // 5-10 % of the slab
    const double total = scene.m_weight + massOf(*scene.m_slab) * kGravity;
    for (int frame = 0; frame < 20 * 60; ++frame)
    {
        scene.m_world.step();
        ASSERT_LT(norm(scene.force() - Vec3{0, 0, scene.m_weight}), 1e-3 * scene.m_weight) << "frame " << frame;
        ASSERT_NEAR(scene.m_fem.contactForce(scene.m_slab, scene.m_floor).z(), total, 1e-3 * total);
        ASSERT_LT(scene.m_box->getLinearVelocity().length(), 1e-4) << "frame " << frame;
        ASSERT_LT(scene.m_box->getAngularVelocity().length(), 1e-3) << "frame " << frame;
    }
    EXPECT_LT(norm(vec3(scene.m_box->getCenterOfMassPosition()) - settled), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Couplings, HeavyBoxOnLightSlabSlow, testing::Values(Coupling::swap, Coupling::coupled),
                         [](const auto& coupling) { return couplingName(coupling.param); });

constexpr double kEdge = 0.2;  // of every cube [m]
constexpr int kSecond = 60;    // steps

/// Cubes on a static floor, alternately rigid and soft, starting with a rigid one. The lower soft cube is compressed by
/// 1 %: softer columns buckle.
struct AlternatingStack
{
    AlternatingStack(double rigidMass, double softMass) : m_world(m_fem, Coupling::coupled)
    {
        m_floor = &m_world.addFloorBox();
        for (int k = 0; k < 5; ++k)
        {
            const double middle = (k + 0.5) * kEdge;
            if (k % 2 == 0)
            {
                RigidSettings settings;
                settings.m_mass = static_cast<btScalar>(rigidMass);
                settings.m_transform = at(0, 0, static_cast<btScalar>(middle));
                m_rigid.push_back(&addRigidBox(m_world, {kEdge, kEdge, kEdge}, settings));
                continue;
            }
            SoftBox soft;
            soft.m_size = {kEdge, kEdge, kEdge};
            soft.m_cells = {3, 3, 3};
            soft.m_center = {0, 0, middle};
            soft.m_density = static_cast<btScalar>(softMass / (kEdge * kEdge * kEdge));
            const double load = (2 * rigidMass + 1.5 * softMass) * kGravity;
            soft.m_youngModulus = static_cast<btScalar>(load / (kEdge * kEdge) / 0.01);
            m_soft.push_back(&addSoftBox(m_world, m_fem, soft));
        }
    }

    std::vector<Vec3> places() const
    {
        std::vector<Vec3> places;
        for (const btRigidBody* body : m_rigid) places.push_back(vec3(body->getCenterOfMassPosition()));
        for (const btSoftBody* body : m_soft) places.push_back(centerOf(*body));
        return places;
    }

    double fastest() const
    {
        double fastest = 0;
        for (const btRigidBody* body : m_rigid) fastest = std::max(fastest, norm(vec3(body->getLinearVelocity())));
        for (const btSoftBody* body : m_soft) fastest = std::max(fastest, fastestNode(*body));
        return fastest;
    }

    // Upward force of soft body k on the rigid one above [N].
    double forceOver(int k) const { return -m_fem.contactForce(m_soft[k], m_rigid[k + 1]).z(); }

    btFemSoftBodySolver m_fem;
    SoftWorld m_world;
    btRigidBody* m_floor;
    std::vector<btRigidBody*> m_rigid;
    std::vector<btSoftBody*> m_soft;
};

struct StackCase
{
    const char* m_name;
    double m_rigidMass, m_softMass;  // of one cube [kg]
};

class CoupledStack : public testing::TestWithParam<StackCase>
{
};

class CoupledStackSlow : public CoupledStack
{
};

TEST_P(CoupledStackSlow, StandsForAMinute)
{
    const double rigidMass = GetParam().m_rigidMass, softMass = GetParam().m_softMass;
    AlternatingStack stack(rigidMass, softMass);
    stack.m_world.step(5 * kSecond);
    const std::vector<Vec3> settled = stack.places();
    const double upper = rigidMass * kGravity, lower = (2 * rigidMass + softMass) * kGravity;
    double fastest = 0, worst = 0, upperMean = 0, lowerMean = 0;
    const int frames = 55 * kSecond;
    for (int frame = 0; frame < frames; ++frame)
    {
        stack.m_world.step();
        upperMean += stack.forceOver(1) / frames;
        lowerMean += stack.forceOver(0) / frames;
        worst = std::max({worst, std::fabs(stack.forceOver(1) / upper - 1), std::fabs(stack.forceOver(0) / lower - 1)});
        fastest = std::max(fastest, stack.fastest());
    }
    EXPECT_LT(largestDifference(stack.places(), settled), 1e-3);
    EXPECT_LT(fastest, 5e-3);  // a thirtieth of gravity's velocity in a step
    EXPECT_LT(worst, 1e-2);
    EXPECT_NEAR(upperMean, upper, 1e-3 * upper);
    EXPECT_NEAR(lowerMean, lower, 1e-3 * lower);
    EXPECT_LT(std::hypot(settled[2].x, settled[2].y), 1e-3);
}

TEST_P(CoupledStack, FallsAsleepWhenAllowed)
{
    AlternatingStack stack(GetParam().m_rigidMass, GetParam().m_softMass);
    for (btRigidBody* body : stack.m_rigid) body->forceActivationState(ACTIVE_TAG);
    for (btSoftBody* body : stack.m_soft) body->forceActivationState(ACTIVE_TAG);
    stack.m_world.step(8 * kSecond);
    for (const btRigidBody* body : stack.m_rigid) EXPECT_EQ(body->getActivationState(), ISLAND_SLEEPING);
    for (const btSoftBody* body : stack.m_soft)
    {
        EXPECT_EQ(body->getActivationState(), ISLAND_SLEEPING);
        EXPECT_EQ(stack.m_fem.stepReport(body).m_iterations, 0);
    }
    const std::vector<Vec3> asleep = stack.places();
    stack.m_world.step(kSecond);
    EXPECT_EQ(largestDifference(stack.places(), asleep), 0);
    EXPECT_NEAR(stack.forceOver(1), GetParam().m_rigidMass * kGravity, 1e-3 * GetParam().m_rigidMass * kGravity);
}

constexpr StackCase kEqual = {"equal", 8, 8}, kHeavyRigid = {"rigid50", 8, 0.16}, kHeavySoft = {"soft50", 0.16, 8};

std::string nameOf(const testing::TestParamInfo<StackCase>& info)
{
    return info.param.m_name;
}

INSTANTIATE_TEST_SUITE_P(Masses, CoupledStack, testing::Values(kEqual, kHeavyRigid, kHeavySoft), nameOf);
INSTANTIATE_TEST_SUITE_P(Masses, CoupledStackSlow, testing::Values(kEqual, kHeavyRigid), nameOf);
INSTANTIATE_TEST_SUITE_P(HeavySoft, CoupledStackSlow, testing::Values(kHeavySoft), nameOf);

/// Twenty soft cubes one on another, at the default tolerance.
class SoftTower : public testing::TestWithParam<Coupling>
{
};

// The sweeps' residual at each contact tilts a tower in proportion to its height squared: by several millimetres within
// ten seconds if sweeps alone transfer the load.
TEST_P(SoftTower, TwentyCubesStandUpright)
{
    constexpr int kCubes = 20;
    btFemSoftBodySolver fem;
    SoftWorld world(fem, GetParam());
    const btRigidBody& floor = world.addFloorBox();
    std::vector<btSoftBody*> cubes;
    for (int k = 0; k < kCubes; ++k)
    {
        SoftBox cube;
        cube.m_size = {0.5, 0.5, 0.5};
        cube.m_center = {0, 0, (k + 0.5) * 0.5};
        cube.m_youngModulus = btScalar(2e8);  // three times the buckling stiffness under its weight
        cube.m_friction = btScalar(0.8);
        cubes.push_back(&addSoftBox(world, fem, cube));
        cubes.back()->setActivationState(DISABLE_DEACTIVATION);
    }
    world.step(10 * kSecond);
    for (const btSoftBody* cube : cubes)
    {
        const Vec3 center = centerOf(*cube);
        EXPECT_LT(std::hypot(center.x, center.y), 1e-3);
        EXPECT_LT(norm(velocityOf(*cube)), 1e-3);
    }
    const double weight = kCubes * massOf(*cubes[0]) * kGravity;
    EXPECT_NEAR(fem.contactForce(cubes[0], &floor).z(), weight, 1e-3 * weight);
}

INSTANTIATE_TEST_SUITE_P(Solvers, SoftTower, testing::Values(Coupling::swap, Coupling::coupled),
                         [](const auto& scene) { return couplingName(scene.param); });

// Both couplings: soft cubes alone are solved together in each.
class SoftStackSlow : public testing::TestWithParam<Coupling>
{
};

TEST_P(SoftStackSlow, FiveCubesStandForAMinuteAndShortenAsAColumn)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem, GetParam());
    world.addFloorBox();
    const double height = 5 * kEdge, density = 1000;
    std::vector<btSoftBody*> cubes;
    for (int k = 0; k < 5; ++k)
    {
        SoftBox cube;
        cube.m_size = {kEdge, kEdge, kEdge};
        cube.m_center = {0, 0, (k + 0.5) * kEdge};
        cube.m_cells = {3, 3, 3};
        cube.m_youngModulus = static_cast<btScalar>(density * kGravity * height / 0.02);  // 2 % at the foot
        cubes.push_back(&addSoftBox(world, fem, cube));
    }
    const auto places = [&cubes]
    {
        std::vector<Vec3> centers;
        for (const btSoftBody* cube : cubes) centers.push_back(centerOf(*cube));
        return centers;
    };
    const auto motion = [&cubes]
    {
        double energy = 0;
        for (const btSoftBody* cube : cubes) energy += motionOf(*cube).m_energy;
        return energy;
    };
    world.step(5 * kSecond);
    const std::vector<Vec3> settled = places();
    double early = 0, late = 0;  // maximum kinetic energies [J]
    for (int frame = 0; frame < 55 * kSecond; ++frame)
    {
        world.step();
        double& largest = frame < 5 * kSecond ? early : late;
        largest = std::max(largest, motion());
        ASSERT_TRUE(allFinite(*cubes[4]));
    }
    EXPECT_LT(largestDifference(places(), settled), 1e-3);
    EXPECT_LT(std::hypot(settled[4].x, settled[4].y), 1e-3);
    const double weight = 5 * massOf(*cubes[0]) * kGravity;
    EXPECT_LE(late, std::max(early, 1e-9 * weight * height));
    double top = 0;
    const btSoftBody& uppermost = *cubes[4];
    for (int i = 0; i < uppermost.m_nodes.size(); ++i) top = std::max(top, double(uppermost.m_nodes[i].m_x.z()));
    const double shortening = 0.02 * height / 2;  // rho g H^2 / (2 E)
    EXPECT_NEAR(height - top, shortening, 0.1 * shortening);
}

INSTANTIATE_TEST_SUITE_P(Solvers, SoftStackSlow, testing::Values(Coupling::swap, Coupling::coupled),
                         [](const auto& scene) { return couplingName(scene.param); });

}  // namespace
}  // namespace bullet_fem
