// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Contact of render surfaces (skins): rest positions and contact forces.
#include <gtest/gtest.h>

#include "bridge/concave_test_shapes.h"
#include "bullet_fem/btFemCollision.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "fem/scenes/test_surfaces.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/skin_bodies.h"

namespace bullet_fem
{
namespace
{

constexpr double kSoftFriction = 0.5, kRigidFriction = 0.8;
constexpr double kFriction = kSoftFriction * kRigidFriction;  // Coulomb's mu [-]
constexpr double kSlop = 1e-4;  // accepted penetration at rest: 5e-5 of the body's size, and rounding [m]

class Skin : public testing::TestWithParam<Coupling>
{
protected:
    explicit Skin(const btVector3& gravity = {0, 0, btScalar(-kGravity)}) : m_world(m_fem, GetParam(), gravity) {}

    btSoftBody& add(const SkinBody& body) { return addSkinBody(m_world, m_fem, body); }

    btFemSoftBodySolver m_fem;
    SoftWorld m_world;
};

class SkinGround : public Skin
{
protected:
    void expectToCarry(const btSoftBody& body, const btCollisionObject& ground)
    {
        const double weight = massOf(body) * kGravity;
        EXPECT_NEAR(m_fem.contactForce(&body, &ground).z(), weight, 1e-3 * weight);
    }
};

TEST_P(SkinGround, ABallRestsOnItsSurfaceWithItsCageInThePlane)
{
    btSoftBody& ball = add(skinBall({0, 0, 0.51}));
    const btRigidBody& plane = m_world.addPlane();
    m_world.step(240);
    EXPECT_NEAR(lowestVertex(ball), 0, kSlop);
    EXPECT_LT(lowestHeight(ball), -0.01);
    expectToCarry(ball, plane);
    EXPECT_EQ(m_fem.stepReport(&ball).m_flags, 0);
    EXPECT_LT(fastestNode(ball), 1e-3);
}

TEST_P(SkinGround, ABallRestsOnABox)
{
    btSoftBody& ball = add(skinBall({0, 0, 0.51}));
    const btRigidBody& floor = m_world.addFloorBox();
    m_world.step(240);
    EXPECT_NEAR(lowestVertex(ball), 0, kSlop);
    expectToCarry(ball, floor);
}

TEST_P(SkinGround, ABallRestsOnATriangleMeshAndIsNotShotThroughIt)
{
    static btTriangleMesh mesh;  // must outlive the world
    if (mesh.getNumTriangles() == 0) addGrid(mesh, {});
    btBvhTriangleMeshShape* shape = new btBvhTriangleMeshShape(&mesh, true);
    shape->setMargin(btScalar(0.01));
    const btRigidBody& sheet = m_world.addRigid(shape);
    SkinBody settings = skinBall({0, 0, 0.6});
    settings.m_youngModulus = btScalar(5e6);
    btSoftBody& ball = add(settings);
    m_world.step(360);
    EXPECT_NEAR(lowestVertex(ball), 0.01, kSlop);
    expectToCarry(ball, sheet);
    ball.translate(btVector3(0, 0, 1));
    ball.setVelocity(btVector3(1, 0, -20));
    for (int k = 0; k < 20; ++k)
    {
        m_world.step();
        ASSERT_GT(lowestVertex(ball), -0.01) << "step " << k;
        ASSERT_GT(centerOf(ball).z, 0.2) << "step " << k;
    }
}

TEST_P(SkinGround, ItsCageStandsHigher)
{
    SkinBody settings = skinBall({0, 0, 0.6});
    settings.m_surfaceCollides = false;
    btSoftBody& ball = add(settings);
    m_world.addPlane();
    m_world.step(240);
    EXPECT_GT(lowestVertex(ball), 0.02);
}

TEST_P(SkinGround, CollisionSurfaceCanBeChangedAtAnyTime)
{
    btSoftBody& ball = add(skinBall({0, 0, 0.51}));
    m_world.addPlane();
    m_world.step(120);
    ball.m_cfg.collisions &= ~BT_FEM_RENDER_SURFACE;
    m_world.step(180);
    EXPECT_GT(lowestVertex(ball), 0.02);
    ball.m_cfg.collisions |= BT_FEM_RENDER_SURFACE;
    m_world.step(180);
    EXPECT_NEAR(lowestVertex(ball), 0, kSlop);
}

TEST_P(SkinGround, ABoxStandsOnAnother)
{
    btSoftBody& lower = add(skinBox({0.8, 0.8, 0.4}, {0, 0, 0.205}));
    btSoftBody& upper = add(skinBox({0.6, 0.6, 0.3}, {0.05, 0, 0.565}));
    const btRigidBody& floor = m_world.addFloorBox();
    m_world.step(150);
    EXPECT_NEAR(lowestVertex(lower), 0, kSlop);
    const double weight = (massOf(lower) + massOf(upper)) * kGravity;
    EXPECT_NEAR(m_fem.contactForce(&lower, &floor).z(), weight, 1e-3 * weight);
    EXPECT_NEAR(m_fem.contactForce(&upper, &lower).z(), massOf(upper) * kGravity, 1e-3 * massOf(upper) * kGravity);
    EXPECT_NEAR(lowestVertex(upper), 0.4, 5e-3);  // the lower one is compressed; both cages have cells of 13 cm
    EXPECT_LT(m_fem.stepReport(&upper).m_deepestPenetration, 1e-3);
}

// A soft box falls on a floor, a knob and a rail, and is hit by a stone.
std::vector<btScalar> runOfABox(Coupling coupling, bool drawn)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem, coupling);
    SoftBox box;
    box.m_size = {0.5, 0.4, 0.3};
    box.m_cells = {3, 3, 2};
    box.m_center = {0, 0, 0.3};
    btSoftBody& soft = addSoftBox(world, fem, box);
    if (drawn)
    {
        drawBoundary(soft);
        soft.m_cfg.collisions |= BT_FEM_RENDER_SURFACE;
    }
    world.addFloorBox();
    world.addRigid(new btSphereShape(btScalar(0.1)), {0, at(btScalar(-0.2), 0, btScalar(-0.05))});
    addRigidBox(world, {0.03, 1, 0.1}, {0, at(btScalar(0.15), 0, 0)});
    addRigidBox(world, {0.2, 0.2, 0.2}, {10, at(btScalar(0.1), btScalar(0.05), btScalar(0.8))});
    soft.setVelocity(btVector3(btScalar(0.5), btScalar(0.2), -1));
    std::vector<btScalar> bits;
    for (int k = 0; k < 60; ++k)
    {
        world.step();
        const std::vector<btScalar> now = bitsOf(soft);
        bits.insert(bits.end(), now.begin(), now.end());
        const Vec3 impulse = impulseOn(fem, soft);
        bits.insert(bits.end(), {btScalar(impulse.x), btScalar(impulse.y), btScalar(impulse.z)});
    }
    EXPECT_EQ(fem.stepReport(&soft).m_flags, 0);
    return bits;
}

