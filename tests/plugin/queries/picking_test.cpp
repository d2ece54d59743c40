// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Picking and dragging, as in Bullet's demos and with a spring.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bullet_fem/btFemRay.h"
#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/each_world.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

constexpr double kMass = 64;  // of a cube of 0.4 m and 1000 kg/m3 [kg]
constexpr double kPi = 3.14159265358979;

SoftBox cubeAt(const Vec3& center)
{
    SoftBox box;
    box.m_size = {0.4, 0.4, 0.4};
    box.m_center = center;
    return box;
}

// A fast figure of eight through the origin: up to 5 m/s [m].
btVector3 pathAt(double t)
{
    const double w = 2 * kPi * 0.6;
    return {btScalar(std::sin(w * t)), btScalar(0.5 * std::sin(2 * w * t)), btScalar(0.3 * std::sin(w * t))};
}

class Picking : public EachWorld
{
protected:
    btFemRayHit pickFromAbove(btScalar x = 0, btScalar y = 0)
    {
        btFemClosestRay ray(btVector3(x, y, 10), btVector3(x, y, -10));
        m_world.bullet().rayTest(ray.m_rayFromWorld, ray.m_rayToWorld, ray);
        EXPECT_EQ(ray.m_collisionObject, &m_body);
        return ray.m_hit;
    }

    btVector3 pointOf(const btFemSpring& spring) const
    {
        btVector3 point(0, 0, 0);
        for (int a = 0; a < 3; ++a) point += spring.m_weights[a] * m_body.m_nodes[spring.m_nodes[a]].m_x;
        return point;
    }

    FemWorld m_world{GetParam()};
    btFemSoftBodySolver& m_fem = m_world.fem();
    btSoftBody& m_body = addSoftBox(m_world, m_fem, cubeAt({0, 0, 0}));
};

INSTANTIATE_TEST_SUITE_P(Worlds, Picking, eachWorld(), nameOfWorld);

class PickingInTheSoftDemo : public EachWorldWith<int>  // numerical damping in percent
{
};

INSTANTIATE_TEST_SUITE_P(Worlds, PickingInTheSoftDemo, testing::Combine(eachWorld(), testing::Values(0, 100)),
                         nameOfWorldWith([](int percent) { return std::to_string(percent) + "percent"; }));

// Bullet's soft demo: before each step the nearest node of the hit face gets the velocity that would take it to the
// mouse.
TEST_P(PickingInTheSoftDemo, NodeVelocityDragsTheBodyForFiveSeconds)
{
    struct Drag
    {
        btSoftBody::Node* m_node;
        btVector3 m_goal;
    };
    btFemSolverInfo info;
    info.m_numericalDamping = info.m_contactDamping = btScalar(0.01) * value();
    FemWorld world(worldClass(), info);
    btFemSoftBodySolver& fem = world.fem();
    btSoftBody& body = addSoftBox(world, fem, cubeAt({0, 0, 0}));
    const btVector3 from(btScalar(0.05), btScalar(0.03), 10), to(btScalar(0.05), btScalar(0.03), -10);
    world.step();
    btSoftBody::sRayCast results;
    ASSERT_TRUE(body.rayTest(from, to, results));
    ASSERT_EQ(results.feature, btSoftBody::eFeature::Face);
    const btVector3 impact = from + (to - from) * results.fraction;
    btSoftBody::Face& face = body.m_faces[results.index];
    Drag drag = {face.m_n[0], impact};
    for (btSoftBody::Node* node : face.m_n)
        if ((node->m_x - impact).length2() < (drag.m_node->m_x - impact).length2()) drag.m_node = node;
    const auto pull = [](btDynamicsWorld* stepped, btScalar step)
    {
        auto& pulled = *static_cast<Drag*>(stepped->getWorldUserInfo());
        btVector3 delta = pulled.m_goal - pulled.m_node->m_x;
        if (delta.length2() > 100) delta = delta.normalized() * 10;
        pulled.m_node->m_v += delta / step;
    };
    world.bullet().setInternalTickCallback(pull, &drag, true);
    double most = 0, farthest = 0;
    for (int k = 0; k < 300; ++k)
    {
        drag.m_goal = impact + pathAt(0.2 * k * double(kStep));
        world.step();
        most = std::max(most, motionOf(body).m_energy);
        farthest = std::max(farthest, double(drag.m_node->m_x.distance(drag.m_goal)));
        ASSERT_TRUE(allFinite(body));
    }
    // The demo's drag is an undamped spring of stiffness m_node / step^2, on which the body falls by twice its static
    // elongation and swings.
    const double sag = kGravity * kMass * double(drag.m_node->m_im) * double(kStep * kStep);
    EXPECT_LT(most, 0.5 * kMass * kGravity * sag + 0.5 * kMass * 3 * 3);
    EXPECT_GT(most, 0.1 * kMass * kGravity * sag);
    EXPECT_LT(farthest, 5 * sag);
}

