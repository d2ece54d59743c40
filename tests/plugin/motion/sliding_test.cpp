// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "plugin/motion/flush_ground.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

constexpr double kFriction = 0.3;  // between the ground and the sliding body [-]

/// The motion of a body with an initial speed.
struct Slide
{
    double m_brake = 0;            ///< its mean deceleration over the friction's
    double m_lifted = 0;           ///< maximum rise [m]
    double m_speedAfterMetre = 0;  ///< [m/s]; 0: it did not get that far
};

void give(btSoftBody& body, double speed)
{
    for (int i = 0; i < body.m_nodes.size(); ++i) body.m_nodes[i].m_v = btVector3(btScalar(speed), 0, 0);
}

/// A soft block that slides for half of its stopping distance.
class SlidingBlock
{
public:
    SlidingBlock(Coupling coupling, Ground ground, double step, double down = 0)
        : m_world(WorldClass::softRigid, coupling), m_ground(m_world, ground, 1, down), m_step(step)
    {
        SoftBox box;
        box.m_size = {0.6, 0.4, 0.3};
        box.m_cells = {6, 4, 3};
        box.m_center = {0.47, 0, 0.15};
        box.m_friction = btScalar(kFriction);
        m_block = &addSoftBox(m_world, m_world.fem(), box);
        m_world.step(static_cast<int>(1 / step), btScalar(step));
    }

    Slide slide(double speed, double seconds)
    {
        give(*m_block, speed);
        const double low = lowestHeight(*m_block), start = centerOf(*m_block).x;
        Slide result;
        const int steps = static_cast<int>(std::ceil(seconds / m_step));
        for (int k = 0; k < steps; ++k)
        {
            m_world.step(1, btScalar(m_step));
            result.m_lifted = std::max(result.m_lifted, lowestHeight(*m_block) - low);
            if (result.m_speedAfterMetre == 0 && centerOf(*m_block).x - start >= 1)
                result.m_speedAfterMetre = velocityOf(*m_block).x;
        }
        result.m_brake = (speed - velocityOf(*m_block).x) / (steps * m_step * kFriction * kGravity);
        return result;
    }

private:
    FemWorld m_world;
    FlushGround m_ground;
    double m_step;  // [s]
    btSoftBody* m_block;
};

// Rates of Seams and of Steps [Hz].
#ifdef BULLETFEM_SLOW_TEST
constexpr auto kSeamRates = {30, 120}, kStepRates = {120};
#else
constexpr auto kSeamRates = {60, 240}, kStepRates = {60};
#endif

class Seams : public testing::TestWithParam<std::tuple<Coupling, Ground, int>>
{
};

// A vertical side that ends flush with the ground's surface does not stop the body.
TEST_P(Seams, DoNotStopSlidingBodies)
{
    const auto [coupling, ground, frequency] = GetParam();
    for (const double speed : {0.5, 1.0, 2.0, 4.0, 6.0, 10.0})
    {
        const Slide slide =
            SlidingBlock(coupling, ground, 1.0 / frequency).slide(speed, 0.5 * speed / kFriction / kGravity);
        EXPECT_NEAR(slide.m_brake, 1, 0.02) << speed << " m/s";
        EXPECT_LT(slide.m_lifted, 2e-3) << speed << " m/s";
    }
}

class SpeedsAtSeams : public testing::TestWithParam<std::tuple<Coupling, Ground, int>>
{
};

// At these speeds nodes, edges or triangles are within 10 um to .4 mm of a seam, or of the rim of a box, as a step
// begins.
TEST_P(SpeedsAtSeams, DoNotStopSlidingBodies)
{
    const auto [coupling, ground, frequency] = GetParam();
    for (const double speed : {2.704, 3.445, 3.711, 9.392})
    {
        const Slide slide =
            SlidingBlock(coupling, ground, 1.0 / frequency).slide(speed, 0.5 * speed / kFriction / kGravity);
        EXPECT_NEAR(slide.m_brake, 1, 0.02) << speed << " m/s";
        EXPECT_LT(slide.m_lifted, 2e-3) << speed << " m/s";
    }
}

std::string nameOf(const testing::TestParamInfo<std::tuple<Coupling, Ground, int>>& suite)
{
    return std::string(couplingName(std::get<0>(suite.param))) + "_" + groundName(std::get<1>(suite.param)) + "_" +
           std::to_string(std::get<2>(suite.param)) + "Hz";
}

INSTANTIATE_TEST_SUITE_P(Grounds, Seams,
                         testing::Combine(testing::Values(Coupling::swap, Coupling::coupled),
                                          testing::Values(Ground::oneBox, Ground::boxes, Ground::compound,
                                                          Ground::hulls, Ground::kinematicBoxes, Ground::meshTiles,
                                                          Ground::meshBoxes, Ground::heightfield, Ground::mesh),
                                          testing::ValuesIn(kSeamRates)),
                         nameOf);