TEST_P(SkinGround, BoundarySkinCollidesLikeTheBodyToTheBit)
{
    EXPECT_TRUE(runOfABox(GetParam(), true) == runOfABox(GetParam(), false));
}

INSTANTIATE_TEST_SUITE_P(Couplings, SkinGround, testing::Values(Coupling::swap, Coupling::coupled),
                         [](const auto& scene) { return couplingName(scene.param); });

/// A box whose render surface lies on a plane inclined downwards to +x, with tan(slope) = steepness * mu.
class SkinIncline
{
public:
    SkinIncline(double steepness, double square) : m_slope(std::atan(steepness * kFriction)), m_world(m_fem)
    {
        const btQuaternion tilt(btVector3(0, 1, 0), btScalar(m_slope));
        m_normal = vec3(quatRotate(tilt, btVector3(0, 0, 1)));
        m_downhill = vec3(quatRotate(tilt, btVector3(1, 0, 0)));
        RigidSettings settings;
        settings.m_friction = btScalar(kRigidFriction);
        m_world.addRigid(new btStaticPlaneShape(quatRotate(tilt, btVector3(0, 0, 1)), 0), settings);
        m_box = makeSkinBody(m_world, m_fem, skinBox({0.8, 0.8, 0.4}, {0, 0, 0.201}, square));
        m_box->rotate(tilt);
        m_world.addSoft(m_box);
    }