// Dragging as in engines: the node is pinned, and its position written.
TEST_P(Picking, PinnedNodePositionDragsTheBodyForFiveSeconds)
{
    m_world.step();
    const int picked = pickFromAbove().m_nodes[0];
    btSoftBody::Node& node = m_body.m_nodes[picked];
    const btScalar mass = 1 / node.m_im;
    const btVector3 start = node.m_x;
    m_body.setMass(picked, 0);
    double most = 0;
    for (int k = 0; k < 300; ++k)
    {
        node.m_x = start + pathAt(k * double(kStep));
        m_world.step();
        most = std::max(most, motionOf(m_body).m_energy);
        ASSERT_TRUE(allFinite(m_body));
    }
    EXPECT_LT(most, 0.5 * kMass * 12 * 12);
    EXPECT_LT(norm(vec3(node.m_x) - centerOf(m_body)), 0.6);
    m_body.setMass(picked, mass);
    const double before = norm(velocityOf(m_body));
    m_world.step(10);
    EXPECT_LT(norm(velocityOf(m_body)), before + 10 * kGravity * double(kStep) + 0.1);
    EXPECT_LT(fastestNode(m_body), 30);
}

// A free node whose position is written in each step pulls with its own mass only; the energy stays bounded. After two
// hundred steps the body is fifty metres below the node, and its further swing differs by up to 25 m/s between paths
// that differ by a thousandth.
TEST_P(Picking, FreeNodeMotionAddsNoEnergy)
{
    constexpr int kOrderlySteps = 200;
    m_world.step();
    btSoftBody::Node& node = m_body.m_nodes[pickFromAbove().m_nodes[0]];
    const btVector3 start = node.m_x;
    for (int k = 1; k <= 300; ++k)
    {
        node.m_x = start + pathAt(k * double(kStep)) * btScalar(0.2);
        node.m_v.setZero();
        m_world.step();
        ASSERT_TRUE(allFinite(m_body));
        const double fastest = kGravity * k * double(kStep) + (k <= kOrderlySteps ? 14 : 28);
        ASSERT_LT(motionOf(m_body).m_energy, 0.5 * kMass * fastest * fastest) << "step " << k;
    }
}

TEST_P(Picking, SpringHangsWeightOverStiffnessBelowTheTarget)
{
    m_world.step();
    for (const btScalar stiffness : {btScalar(2e3), btScalar(2e5)})
    {
        btFemSpring spring = btFemSpring::at(pickFromAbove(btScalar(0.02), btScalar(0.01)));
        spring.m_stiffness = stiffness;
        spring.m_damping = 2 * std::sqrt(stiffness * btScalar(kMass));
        m_body.m_cfg.kDP = btScalar(0.02);  // it swings
        const int handle = m_fem.addSpring(&m_body, spring);
        m_world.step(2400);
        const btVector3 stretch = spring.m_target - pointOf(spring);
        const double expected = kMass * kGravity / double(stiffness);
        EXPECT_NEAR(stretch.z(), expected, 1e-3 * expected + 1e-6);
        EXPECT_LT(std::hypot(stretch.x(), stretch.y()), 1e-2 * expected + 1e-5);
        ASSERT_EQ(m_fem.anchors(&m_body).size(), 1);
        const btFemAnchorReport& report = m_fem.anchors(&m_body)[0];
        EXPECT_EQ(report.m_kind, btFemHold::spring);
        EXPECT_EQ(report.m_attachment, handle);
        EXPECT_NEAR(report.m_impulse.z(), kMass * kGravity * double(kStep), 1e-3 * kMass * kGravity * double(kStep));
        m_fem.removeSpring(&m_body, handle);
    }
}

struct SpringCase
{
    const char* m_name;
    btScalar m_stiffness, m_damping, m_maxForce;
    btScalar m_step;
    Coupling m_coupling;
};

class Dragging : public EachWorldWith<SpringCase>
{
};

