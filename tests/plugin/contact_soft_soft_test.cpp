// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>

#include "bullet_bridge/bullet_vectors.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/fem/generators.h"
#include "plugin/scene_measures.h"
#include "plugin/soft_world.h"

namespace bullet_fem
{
namespace
{

struct BoxSettings
{
    Vec3 m_size = {1, 1, 1};
    std::array<int, 3> m_cells = {4, 4, 4};
    double m_turn = 0;  // about z [rad]
    Vec3 m_lowest;      // its lowest corner before the turn, which is about its middle [m]
    btScalar m_density = 1000;
    btScalar m_youngModulus = btScalar(1e6);
};

btSoftBody& addBox(SoftWorld& world, btFemSoftBodySolver& fem, const BoxSettings& box)
{
    btSoftBody* body = btFemHelpers::createFromTetMesh(world.info(), makeBox(box.m_size, box.m_cells));
    const Vec3 middle = 0.5 * Vec3{box.m_size.x, box.m_size.y, 0};
    for (int i = 0; i < body->m_nodes.size(); ++i)
    {
        const Vec3 r = vec3(body->m_nodes[i].m_x) - middle;
        const double c = std::cos(box.m_turn), s = std::sin(box.m_turn);
        body->m_nodes[i].m_x = bulletVector(Vec3{c * r.x - s * r.y, s * r.x + c * r.y, r.z} + middle + box.m_lowest);
        body->m_nodes[i].m_q = body->m_nodes[i].m_x;
    }
    btFemMaterial material;
    material.m_youngModulus = box.m_youngModulus;
    material.m_density = box.m_density;
    fem.setMaterial(body, material);
    return world.addSoft(body);
}

// Pins the nodes whose height was below `height` when the body was made.
void clampBelow(btSoftBody& body, double height)
{
    for (int i = 0; i < body.m_nodes.size(); ++i)
        if (body.m_nodes[i].m_x.z() < height) body.setMass(i, 0);
}

struct RestCase
{
    const char* m_name;
    BoxSettings m_upper;
    btScalar m_step;
};

class SoftOnSoft : public testing::TestWithParam<RestCase>
{
};

TEST_P(SoftOnSoft, IsCarriedToItsWeightOnEveryFrame)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem);
    btSoftBody& lower = addBox(world, fem, {});
    btSoftBody& upper = addBox(world, fem, GetParam().m_upper);
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
    testing::Values(RestCase{"flush", {{1, 1, 1}, {4, 4, 4}, 0, {0, 0, 1.001}}, kStep},
                    RestCase{"otherMesh", {{0.7, 0.7, 0.7}, {3, 3, 3}, 0, {0.17, 0.12, 1.001}}, kStep},
                    RestCase{"larger", {{1.6, 1.6, 0.5}, {5, 5, 2}, 0, {-0.3, -0.3, 1.001}}, kStep},
                    RestCase{"turned", {{1, 1, 1}, {4, 4, 4}, 0.6, {0, 0, 1.001}}, kStep},
                    RestCase{"crossingBar", {{3, 0.4, 0.4}, {8, 1, 1}, 0.1, {-1, 0.3, 1.001}}, kStep},
                    RestCase{"flushAt240Hz", {{1, 1, 1}, {4, 4, 4}, 0, {0, 0, 1.001}}, btScalar(1) / 240}),
    [](const auto& scene) { return scene.param.m_name; });

TEST(SoftOnSoftPatch, OfNearlyAThousandPointsIsCarriedWithoutSinkingIn)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem);
    btSoftBody& lower = addBox(world, fem, {{2, 2, 0.2}, {22, 22, 2}, 0, {}});
    btSoftBody& upper = addBox(world, fem, {{2, 2, 0.2}, {22, 22, 2}, 0, {0.03, 0.02, 0.2005}});
    clampBelow(lower, 0.01);
    world.step(20);
    for (int frame = 0; frame < 5; ++frame)
    {
        world.step();
        const double weight = massOf(upper) * kGravity;
        EXPECT_GT(fem.contacts(&upper).size(), 900);
        EXPECT_NEAR(fem.contactForce(&upper, &lower).z(), weight, 1e-3 * weight);
        EXPECT_LT(fem.stepReport(&upper).m_deepestPenetration, 1e-4 * 0.2);
    }
}

