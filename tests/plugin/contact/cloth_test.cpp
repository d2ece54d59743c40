// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// FEM bodies and Bullet's cloth and ropes: support, momentum, friction.
#include <algorithm>
#include <cmath>

#include "plugin/scenes/cloth_scene.h"

namespace bullet_fem
{
namespace
{

class ClothOnFemBodies : public testing::TestWithParam<ClothWorldKind>
{
};

INSTANTIATE_TEST_SUITE_P(Worlds, ClothOnFemBodies, eachClothWorld(),
                         [](const auto& suite) { return nameOf(suite.param); });

// Without the deformable world, whose springs are separate forces.
class ClothInSoftWorlds : public testing::TestWithParam<ClothWorldKind>
{
};

INSTANTIATE_TEST_SUITE_P(Worlds, ClothInSoftWorlds, eachSoftClothWorld(),
                         [](const auto& suite) { return nameOf(suite.param); });

double highest(const btSoftBody& body)
{
    double height = -1e9;
    for (int i = 0; i < body.m_nodes.size(); ++i) height = std::max(height, double(body.m_nodes[i].m_x.z()));
    return height;
}

// Mean force of a swinging cloth on a body over some frames.
Vec3 meanForce(ClothWorld& scene, const btSoftBody& body, const btSoftBody& cloth, int frames)
{
    Vec3 sum;
    for (int k = 0; k < frames; ++k)
    {
        scene.world().step();
        sum += vec3(scene.fem().contactForce(&body, &cloth));
    }
    return (1.0 / frames) * sum;
}

SoftBox stiffSlab(const Vec3& size, const std::array<int, 3>& cells)
{
    SoftBox box;
    box.m_size = size;
    box.m_cells = cells;
    box.m_center = {0, 0, -0.5 * size.z};
    box.m_youngModulus = btScalar(1e7);
    box.m_density = 100;
    return box;
}

TEST_P(ClothOnFemBodies, RestOnABlockWithTheirWeight)
{
    ClothWorld scene(GetParam());
    btSoftBody& block = scene.addBox(stiffSlab({1, 1, 0.5}, {4, 4, 2}));
    clampBelow(block, -0.49);
    btSoftBody& cloth = scene.addPatch({0.03, 0.02, 0.3}, 0.8, 0.5, 11);
    cloth.m_cfg.kDP = 0;
    const double weight = massOf(cloth) * kGravity;
    scene.world().step(180);
    for (int frame = 0; frame < 30; ++frame)
    {
        scene.world().step();
        EXPECT_LT(norm(vec3(scene.fem().contactForce(&block, &cloth)) - Vec3{0, 0, -weight}), 1e-3 * weight);
    }
    EXPECT_GT(scene.fem().stepReport(&block).m_contacts, 121);  // nodes of the cloth, and vertices of the block
    EXPECT_LT(scene.fem().stepReport(&block).m_deepestPenetration, 1e-3);
    EXPECT_NEAR(lowestHeight(cloth), kClothMargin, 2e-3);
    EXPECT_NEAR(highest(cloth), kClothMargin, 2e-3);
    EXPECT_LT(fastestNode(cloth), 1e-2);
}

// Nodes beside the ball hang from those above it.
TEST_P(ClothOnFemBodies, HangOverABallAndWeighOnIt)
{
    ClothWorld scene(GetParam());
    btSoftBody& ball = scene.addBall({0, 0, 0}, 0.3, 1000, 1e6);
    for (int i = 0; i < ball.m_nodes.size(); ++i)
        if (ball.m_nodes[i].m_x.z() < btScalar(-0.2)) ball.setMass(i, 0);
    btSoftBody& cloth = scene.addPatch({0.01, 0.02, 0.5}, 0.9, 0.3, 13);
    cloth.m_cfg.kDP = 0;
    scene.world().step(180);
    const double weight = massOf(cloth) * kGravity;
    EXPECT_NEAR(meanForce(scene, ball, cloth, 120).z, -weight, 0.03 * weight);
    EXPECT_LT(lowestHeight(cloth), -0.1);
    for (int i = 0; i < cloth.m_nodes.size(); ++i)
        EXPECT_GT(norm(vec3(cloth.m_nodes[i].m_x)), 0.3 * 0.97 + 0.5 * kClothMargin) << i;  // the faces of a polyhedron
}

TEST_P(ClothOnFemBodies, FallOnAFreeBallAndPushIt)
{
    ClothWorld scene(GetParam(), {0, 0, 0});
    btSoftBody& ball = scene.addBall({0, 0, 0}, 0.3, 10, 1e5);
    btSoftBody& cloth = scene.addPatch({0, 0, 0.5}, 0.6, 1, 11);
    cloth.m_cfg.kDP = 0;
    cloth.setVelocity(btVector3(0, 0, -3));
    const double momentum = 3 * massOf(cloth);
    scene.world().step(20);
    EXPECT_LT(velocityOf(ball).z, -0.5);
    EXPECT_NEAR(motionOf(ball).m_linear.z + motionOf(cloth).m_linear.z, -momentum, 1e-5 * momentum);
}

TEST_P(ClothOnFemBodies, KeepMomentum)
{
    ClothWorld scene(GetParam(), {0, 0, 0});
    btSoftBody& ball = scene.addBall({0.03, 0.01, 0.5}, 0.3, 10, 1e5);
    btSoftBody& cloth = scene.addPatch({0, 0, 0}, 1, 1, 11);
    cloth.m_cfg.kDP = 0;
    ball.setVelocity(btVector3(btScalar(0.3), 0, -3));
    Motion before = motionOf(ball);
    before += motionOf(cloth);
    double least = 0;
    for (int k = 0; k < 60; ++k)
    {
        scene.world().step();
        Motion now = motionOf(ball);
        now += motionOf(cloth);
        EXPECT_LT(norm(now.m_linear - before.m_linear), 1e-5 * norm(before.m_linear));
        least = std::min(least, velocityOf(cloth).z);
    }
    EXPECT_LT(least, -1);
}

// Bullet's links exert a small torque on the held body; without links there is only contact.
TEST_P(ClothInSoftWorlds, KeepsAngularMomentumButForBulletsSprings)
{
    ClothWorld scene(GetParam(), {0, 0, 0});
    btSoftBody& ball = scene.addBall({0.1, 0.05, 0.5}, 0.3, 10, 1e5);
    btSoftBody& cloth = scene.addPatch({0, 0, 0}, 1, 1, 11);
    cloth.m_cfg.kDP = 0;
    for (int m = 0; m < cloth.m_materials.size(); ++m) cloth.m_materials[m]->m_kLST = btScalar(1e-20);
    cloth.m_bUpdateRtCst = true;
    ball.setVelocity(btVector3(btScalar(0.3), 0, -3));
    const double size = 3 * massOf(ball) * 0.1;
    Motion before = motionOf(ball);
    before += motionOf(cloth);
    for (int k = 0; k < 30; ++k)
    {
        scene.world().step();
        Motion now = motionOf(ball);
        now += motionOf(cloth);
        EXPECT_LT(norm(now.m_angular - before.m_angular), 1e-4 * size);
    }
    EXPECT_LT(velocityOf(cloth).z, -0.3);
}

// A Bullet rigid sphere of equal mass sags as far, or falls through with the swap, also in a deformable world.
TEST_P(ClothOnFemBodies, CarryABallBetweenPinnedCorners)
{
    ClothWorld scene(GetParam());
    btSoftBody& cloth = scene.addPatch({0, 0, 0}, 2, 1, 21, 1 + 2 + 4 + 8);
    btSoftBody& ball = scene.addBall({0.02, 0.01, 0.5}, 0.3, 1, 1e5);
    const std::vector<Vec3> corners = {vec3(cloth.m_nodes[0].m_x), vec3(cloth.m_nodes[20].m_x)};
    scene.world().step(400);
    const double weight = massOf(ball) * kGravity;
    double force = 0;
    for (int k = 0; k < 200; ++k)
    {
        scene.world().step();
        force += scene.fem().contactForce(&ball, &cloth).z() / 200;
        EXPECT_GT(centerOf(ball).z, lowestHeight(cloth)) << k;
    }
    EXPECT_NEAR(force, weight, 0.1 * weight);  // it still swings
    EXPECT_EQ(vec3(cloth.m_nodes[0].m_x).z, corners[0].z);
    EXPECT_EQ(vec3(cloth.m_nodes[20].m_x).z, corners[1].z);
}

TEST(ClothWithABall, HangsAsLowAsWithBulletsRigidSphere)
{
    const auto heights = [](bool rigid)
    {
        ClothWorld scene(ClothWorldKind::swap);
        scene.addPatch({0, 0, 0}, 2, 1, 21, 1 + 2 + 4 + 8);
        const double radius = 0.3, mass = 0.1;
        btSoftBody* ball = nullptr;
        btRigidBody* sphere = nullptr;
        if (rigid)
            sphere = &scene.world().addRigid(new btSphereShape(btScalar(radius)), {btScalar(mass), at(0, 0, 0.5)});
        else
            ball = &scene.addBall({0, 0, 0.5}, radius, mass / (4.0 / 3 * SIMD_PI * radius * radius * radius));
        scene.world().step(300);
        double mean = 0;
        for (int k = 0; k < 300; ++k)
        {
            scene.world().step();
            mean += (ball ? centerOf(*ball).z : double(sphere->getWorldTransform().getOrigin().z())) / 300;
        }
        return mean;
    };
    EXPECT_NEAR(heights(false), heights(true), 0.1);  // of a sag of 0.7 m
}

TEST_P(ClothOnFemBodies, RopesHangOverABox)
{
    ClothWorld scene(GetParam());
    btSoftBody& block = scene.addBox(stiffSlab({0.4, 1, 0.4}, {4, 8, 4}));
    clampBelow(block, -0.39);
    btSoftBody& rope = scene.addRope({-0.5, 0.03, 0.1}, {0.5, 0.03, 0.1}, 0.3, 41);
    rope.m_cfg.kDP = 0;
    scene.world().step(240);
    const double weight = massOf(rope) * kGravity;
    EXPECT_NEAR(meanForce(scene, block, rope, 600).z, -weight, 0.05 * weight);
    EXPECT_NEAR(rope.m_nodes[20].m_x.z(), kClothMargin, 3e-3);
    EXPECT_LT(lowestHeight(rope), -0.1);
}

// mu is the larger kDF: the cloth sticks up to a slope of mu, and beyond it slides with g (sin - mu cos).
TEST_P(ClothOnFemBodies, StickAndSlideByCoulombsLaw)
{
    const double slope = 20 * SIMD_RADS_PER_DEG, sine = std::sin(slope), cosine = std::cos(slope);
    const btVector3 gravity(btScalar(kGravity * sine), 0, btScalar(-kGravity * cosine));
    const auto slide = [&](double kDF, int frames)
    {
        ClothWorld scene(GetParam(), gravity);
        SoftBox slab = stiffSlab({2, 1, 0.2}, {12, 6, 1});
        slab.m_friction = btScalar(kDF / 2);
        btSoftBody& block = scene.addBox(slab);
        clampBelow(block, -0.19);
        btSoftBody& cloth = scene.addPatch({-0.5, 0, kClothMargin + 1e-4}, 0.4, 0.2, 9);
        cloth.m_cfg.kDP = 0;
        cloth.m_cfg.kDF = btScalar(kDF);
        scene.world().step(frames);
        return velocityOf(cloth).x;
    };
    EXPECT_LT(slide(0.6, 120), 1e-3);
    const double time = 36 * double(kStep);
    EXPECT_NEAR(slide(0.25, 36), kGravity * (sine - 0.25 * cosine) * time, 0.03 * kGravity * sine * time);
}

// 0.3 m a step, through a thickness of 0.2 m.
TEST_P(ClothOnFemBodies, FastOnesDoNotPassEachOther)
{
    ClothWorld scene(GetParam(), {0, 0, 0});
    btSoftBody& slab = scene.addBox(stiffSlab({1, 1, 0.2}, {6, 6, 1}));
    clampBelow(slab, 1);
    btSoftBody& cloth = scene.addPatch({0.02, 0.01, 0.47}, 0.6, 0.1, 13);
    cloth.setVelocity(btVector3(1, 0, -18));
    scene.world().step(10);
    EXPECT_GT(lowestHeight(cloth), 0);

    btSoftBody& pinned = scene.addPatch({5, 0, 0}, 1, 0.1, 4);
    for (int i = 0; i < pinned.m_nodes.size(); ++i) pinned.setMass(i, 0);
    btSoftBody& ball = scene.addBall({5.02, 0.03, 0.4}, 0.1);
    ball.setVelocity(btVector3(0, 0, -18));
    scene.world().step(10);
    EXPECT_GT(centerOf(ball).z, 0);
}

}  // namespace
}  // namespace bullet_fem
