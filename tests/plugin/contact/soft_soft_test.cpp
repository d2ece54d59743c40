// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

// A soft box with Bullet's friction, 0.2, given by its lowest corner [m] before rotation about its centre.
SoftBox boxFrom(const Vec3& lowest, const Vec3& size = {1, 1, 1}, const std::array<int, 3>& cells = {4, 4, 4},
                double turn = 0)
{
    SoftBox box;
    box.m_size = size;
    box.m_cells = cells;
    box.m_center = lowest + 0.5 * size;
    box.m_friction = btScalar(0.2);
    box.m_turn = turn;
    return box;
}

SoftBox plain(SoftBox box)
{
    box.m_bending = btFemBending::plain;
    return box;
}

struct SoftRestCase
{
    const char* m_name;
    SoftBox m_upper;
    btScalar m_step;
};

class SoftOnSoft : public testing::TestWithParam<SoftRestCase>
{
};

TEST_P(SoftOnSoft, IsCarriedToItsWeightOnEveryFrame)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem);
    btSoftBody& lower = addSoftBox(world, fem, boxFrom({}));
    btSoftBody& upper = addSoftBox(world, fem, plain(GetParam().m_upper));  // a bar of one cell swings for less time
    clampBelow(lower, 0.01);
    const btScalar h = GetParam().m_step;
    const double weight = massOf(upper) * kGravity;
    world.step(static_cast<int>(6 / h), h);
    for (int frame = 0; frame < 60; ++frame)
    {
        world.step(1, h);
        const Vec3 force = vec3(fem.contactForce(&upper, &lower)), reaction = vec3(fem.contactForce(&lower, &upper));
        EXPECT_LT(norm(force - Vec3{0, 0, weight}), 1e-3 * weight) << "frame " << frame;
        EXPECT_LT(norm(force + reaction), 1e-6 * weight);
        EXPECT_LT(fem.stepReport(&upper).m_deepestPenetration, 1e-3);
        EXPECT_LT(norm(velocityOf(upper)), 1e-4);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Places, SoftOnSoft,
    testing::Values(SoftRestCase{"flush", boxFrom({0, 0, 1.001}), kStep},
                    SoftRestCase{"otherMesh", boxFrom({0.17, 0.12, 1.001}, {0.7, 0.7, 0.7}, {3, 3, 3}), kStep},
                    SoftRestCase{"larger", boxFrom({-0.3, -0.3, 1.001}, {1.6, 1.6, 0.5}, {5, 5, 2}), kStep},
                    SoftRestCase{"turned", boxFrom({0, 0, 1.001}, {1, 1, 1}, {4, 4, 4}, 0.6), kStep},
                    SoftRestCase{"crossingBar", boxFrom({-1, 0.3, 1.001}, {3, 0.4, 0.4}, {8, 1, 1}, 0.1), kStep},
                    SoftRestCase{"flushAt240Hz", boxFrom({0, 0, 1.001}), btScalar(1) / 240}),
    [](const auto& scene) { return scene.param.m_name; });

TEST(SoftOnSoftPatch, NearlyAThousandPointsCarryWithoutSinkingIn)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem);
    btSoftBody& lower = addSoftBox(world, fem, boxFrom({}, {2, 2, 0.2}, {22, 22, 2}));
    btSoftBody& upper = addSoftBox(world, fem, boxFrom({0.03, 0.02, 0.2005}, {2, 2, 0.2}, {22, 22, 2}));
    clampBelow(lower, 0.01);
    world.step(20);
    for (int frame = 0; frame < 5; ++frame)
    {
        world.step();
        const double weight = massOf(upper) * kGravity;
        EXPECT_GT(fem.contacts(&upper).size(), 900);
        EXPECT_NEAR(fem.contactForce(&upper, &lower).z(), weight, 1e-3 * weight);
        // Contacts at the rim appear and vanish, .08 mm deep: penetrations below the slop, .46 mm, are not corrected.
        EXPECT_LT(fem.stepReport(&upper).m_deepestPenetration, 1e-3 * 0.2);
    }
}