TEST(SoftStack, OfThreeFlushCubesStands)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem);
    btRigidBody& ground = world.addPlane();
    std::vector<btSoftBody*> cubes;
    for (int k = 0; k < 3; ++k)
        cubes.push_back(&addBox(world, fem, {{1, 1, 1}, {3, 3, 3}, 0, {0, 0, 1.001 * k + 0.001}}));
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

// Made a fifth deep in each other, with flush sides and with shifted ones.
class SoftOverlapping : public testing::TestWithParam<double>
{
};

TEST_P(SoftOverlapping, PartWithoutFlyingApart)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem);
    btSoftBody& lower = addBox(world, fem, {});
    btSoftBody& upper = addBox(world, fem, {{1, 1, 1}, {4, 4, 4}, 0, {GetParam(), GetParam(), 0.8}});
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

constexpr double kFriction = 0.5;

// A box on a clamped slab, the weight turned by the angle of this tangent.
class SoftIncline
{
public:
    explicit SoftIncline(double tangent)
        : m_angle(std::atan(tangent)),
          m_world(m_fem, bulletVector(Vec3{kGravity * std::sin(m_angle), 0, -kGravity * std::cos(m_angle)})),
          m_slab(addBox(m_world, m_fem, {{4, 1, 0.4}, {16, 4, 2}, 0, {}})),
          m_box(addBox(m_world, m_fem, {{0.5, 0.5, 0.3}, {3, 3, 2}, 0, {0.2, 0.23, 0.4005}}))
    {
        clampBelow(m_slab, 0.01);
        m_slab.m_cfg.kDF = btScalar(kFriction);
        m_box.m_cfg.kDF = btScalar(0.2);
    }
    double acceleration() const { return kGravity * (std::sin(m_angle) - kFriction * std::cos(m_angle)); }

    const double m_angle;
    btFemSoftBodySolver m_fem;
    SoftWorld m_world;
    btSoftBody &m_slab, &m_box;
};

TEST(SoftOnSoftIncline, SticksBelowTheAngleOfFriction)
{
    SoftIncline scene(0.95 * kFriction);
    scene.m_world.step(180);
    const double start = centerOf(scene.m_box).x;
    scene.m_world.step(120);
    EXPECT_NEAR(centerOf(scene.m_box).x, start, 2e-4) << "1e-4 m/s";
}

TEST(SoftOnSoftIncline, SlidesAboveItWithTheLargerCoefficientOfTheTwo)
{
    SoftIncline scene(1.3 * kFriction);
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
    EXPECT_NEAR(-sum.x / sum.z, kFriction, 5e-4 * kFriction);
}

struct CollisionCase
{
    const char* m_name;
    double m_densityRatio;
    double m_aside;  // of the middles [m]
    double m_speed;  // [m/s]
};

class SoftCollision : public testing::TestWithParam<CollisionCase>
{
};

TEST_P(SoftCollision, KeepsMomentum)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem, btVector3(0, 0, 0));
    BoxSettings settings = {{1, 1, 1}, {3, 3, 3}, 0.4, {}};
    btSoftBody& target = addBox(world, fem, settings);
    settings = {{0.8, 0.8, 0.8}, {4, 4, 4}, 0, {0.1, 0.1 + GetParam().m_aside, 1.1}};
    settings.m_density = btScalar(1000 * GetParam().m_densityRatio);
    btSoftBody& missile = addBox(world, fem, settings);
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
                         testing::Values(CollisionCase{"equalCentral", 1, 0, 3}, CollisionCase{"equalAside", 1, 0.5, 3},
                                         CollisionCase{"tenfoldAside", 10, 0.5, 2},
                                         CollisionCase{"hundredfoldAside", 100, 0.5, 1},
                                         CollisionCase{"hundredthAside", 0.01, 0.5, 5}),
                         [](const auto& scene) { return scene.param.m_name; });

// A soft ball at 20 m/s, a third of a metre a step, against a clamped plate one centimetre thick.
TEST(FastSoftBody, DoesNotPassAThinPlate)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem, btVector3(0, 0, 0));
    btSoftBody& plate = addBox(world, fem, {{1, 1, 0.01}, {10, 10, 1}, 0, {-0.5, -0.5, 0}, 1000, btScalar(1e8)});
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
    EXPECT_GT(centerOf(*ball).z, 0.1) << "it came back";
}