    void step(int count) { m_world.step(count); }
    double downhillSpeed() const { return dot(velocityOf(*m_box), m_downhill); }
    double frictionOverNormal() const
    {
        const Vec3 J = impulseOn(m_fem, *m_box);
        return norm(J - dot(J, m_normal) * m_normal) / dot(J, m_normal);
    }
    double lowestGap() const { return lowestVertex(*m_box, m_normal); }
    double slope() const { return m_slope; }

private:
    double m_slope;
    btFemSoftBodySolver m_fem;
    SoftWorld m_world;
    Vec3 m_normal, m_downhill;
    btSoftBody* m_box;
};

/// The parameter is the size of the surface's squares [m]: as coarse as the cage, or so fine that contacts are thinned.
class SkinFriction : public testing::TestWithParam<double>
{
};

TEST_P(SkinFriction, SticksJustBelowTheFrictionAngle)
{
    SkinIncline incline(0.95, GetParam());
    incline.step(240);
    for (int frame = 0; frame < 30; ++frame)
    {
        incline.step(1);
        EXPECT_LT(std::fabs(incline.downhillSpeed()), 1e-4) << "frame " << frame;
        EXPECT_NEAR(incline.frictionOverNormal(), std::tan(incline.slope()), 1e-3 * kFriction) << "frame " << frame;
        EXPECT_GT(incline.lowestGap(), -kSlop);
    }
}

TEST_P(SkinFriction, SlidesAboveItWithCoulombsForceAndNetAcceleration)
{
    SkinIncline incline(1.2, GetParam());
    incline.step(120);
    const double before = incline.downhillSpeed();
    for (int frame = 0; frame < 60; ++frame)
    {
        incline.step(1);
        EXPECT_NEAR(incline.frictionOverNormal(), kFriction, 5e-4 * kFriction) << "frame " << frame;
        EXPECT_GT(incline.lowestGap(), -kSlop);
    }
    const double slope = incline.slope();
    EXPECT_NEAR((incline.downhillSpeed() - before) / (60 * kStep),
                kGravity * (std::sin(slope) - kFriction * std::cos(slope)), 0.01 * kGravity * std::sin(slope));
}

INSTANTIATE_TEST_SUITE_P(Squares, SkinFriction, testing::Values(0.1, 0.04),
                         [](const auto& scene) { return scene.param > 0.05 ? "coarse" : "fine"; });

// Speed after a second of a ball that starts rolling at 1 m/s [m/s]. Contact acts on the surface's position at the end
// of the step, v h ahead, which alone costs 5/7 g v h / R = 0.06 m/s.
double speedOfARollingBall(bool surfaceCollides)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem);
    world.addPlane().setFriction(1);
    SkinBody settings = skinBall({0, 0, 0.5});
    settings.m_surface = sphereSurface(0.5, {0, 0, 0.5}, 4);
    settings.m_youngModulus = btScalar(5e6);
    settings.m_surfaceCollides = surfaceCollides;
    btSoftBody* ball = makeSkinBody(world, fem, settings);
    if (!surfaceCollides) ball->translate(btVector3(0, 0, btScalar(0.06)));
    world.addSoft(ball);
    const btScalar h = kStep / 4;
    world.step(120, h);
    const Vec3 centre = centerOf(*ball);
    for (int i = 0; i < ball->m_nodes.size(); ++i)
        ball->m_nodes[i].m_v = btVector3(btScalar(1 + (ball->m_nodes[i].m_x.z() - centre.z) / 0.5), 0,
                                         btScalar(-(ball->m_nodes[i].m_x.x() - centre.x) / 0.5));
    world.step(240, h);
    return velocityOf(*ball).x;
}

TEST(SkinRolling, ABallRollsOnItsSurfaceAndHardlyOnItsCage)
{
    EXPECT_GT(speedOfARollingBall(true), 0.88);
    EXPECT_LT(speedOfARollingBall(false), 0.6);
}

/// Without gravity.
class SkinCollision : public Skin
{
protected:
    SkinCollision() : Skin(btVector3(0, 0, 0)) {}