TEST(SoftStack, ThreeFlushCubesStand)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem);
    btRigidBody& ground = world.addPlane();
    std::vector<btSoftBody*> cubes;
    for (int k = 0; k < 3; ++k)
        cubes.push_back(&addSoftBox(world, fem, boxFrom({0, 0, 1.001 * k + 0.001}, {1, 1, 1}, {3, 3, 3})));
    world.step(480);
    const double weight = massOf(*cubes[0]) * kGravity;
    for (int frame = 0; frame < 30; ++frame)
    {
        world.step();
        EXPECT_NEAR(fem.contactForce(cubes[2], cubes[1]).z(), weight, 1e-3 * weight);
        EXPECT_NEAR(fem.contactForce(cubes[1], cubes[0]).z(), 2 * weight, 2e-3 * weight);
        EXPECT_NEAR(fem.contactForce(cubes[0], &ground).z(), 3 * weight, 3e-3 * weight);
    }
    for (const btSoftBody* cube : cubes) EXPECT_LT(std::hypot(centerOf(*cube).x - 0.5, centerOf(*cube).y - 0.5), 1e-3);
}

// Boxes that overlap by a fifth, with flush and with shifted sides.
class SoftOverlapping : public testing::TestWithParam<double>
{
};

TEST_P(SoftOverlapping, PartWithoutFlyingApart)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem);
    btSoftBody& lower = addSoftBox(world, fem, boxFrom({}));
    btSoftBody& upper = addSoftBox(world, fem, boxFrom({GetParam(), GetParam(), 0.8}));
    clampBelow(lower, 0.01);
    double fastest = 0;
    for (int k = 0; k < 300; ++k)
    {
        world.step();
        ASSERT_TRUE(allFinite(upper) && allFinite(lower));
        fastest = std::max({fastest, fastestNode(upper), fastestNode(lower)});
    }
    EXPECT_LT(fastest, 2);
    EXPECT_GT(centerOf(upper).z, 1.45);
    EXPECT_LT(fem.stepReport(&upper).m_deepestPenetration, 2e-3);
}

INSTANTIATE_TEST_SUITE_P(Shifts, SoftOverlapping, testing::Values(0.0, 0.13),
                         [](const auto& scene) { return scene.param > 0 ? "shifted" : "flush"; });

constexpr double kSlabFriction = 0.5;

// A box on a fixed slab, with gravity rotated by the angle of this tangent.
class SoftIncline
{
public:
    explicit SoftIncline(double tangent)
        : m_angle(std::atan(tangent)),
          m_world(m_fem, bulletVector(Vec3{kGravity * std::sin(m_angle), 0, -kGravity * std::cos(m_angle)})),
          m_slab(addSoftBox(m_world, m_fem, plain(boxFrom({}, {4, 1, 0.4}, {16, 4, 2})))),
          m_box(addSoftBox(m_world, m_fem, plain(boxFrom({0.2, 0.23, 0.4005}, {0.5, 0.5, 0.3}, {3, 3, 2}))))
    {
        clampBelow(m_slab, 0.01);
        m_slab.m_cfg.kDF = btScalar(kSlabFriction);
        m_box.m_cfg.kDF = btScalar(0.2);
    }
    double acceleration() const { return kGravity * (std::sin(m_angle) - kSlabFriction * std::cos(m_angle)); }

    const double m_angle;
    btFemSoftBodySolver m_fem;
    SoftWorld m_world;
    btSoftBody &m_slab, &m_box;
};

TEST(SoftOnSoftIncline, SticksBelowTheAngleOfFriction)
{
    SoftIncline scene(0.95 * kSlabFriction);
    scene.m_world.step(180);
    const double start = centerOf(scene.m_box).x;
    scene.m_world.step(120);
    EXPECT_NEAR(centerOf(scene.m_box).x, start, 2e-4) << "1e-4 m/s";
}

TEST(SoftOnSoftIncline, SlidesAboveItWithTheLargerCoefficientOfTheTwo)
{
    SoftIncline scene(1.3 * kSlabFriction);
    scene.m_world.step(20);
    const double before = velocityOf(scene.m_box).x;
    Vec3 sum;
    const int steps = 60;
    for (int k = 0; k < steps; ++k)
    {
        scene.m_world.step();
        sum += vec3(scene.m_fem.contactForce(&scene.m_box, &scene.m_slab));
    }
    const double gained = velocityOf(scene.m_box).x - before;
    EXPECT_NEAR(gained, scene.acceleration() * steps * kStep, 0.01 * kGravity * std::sin(scene.m_angle));
    EXPECT_NEAR(-sum.x / sum.z, kSlabFriction, 5e-4 * kSlabFriction);
}

struct SoftCollisionCase
{
    const char* m_name;
    double m_densityRatio;
    double m_aside;  // of the middles [m]
    double m_speed;  // [m/s]
};

class SoftCollision : public testing::TestWithParam<SoftCollisionCase>
{
};