// A strip, 2 x 0.3 x 0.05 m, the half at x < 0.9 glued to the floor, the other bent up and over in an arc. It is too
// soft to stand, and falls onto the first half; there is a plane below.
class FoldingStrip
{
public:
    explicit FoldingStrip(bool selfContact) : m_world(m_fem)
    {
        m_world.addPlane();
        const TetMesh mesh = makeBox({2, 0.3, 0.05}, {30, 3, 1});
        m_strip = btFemHelpers::createFromTetMesh(m_world.info(), mesh);
        btFemMaterial material;
        material.m_youngModulus = btScalar(5e4);
        m_fem.setMaterial(m_strip, material);
        if (selfContact) m_strip->m_cfg.collisions |= btSoftBody::fCollision::CL_SELF;
        m_world.addSoft(m_strip);
        m_fem.prepare(m_strip, kStep);
        m_rest = mesh.restPositions();
        for (int i = 0; i < m_strip->m_nodes.size(); ++i)
        {
            const Vec3& X = m_rest[i];
            if (X.x < 0.9) m_strip->setMass(i, X.z < 0.01 ? 0 : 1 / m_strip->m_nodes[i].m_im);
            if (X.x < 1) continue;
            const double r = 0.15, roof = r - (X.z - 0.05), angle = std::min((X.x - 1) / r, 3.14159265);
            const double beyond = std::max(0.0, X.x - 1 - 3.14159265 * r);
            m_strip->m_nodes[i].m_x =
                bulletVector(Vec3{1 + roof * std::sin(angle) - beyond, X.y, 0.05 + r - roof * std::cos(angle)});
        }
    }

    // How far the lowest node of the second half is above the first half's upper face [m].
    double clearance() const
    {
        double least = 1;
        for (int i = 0; i < m_strip->m_nodes.size(); ++i)
            if (m_rest[i].x > 1.5 && m_strip->m_nodes[i].m_x.x() < btScalar(0.85))
                least = std::min(least, double(m_strip->m_nodes[i].m_x.z()) - 0.05);
        return least;
    }

    int selfContacts() const
    {
        int count = 0;
        for (int k = 0; k < m_fem.contacts(m_strip).size(); ++k) count += m_fem.contacts(m_strip)[k].m_other == m_strip;
        return count;
    }

    btFemSoftBodySolver m_fem;
    SoftWorld m_world;
    btSoftBody* m_strip;
    std::vector<Vec3> m_rest;
};

TEST(SelfContact, AFoldingStripDoesNotPassThroughItself)
{
    FoldingStrip strip(true);
    double least = 1;
    for (int k = 0; k < 120; ++k)
    {
        strip.m_world.step();
        ASSERT_TRUE(allFinite(*strip.m_strip));
        least = std::min(least, strip.clearance());
    }
    EXPECT_GT(least, -0.01) << "what the glued half yields";
    EXPECT_LT(strip.clearance(), 0.01) << "it lies on it";
    EXPECT_GT(strip.selfContacts(), 10);
}

TEST(SelfContact, IsOffUnlessAskedFor)
{
    FoldingStrip strip(false);
    strip.m_world.step(40);
    EXPECT_LT(strip.clearance(), -0.05) << "it fell through";
    EXPECT_EQ(strip.selfContacts(), 0);
}

// Self contact of a body that does not touch itself changes nothing.
TEST(SelfContact, DoesNotDisturbABodyThatIsSquashed)
{
    const auto run = [](bool selfContact)
    {
        btFemSoftBodySolver fem;
        SoftWorld world(fem);
        world.addPlane();
        btSoftBody& cube = addBox(world, fem, {{1, 1, 0.5}, {6, 6, 3}, 0, {0, 0, 1}, 1000, btScalar(3e4)});
        if (selfContact) cube.m_cfg.collisions |= btSoftBody::fCollision::CL_SELF;
        world.step(90);
        return bitsOf(cube);
    };
    EXPECT_EQ(run(true), run(false));
}

TEST(SoftOnSoftTwice, GivesTheSameBits)
{
    const auto run = []
    {
        btFemSoftBodySolver fem;
        SoftWorld world(fem);
        btSoftBody& lower = addBox(world, fem, {});
        btSoftBody& upper = addBox(world, fem, {{0.7, 0.7, 0.7}, {3, 3, 3}, 0.3, {0.17, 0.12, 1.05}});
        clampBelow(lower, 0.01);
        world.step(60);
        return std::make_pair(bitsOf(upper), bitsOf(lower));
    };
    EXPECT_EQ(run(), run());
}

}  // namespace
}  // namespace bullet_fem