INSTANTIATE_TEST_SUITE_P(Grounds, SpeedsAtSeams,
                         testing::Combine(testing::Values(Coupling::swap, Coupling::coupled),
                                          testing::Values(Ground::boxes, Ground::compound, Ground::hulls,
                                                          Ground::kinematicBoxes),
                                          testing::Values(60)),
                         nameOf);

class Steps : public testing::TestWithParam<std::tuple<Coupling, Ground, int>>
{
};

// The body falls and slides on: landing costs less than 3 % of its speed.
TEST_P(Steps, DownwardOnesDoNotStopSlidingBodies)
{
    const auto [coupling, ground, frequency] = GetParam();
    for (const double down : {0.001, 0.003, 0.005})
        for (const double speed : {3.0, 4.0, 6.0, 10.0})
        {
            SlidingBlock block(coupling, ground, 1.0 / frequency, down);
            const Slide slide = block.slide(speed, 1.3 / (0.5 * speed + 0.5 * std::sqrt(speed * speed - 6)));
            const double expected = std::sqrt(speed * speed - 2 * kFriction * kGravity);
            EXPECT_NEAR(slide.m_speedAfterMetre, expected, 0.03 * expected) << speed << " m/s, " << down << " m";
        }
}

// Steps a fifth of an edge high.
TEST_P(Steps, UpwardOnesStopSlidingBodies)
{
    const auto [coupling, ground, frequency] = GetParam();
    for (const double speed : {3.0, 4.0, 6.0})
    {
        SlidingBlock block(coupling, ground, 1.0 / frequency, -0.02);
        const Slide slide = block.slide(speed, 0.5);
        EXPECT_EQ(slide.m_speedAfterMetre, 0) << speed << " m/s";
        EXPECT_GT(slide.m_brake, 1.3) << speed << " m/s";
    }
}

INSTANTIATE_TEST_SUITE_P(Grounds, Steps,
                         testing::Combine(testing::Values(Coupling::swap, Coupling::coupled),
                                          testing::Values(Ground::boxes, Ground::compound, Ground::hulls,
                                                          Ground::meshTiles, Ground::meshBoxes),
                                          testing::ValuesIn(kStepRates)),
                         nameOf);

btFemMaterial undamped()
{
    btFemMaterial material;
    material.m_youngModulus = btScalar(1e6);
    material.m_density = 1000;
    material.m_stiffnessDamping = 0;
    return material;
}

class SoftGround : public testing::TestWithParam<std::tuple<Coupling, int>>
{
};

// A rigid box slides over soft slabs side by side with fixed lower faces: it is sunk in, so that the front of the next
// slab is ahead of it; but it slides as on a single slab. Surface waves travel at 18 m/s.
TEST_P(SoftGround, IsNoWallForASlidingRigidBox)
{
    const auto [coupling, slabs] = GetParam();
    for (const double gap : {0.0, 0.05})
        for (const double speed : {2.5, 5.0, 7.0, 9.0})
        {
            FemWorld world(WorldClass::softRigid, coupling);
            const double length = 6.0 / slabs;
            for (int k = 0; k < slabs; ++k)
            {
                SoftBox slab;
                slab.m_size = {length, 0.8, 0.2};
                slab.m_cells = {60 / slabs, 8, 2};
                slab.m_center = {length / 2 + k * (length + gap), 0, -0.1};
                slab.m_friction = btScalar(kFriction);
                btSoftBody& body = addSoftBox(world, world.fem(), slab);
                world.fem().setMaterial(&body, undamped());
                clampBelow(body, -0.19);
            }
            btRigidBody& box = addRigidBox(world, {0.6, 0.4, 0.3}, {72, at(btScalar(0.45), 0, btScalar(0.151))});
            world.step(90);
            const double low = box.getWorldTransform().getOrigin().z();
            box.setLinearVelocity(btVector3(btScalar(speed), 0, 0));
            box.setAngularVelocity(btVector3(0, 0, 0));
            world.step();  // a rigid body alone in contact has the friction of two steps in the first
            const double start = box.getLinearVelocity().x();
            const int steps = static_cast<int>(std::min(0.5 * speed / kFriction / kGravity, 3 / speed) / kStep);
            double lifted = 0;
            for (int k = 0; k < steps; ++k)
            {
                world.step();
                lifted = std::max(lifted, box.getWorldTransform().getOrigin().z() - low);
            }
            const double brake = (start - box.getLinearVelocity().x()) / (steps * kStep * kFriction * kGravity);
            EXPECT_NEAR(brake, 1, 0.02) << speed << " m/s, " << gap << " m apart";
            EXPECT_LT(lifted, 2e-3) << speed << " m/s, " << gap << " m apart";
        }
}

INSTANTIATE_TEST_SUITE_P(Slabs, SoftGround,
                         testing::Combine(testing::Values(Coupling::swap, Coupling::coupled), testing::Values(1, 2, 4)),
                         [](const auto& suite) {
                             return std::string(couplingName(std::get<0>(suite.param))) + "_" +
                                    std::to_string(std::get<1>(suite.param));
                         });

}  // namespace
}  // namespace bullet_fem