// The target moves at up to 5 m/s. The body that follows it with oscillations is at most a few times faster; released,
// it keeps its speed.
TEST_P(Dragging, SpringKeepsEnergyBoundedAndReleasesGently)
{
    const SpringCase& c = value();
    FemWorld world(worldClass(), c.m_coupling);
    btFemSoftBodySolver& fem = world.fem();
    btSoftBody& body = addSoftBox(world, fem, cubeAt({0, 0, -0.2}));
    world.step(1, c.m_step);
    btFemRayHit hit;
    ASSERT_TRUE(btFemRay::test(&body, btVector3(btScalar(0.1), btScalar(0.05), 5), btVector3(0, 0, -5), &hit));
    btFemSpring spring = btFemSpring::at(hit);
    spring.m_stiffness = c.m_stiffness;
    spring.m_damping = c.m_damping;
    spring.m_maxForce = c.m_maxForce;
    const int handle = fem.addSpring(&body, spring);
    const int steps = static_cast<int>(std::lround(5 / c.m_step));
    double most = 0, maxForce = 0, farthest = 0;
    for (int k = 0; k < steps; ++k)
    {
        fem.setSpringTarget(&body, handle, hit.m_point + pathAt(k * double(c.m_step)));
        world.step(1, c.m_step);
        most = std::max(most, motionOf(body).m_energy);
        maxForce = std::max(maxForce, double(fem.anchors(&body)[0].m_impulse.length() / c.m_step));
        farthest = std::max(farthest, double(fem.anchors(&body)[0].m_error));
        ASSERT_TRUE(allFinite(body));
    }
    EXPECT_LT(most, 0.5 * kMass * 12 * 12);
    EXPECT_GT(most, 0.5 * kMass * 2 * 2);
    EXPECT_LT(farthest, 2);
    EXPECT_LE(maxForce, 1.0001 * (c.m_maxForce > 0 ? double(c.m_maxForce) : 1e30));
    fem.removeSpring(&body, handle);
    const double before = norm(velocityOf(body));
    world.step(10, c.m_step);
    EXPECT_LT(norm(velocityOf(body)), before + 10 * kGravity * double(c.m_step) + 1e-3);
    EXPECT_LT(fastestNode(body), 30);
    EXPECT_EQ(fem.anchors(&body).size(), 0);
}

const SpringCase kSprings[] = {
    {"Usual", 2e4, 500, 0, kStep, Coupling::swap},
    {"Stiff", 1e7, 0, 0, kStep, Coupling::swap},
    {"StiffCoupled", 1e7, 0, 0, kStep, Coupling::coupled},
    {"Rigid", 1e12, 0, 0, kStep, Coupling::swap},
    {"StiffAtLongSteps", 1e7, 0, 0, btScalar(1.0 / 30), Coupling::swap},
    {"StiffAtShortSteps", 1e7, 0, 0, btScalar(1.0 / 240), Coupling::swap},
    {"Limited", 1e7, 0, btScalar(8 * kMass * kGravity), kStep, Coupling::swap},
};

std::string springName(const SpringCase& spring)
{
    return spring.m_name;
}

INSTANTIATE_TEST_SUITE_P(Springs, Dragging,
                         testing::Combine(testing::Values(WorldClass::softRigid), testing::ValuesIn(kSprings)),
                         nameOfWorldWith(springName));
INSTANTIATE_TEST_SUITE_P(OtherWorlds, Dragging,
                         testing::Combine(testing::Values(WorldClass::softMultiBody, WorldClass::deformable),
                                          testing::Values(kSprings[0], kSprings[1])),
                         nameOfWorldWith(springName));

// A target that jumps pulls at most with the maximum force.
TEST_P(Picking, LimitedSpringSurvivesAJumpingTarget)
{
    m_world.step();
    btFemSpring spring = btFemSpring::at(pickFromAbove());
    spring.m_stiffness = btScalar(1e8);
    spring.m_maxForce = btScalar(10 * kMass * kGravity);
    const int handle = m_fem.addSpring(&m_body, spring);
    double away = 0;  // mean: a millionth of the force moves the last place by a metre
    for (int k = 0; k < 300; ++k)
    {
        m_fem.setSpringTarget(&m_body, handle, btVector3(0, 0, k / 30 % 2 ? btScalar(-1) : btScalar(1)));
        m_world.step();
        away += norm(centerOf(m_body)) / 300;
        ASSERT_LE(m_fem.anchors(&m_body)[0].m_impulse.length(), 1.0001 * double(spring.m_maxForce * kStep));
        ASSERT_LT(fastestNode(m_body), 60);
    }
    EXPECT_LT(away, 3);
}