TEST_P(SoftCollision, KeepsMomentum)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem, btVector3(0, 0, 0));
    SoftBox settings = boxFrom({}, {1, 1, 1}, {3, 3, 3}, 0.4);
    btSoftBody& target = addSoftBox(world, fem, settings);
    settings = boxFrom({0.1, 0.1 + GetParam().m_aside, 1.1}, {0.8, 0.8, 0.8}, {4, 4, 4});
    settings.m_density = btScalar(1000 * GetParam().m_densityRatio);
    btSoftBody& missile = addSoftBox(world, fem, settings);
    for (btSoftBody* body : {&target, &missile})
    {
        body->m_cfg.kDF = btScalar(0.5);
        for (int i = 0; i < body->m_nodes.size(); ++i)
            body->m_nodes[i].m_v = body == &missile ? btVector3(btScalar(0.3), 0, btScalar(-GetParam().m_speed))
                                                    : btVector3(0, 0, btScalar(0.2));
    }
    const auto sumOf = [&]
    {
        Motion sum = motionOf(target);
        sum += motionOf(missile);
        return sum;
    };
    const Motion before = sumOf();
    const Vec3 hit = motionOf(target).m_linear;
    const double scale = norm(motionOf(target).m_linear) + norm(motionOf(missile).m_linear);
    int touching = 0;
    for (int k = 0; k < 90; ++k)
    {
        world.step();
        touching += fem.contacts(&target).size() > 0;
        const Motion now = sumOf();
        ASSERT_LT(norm(now.m_linear - before.m_linear), 1e-6 * scale) << "step " << k;
        ASSERT_LT(norm(now.m_angular - before.m_angular), 1e-5 * scale) << "step " << k;
    }
    EXPECT_GE(touching, 1);
    EXPECT_GT(norm(motionOf(target).m_linear - hit),
              0.3 * GetParam().m_speed * std::min(massOf(target), massOf(missile)));
    EXPECT_LT(sumOf().m_energy, 1.001 * before.m_energy);
}

INSTANTIATE_TEST_SUITE_P(MassRatios, SoftCollision,
                         testing::Values(SoftCollisionCase{"equalCentral", 1, 0, 3},
                                         SoftCollisionCase{"equalAside", 1, 0.5, 3},
                                         SoftCollisionCase{"tenfoldAside", 10, 0.5, 2},
                                         SoftCollisionCase{"hundredfoldAside", 100, 0.5, 1},
                                         SoftCollisionCase{"hundredthAside", 0.01, 0.5, 5}),
                         [](const auto& scene) { return scene.param.m_name; });

// A soft ball at 20 m/s, a third of a metre a step, against a fixed plate of one centimetre.
TEST(FastSoftBody, DoesNotPassAThinPlate)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem, btVector3(0, 0, 0));
    SoftBox thin = boxFrom({-0.5, -0.5, 0}, {1, 1, 0.01}, {10, 10, 1});
    thin.m_youngModulus = btScalar(1e8);
    btSoftBody& plate = addSoftBox(world, fem, thin);
    for (int i = 0; i < plate.m_nodes.size(); ++i)
        if (std::max(std::fabs(plate.m_nodes[i].m_x.x()), std::fabs(plate.m_nodes[i].m_x.y())) > btScalar(0.49))
            plate.setMass(i, 0);
    btSoftBody* ball = btFemHelpers::createFromTetMesh(world.info(), makeSphere(0.1, 6));
    for (int i = 0; i < ball->m_nodes.size(); ++i)
    {
        ball->m_nodes[i].m_x += btVector3(btScalar(0.03), btScalar(0.02), btScalar(0.35));
        ball->m_nodes[i].m_v = btVector3(2, 0, -20);
    }
    fem.setMaterial(ball, btFemMaterial());
    world.addSoft(ball);
    for (int k = 0; k < 60; ++k)
    {
        world.step();
        ASSERT_TRUE(allFinite(*ball) && allFinite(plate));
        ASSERT_GT(centerOf(*ball).z, -0.2) << "step " << k;
    }
    EXPECT_GT(centerOf(*ball).z, 0.1) << "it rebounded";
}

TEST(SoftOnSoftRepeatability, GivesTheSameBits)
{
    const auto run = []
    {
        btFemSoftBodySolver fem;
        SoftWorld world(fem);
        btSoftBody& lower = addSoftBox(world, fem, boxFrom({}));
        btSoftBody& upper = addSoftBox(world, fem, boxFrom({0.17, 0.12, 1.05}, {0.7, 0.7, 0.7}, {3, 3, 3}, 0.3));
        clampBelow(lower, 0.01);
        world.step(60);
        return std::make_pair(bitsOf(upper), bitsOf(lower));
    };
    EXPECT_EQ(run(), run());
}

}  // namespace
}  // namespace bullet_fem