    template <class Second>
    void expectBothMomentaKept(btSoftBody& first, Second& second)
    {
        const auto sum = [&]
        {
            Motion motion = motionOf(first);
            return motion += motionOf(second);
        };
        const Motion start = sum();
        int touching = 0;
        double linear = 0, angular = 0;  // maximum relative errors
        for (int k = 0; k < 60; ++k)
        {
            m_world.step();
            touching += norm(impulseOn(m_fem, first)) > 0;
            const Motion now = sum();
            const double scale = norm(motionOf(first).m_linear) + norm(motionOf(second).m_linear);
            linear = std::max(linear, norm(now.m_linear - start.m_linear) / scale);
            angular = std::max(angular, norm(now.m_angular - start.m_angular) / scale);  // arm of a metre
        }
        const double rounding = sizeof(btScalar) == 4 ? 1e-5 : 1e-6;
        EXPECT_LT(linear, 1e-6);
        EXPECT_LT(angular, rounding);
        EXPECT_GT(touching, 0);
        const Vec3 apart = centerOf(first) - placeOf(second);
        EXPECT_GT(dot(apart, velocityOf(first) - speedOf(second)), 0);
    }

    static Vec3 placeOf(const btSoftBody& body) { return centerOf(body); }
    static Vec3 placeOf(const btRigidBody& body) { return vec3(body.getCenterOfMassPosition()); }
    static Vec3 speedOf(const btSoftBody& body) { return velocityOf(body); }
    static Vec3 speedOf(const btRigidBody& body) { return vec3(body.getLinearVelocity()); }

    static void throwAt(btSoftBody& body, const btVector3& velocity, const btVector3& spin)
    {
        const btVector3 centre = bulletVector(centerOf(body));
        for (int i = 0; i < body.m_nodes.size(); ++i)
            body.m_nodes[i].m_v = velocity + spin.cross(body.m_nodes[i].m_x - centre);
    }
};

TEST_P(SkinCollision, ConservesBothMomentaOfTwoBalls)
{
    btSoftBody &first = add(skinBall({0, 0, 0})), &second = add(skinBall({0.3, -0.2, 1.05}));
    throwAt(first, {0, 0, btScalar(1)}, {1, btScalar(-0.5), 2});
    throwAt(second, {0, btScalar(0.2), -1}, {0, 2, 1});
    expectBothMomentaKept(first, second);
}

TEST_P(SkinCollision, ConservesBothMomentaWithARigidBox)
{
    btSoftBody& ball = add(skinBall({0, 0, 0}));
    RigidSettings settings{btScalar(300), at(btScalar(0.23), btScalar(-0.11), btScalar(0.83))};
    settings.m_velocity = {0, 0, -1};
    settings.m_spin = {1, btScalar(-0.5), 2};
    btRigidBody& box = addRigidBox(m_world, {0.6, 0.6, 0.6}, settings);
    box.setFriction(btScalar(0.6));
    expectBothMomentaKept(ball, box);
}

TEST_P(SkinCollision, OccursAtAnySpeed)
{
    for (const btScalar speed : {btScalar(10), btScalar(60)})
    {
        btFemSoftBodySolver fem;
        SoftWorld world(fem, GetParam(), {0, 0, 0});
        SkinBody settings;
        settings.m_surface = sphereSurface(0.1, {0, 0, 0}, 2);
        settings.m_cell = 0.05;
        settings.m_youngModulus = btScalar(2e6);
        btSoftBody& ball = addSkinBody(world, fem, settings);
        addRigidBox(world, {2, 2, 0.02}, {0, at(0, 0, btScalar(-0.93))});
        throwAt(ball, {0, 0, -speed}, {0, 0, 0});
        world.step(static_cast<int>(4 / (speed * kStep)) + 4);
        EXPECT_GT(centerOf(ball).z, -0.92) << speed;
        EXPECT_TRUE(allFinite(ball));
    }
}

INSTANTIATE_TEST_SUITE_P(Couplings, SkinCollision, testing::Values(Coupling::swap, Coupling::coupled),
                         [](const auto& scene) { return couplingName(scene.param); });

}  // namespace
}  // namespace bullet_fem