// A body on the floor is pulled sideways.
TEST_P(Picking, SpringDragsABodyOverTheFloorAgainstFriction)
{
    const btRigidBody& plane = m_world.addPlane(btScalar(-0.2));
    m_world.step(30);
    btFemSpring spring = btFemSpring::at(pickFromAbove());
    spring.m_stiffness = 5e3;
    spring.m_damping = 800;
    const int handle = m_fem.addSpring(&m_body, spring);
    btVector3 target;
    for (int k = 0; k < 180; ++k)
    {
        target = spring.m_target + btVector3(btScalar(0.5 * k * double(kStep)), 0, 0);
        m_fem.setSpringTarget(&m_body, handle, target);
        m_world.step();
    }
    EXPECT_NEAR(velocityOf(m_body).x, 0.5, 0.05);
    // The spring balances friction, mu = 0.5 times the plane's 1, and carries a part of the weight.
    const btVector3 pull = m_fem.anchors(&m_body)[0].m_impulse / kStep, floor = m_fem.contactForce(&m_body, &plane);
    EXPECT_NEAR(pull.x(), 5e3 * double(target.x() - pointOf(spring).x()) - 800 * 0.5, 0.03 * kMass * kGravity);
    EXPECT_NEAR(pull.x(), -floor.x(), 0.02 * kMass * kGravity);
    EXPECT_NEAR(-floor.x(), 0.5 * floor.z(), 0.01 * floor.z());
    EXPECT_NEAR(pull.z() + floor.z(), kMass * kGravity, 0.02 * kMass * kGravity);
    EXPECT_GT(floor.z(), 0.2 * kMass * kGravity);
}

TEST_P(Picking, SpringsWakeASleeperAndLetItSleep)
{
    m_world.addPlane(btScalar(-0.2));
    m_body.forceActivationState(ACTIVE_TAG);
    m_world.step(300);
    ASSERT_EQ(m_body.getActivationState(), ISLAND_SLEEPING);
    btFemSpring spring = btFemSpring::at(pickFromAbove());
    const int handle = m_fem.addSpring(&m_body, spring);
    m_world.step();
    EXPECT_TRUE(m_body.isActive());
    m_world.step(400);
    ASSERT_EQ(m_body.getActivationState(), ISLAND_SLEEPING);
    m_fem.setSpringTarget(&m_body, handle, spring.m_target + btVector3(0, 0, 1));
    m_world.step(5);
    EXPECT_TRUE(m_body.isActive());
    EXPECT_GT(velocityOf(m_body).z, 0.1);
}

TEST_P(Picking, BadSpringsAreRejected)
{
    m_world.step();
    const btFemSpring good = btFemSpring::at(pickFromAbove());
    EXPECT_TRUE(good.valid());
    std::vector<btFemSpring> bad(9, good);
    bad[0].m_stiffness = -1;
    bad[1].m_stiffness = NAN;
    bad[2].m_damping = btScalar(2e12);
    bad[3].m_maxForce = -1;
    bad[4].m_target.setX(INFINITY);
    bad[5].m_target.setY(btScalar(2e6));
    bad[6].m_weights[0] += 1;
    bad[7].m_weights[1] = NAN;
    bad[8].m_nodes[0] = m_body.m_nodes.size(), bad[8].m_weights[0] = 1, bad[8].m_weights[1] = bad[8].m_weights[2] = 0;
    for (std::size_t k = 0; k < bad.size(); ++k)
    {
        std::string why;
        EXPECT_EQ(bad[k].valid(&why), k == 8) << k;
        EXPECT_EQ(why.empty(), k == 8) << k;
        EXPECT_THROW(m_fem.addSpring(&m_body, bad[k]), std::invalid_argument) << k;
    }
    EXPECT_THROW(m_fem.addSpring(nullptr, good), std::invalid_argument);
    EXPECT_THROW(m_fem.setSpringTarget(&m_body, 17, good.m_target), std::invalid_argument);
    const int handle = m_fem.addSpring(&m_body, good);
    EXPECT_THROW(m_fem.setSpringTarget(&m_body, handle, btVector3(0, NAN, 0)), std::invalid_argument);
    m_fem.removeSpring(&m_body, handle);
    m_fem.removeSpring(&m_body, handle);
    m_world.step(30);
    EXPECT_NEAR(velocityOf(m_body).z, -kGravity * 31 * double(kStep), 1e-3);
}

TEST_P(Picking, ASpringOfPinnedNodesOrOfNoStiffnessDoesNothing)
{
    m_world.step();
    btFemSpring spring = btFemSpring::at(pickFromAbove());
    spring.m_stiffness = 0;
    m_fem.addSpring(&m_body, spring);
    m_world.step(10);
    EXPECT_NEAR(velocityOf(m_body).z, -kGravity * 11 * double(kStep), 1e-3);
    spring.m_stiffness = btScalar(1e6);
    spring.m_target += btVector3(1, 0, 0);
    for (int node : spring.m_nodes) m_body.setMass(node, 0);
    m_fem.addSpring(&m_body, spring);
    m_world.step(10);
    EXPECT_EQ(m_fem.anchors(&m_body)[1].m_impulse.length(), 0);
    EXPECT_TRUE(allFinite(m_body));
}

}  // namespace
}  // namespace bullet_fem
