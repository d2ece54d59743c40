// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/rigid/contact_finder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "bridge/concave_test_shapes.h"
#include "bridge/contact_finder_scene.h"
#include "bullet_fem/btFemVectors.h"

namespace bullet_fem
{
namespace
{

class ContactFinderTest : public ContactFinderScene
{
protected:
    ContactFinderTest()
    {
        m_ball.setCollisionShape(&m_sphere);
        m_ground.setCollisionShape(&m_plane);
        m_ground.setFriction(btScalar(0.5));
        m_box.m_body->m_cfg.kDF = btScalar(0.8);
    }

    btStaticPlaneShape m_plane{btVector3(0, 0, 1), 0};
    btSphereShape m_sphere{btScalar(0.1)};
    btCollisionObject m_ground, m_ball;
};

TEST_F(ContactFinderTest, NodesOfAFaceContactThePlaneBelow)
{
    const auto& contacts = find(m_ground);
    ASSERT_EQ(contacts.size(), 9u);
    for (const ContactPoint& c : contacts)
    {
        EXPECT_NEAR(c.m_gap, 0, 1e-12);
        EXPECT_NEAR(c.m_normal.z, 1, 1e-12);
        EXPECT_NEAR(c.m_friction, 0.4, 1e-7) << "kDF times the rigid body's friction";
        EXPECT_EQ(c.m_soft.m_nodes[0], c.m_soft.m_nodes[1]);
    }
}

TEST_F(ContactFinderTest, RestitutionIsTheProductOfBothAtMostOne)
{
    EXPECT_EQ(find(m_ground).at(0).m_restitution, 0);
    m_box.m_body->setRestitution(btScalar(0.5));
    m_ground.setRestitution(btScalar(0.5));
    EXPECT_EQ(find(m_ground).at(0).m_restitution, 0.25);
    m_ground.setRestitution(8);
    EXPECT_EQ(find(m_ground).at(0).m_restitution, 1);
    m_ground.setRestitution(-1);
    EXPECT_EQ(find(m_ground).at(0).m_restitution, 0);
}

TEST_F(ContactFinderTest, TakesContactStiffnessFromTheRigidObject)
{
    EXPECT_EQ(find(m_ground).at(0).m_stiffness, 0);
    m_ground.setContactStiffnessAndDamping(1024, 8);
    EXPECT_EQ(find(m_ground).at(0).m_stiffness, 1024);
    EXPECT_EQ(find(m_ground).at(0).m_damping, 8);
    m_ground.setContactStiffnessAndDamping(BT_LARGE_FLOAT, 8);
    EXPECT_EQ(find(m_ground).at(0).m_stiffness, 0) << "rigid";
    EXPECT_EQ(find(m_ground).at(0).m_damping, 0);
}

TEST_F(ContactFinderTest, OmitsContactsOutOfReachWithinTheStep)
{
    for (Vec3& x : m_fem.m_body.m_state.m_x) x.z += 0.5;
    EXPECT_TRUE(find(m_ground).empty());
    for (Vec3& v : m_fem.m_body.m_state.m_v) v.z = -40;  // 0.67 m a step
    EXPECT_EQ(find(m_ground).size(), 9u);
    for (Vec3& v : m_fem.m_body.m_state.m_v) v.z = 40;
    EXPECT_TRUE(find(m_ground).empty());
}

TEST_F(ContactFinderTest, BallBetweenFixedPointsContactsNearestTrianglePoint)
{
    // Nodes are 0.25 m away, and the nearest point is no midpoint of an edge or triangle.
    m_ball.getWorldTransform().setOrigin(btVector3(btScalar(0.3), btScalar(0.26), btScalar(1.09)));
    ASSERT_FALSE(find(m_ball).empty());
    const ContactPoint& c = *deepest();
    EXPECT_NEAR(c.m_gap, -0.01, 1e-6);
    EXPECT_NEAR(c.m_normal.z, -1, 1e-6);
    EXPECT_NEAR(c.m_soft.m_weights[0] + c.m_soft.m_weights[1] + c.m_soft.m_weights[2], 1, 1e-12);
    EXPECT_NEAR(c.m_point.x, 0.3, 1e-6);
    EXPECT_NEAR(c.m_point.y, 0.26, 1e-6);
}

// A box within one triangle of the top face.
TEST_F(ContactFinderTest, SmallBoxOnATriangleContactsItWithItsCorners)
{
    const double half = 0.04, edge = m_fem.m_surface.meanEdge();
    const auto touchesAt = [&](double depth, double height)
    {
        btBoxShape box(bulletVector({half, half, height / 2}));
        btCollisionObject object;
        object.setCollisionShape(&box);
        object.getWorldTransform().setOrigin(bulletVector({0.25, 0.1, 1 - depth + height / 2}));
        int count = 0;
        for (const ContactPoint& c : find(object))
        {
            const bool isCorner = std::fabs(std::fabs(c.m_point.x - 0.25) - half) < 1e-6 &&
                                  std::fabs(std::fabs(c.m_point.y - 0.1) - half) < 1e-6;
            count += isCorner && c.m_normal.z < -1 + 1e-6 && std::fabs(c.m_gap + depth) < 1e-6;
        }
        return count;
    };
    EXPECT_EQ(touchesAt(0.001, 2 * half), 4);
    EXPECT_EQ(touchesAt(-0.01, 2 * half), 4) << "within the contact band";
    EXPECT_EQ(touchesAt(0.29 * edge, 0.5), 4);
    EXPECT_NE(touchesAt(0.31 * edge, 0.5), 4) << "it came from elsewhere";
    const double tallest = std::sqrt(4 * edge * edge - 8 * half * half);  // its bounds are two edges wide
    EXPECT_EQ(touchesAt(0.001, 0.99 * tallest), 4);
    EXPECT_LT(touchesAt(0.001, 1.01 * tallest), 4);
}

TEST_F(ContactFinderTest, ActiveNearestPointYieldsToNearlyAsCloseFixedPoints)
{
    // Moves the ball over an edge that starts at the middle node of the top face.
    const auto find = [this](double aside) -> const std::vector<ContactPoint>&
    {
        m_ball.getWorldTransform().setOrigin(btVector3(btScalar(0.5 + aside), btScalar(0.5), btScalar(1.09)));
        return ContactFinderScene::find(m_ball);
    };
    const auto isNearest = [](const ContactPoint& c) { return std::fabs(c.m_gap + 0.01) < 1e-6; };
    const auto hasNearest = [&](const std::vector<ContactPoint>& contacts)
    { return std::any_of(contacts.begin(), contacts.end(), isNearest); };
    constexpr double kFar = 0.03, kNear = 0.014, kNext = 0.004;  // the node is 4.9, 1.1 and .09 mm farther
    EXPECT_FALSE(hasNearest(find(kNear))) << "it would wander over the surface";
    ASSERT_TRUE(hasNearest(find(kFar)));
    EXPECT_FALSE(hasNearest(find(kNear))) << "it did not push";
    ASSERT_TRUE(hasNearest(find(kFar)));
    for (ContactPoint& c : m_fem.m_memory.m_contacts) c.m_impulse = isNearest(c) ? c.m_normal : Vec3();
    EXPECT_TRUE(hasNearest(find(kNear)));
    EXPECT_FALSE(hasNearest(find(kNext)));
}

TEST_F(ContactFinderTest, LoadOfAnActiveNearestPointFollowsSlowly)
{
    const auto findNearest = [this](double aside)
    {
        m_ball.getWorldTransform().setOrigin(btVector3(btScalar(0.3 + aside), btScalar(0.26), btScalar(1.09)));
        find(m_ball);
        EXPECT_NEAR(deepest()->m_point.x, 0.3 + aside, 1e-6) << "where the impulse acts";
        EXPECT_NEAR(deepest()->m_gap, -0.01, 1e-6);
        return deepest()->m_soft.of(m_fem.m_body.m_state.m_x).x - 0.3;
    };
    const auto pushDeepest = [this]
    {
        const ContactPoint* const pushed = &*deepest();
        for (ContactPoint& c : m_fem.m_memory.m_contacts) c.m_impulse = &c == pushed ? c.m_normal : Vec3();
    };
    constexpr double kAside = 0.01, kFar = 0.11;  // mean edges are .6 m
    EXPECT_NEAR(findNearest(0), 0, 1e-6);
    EXPECT_NEAR(findNearest(kAside), kAside, 1e-6) << "it did not push";
    pushDeepest();
    EXPECT_NEAR(findNearest(0), 0.9 * kAside, 1e-6);
    pushDeepest();
    EXPECT_NEAR(findNearest(0), 0.9 * 0.9 * kAside, 1e-6);
    pushDeepest();
    EXPECT_NEAR(findNearest(kFar), kFar, 1e-6) << "it would stay far behind";
    pushDeepest();
    for (Vec3& v : m_fem.m_body.m_state.m_v) v.x = 1;
    EXPECT_NEAR(findNearest(0.1), 0.1, 1e-6) << "it is fast";
}

TEST_F(ContactFinderTest, CurvedShapeContactsFixedSurfacePoints)
{
    btSphereShape large(30);
    m_ball.setCollisionShape(&large);
    m_ball.getWorldTransform().setOrigin(btVector3(btScalar(0.41), btScalar(0.37), btScalar(-30)));
    for (const ContactPoint& c : find(m_ball))
        for (double w : c.m_soft.m_weights)
            EXPECT_TRUE(w == 0 || w == 0.5 || w == 1 || std::abs(w - 1.0 / 3) < 1e-12) << w;
    EXPECT_GT(m_fem.m_memory.m_contacts.size(), 9u);
}

TEST_F(ContactFinderTest, TheOffsetIsTakenOffTheGap)
{
    m_fem.m_settings.m_contactOffset = 0.02;
    ASSERT_EQ(find(m_ground).size(), 9u);
    for (const ContactPoint& c : m_fem.m_memory.m_contacts) EXPECT_NEAR(c.m_gap, -0.02, 1e-12);
}

TEST_F(ContactFinderTest, ImpulsesOfTheLastStepAreTakenOver)
{
    ASSERT_EQ(find(m_ground).size(), 9u);
    m_fem.m_memory.m_contacts[4].m_impulse = {1, 2, 3};
    const int node = m_fem.m_memory.m_contacts[4].m_soft.m_nodes[0];
    ASSERT_EQ(find(m_ground).size(), 9u);
    for (const ContactPoint& c : m_fem.m_memory.m_contacts)
        EXPECT_EQ(c.m_impulse.y, c.m_soft.m_nodes[0] == node ? 2 : 0);
}

TEST_F(ContactFinderTest, ImpulsesOfAllKindsOfPointsAreTakenOver)
{
    // A tilted box penetrates with one corner: contacts of nodes, of midpoints, and of nearest points on edges and
    // triangles.
    btBoxShape box(btVector3(1, 1, 1) * btScalar(0.4));
    m_ball.setCollisionShape(&box);
    m_ball.getWorldTransform().setRotation(btQuaternion(btScalar(0.3), btScalar(0.2), btScalar(0.1)));
    m_ball.getWorldTransform().setOrigin(btVector3(btScalar(0.43), btScalar(0.37), btScalar(-0.35)));
    const std::size_t count = find(m_ball).size();
    const int nodes = m_fem.m_body.m_model->nodeCount();
    const int edges = m_fem.m_surface.topology().edgeCount();
    ASSERT_GT(
        std::count_if(m_fem.m_memory.m_origins.begin(), m_fem.m_memory.m_origins.end(),
                      [=](const ContactOrigin& o) { return o.m_feature >= nodes && o.m_feature < nodes + 2 * edges; }),
        5);
    EXPECT_TRUE(std::is_sorted(m_fem.m_memory.m_origins.begin(), m_fem.m_memory.m_origins.end()));
    for (std::size_t k = 0; k < count; ++k)
    {
        m_fem.m_memory.m_contacts[k].m_impulse = {1, 2.0 + k, 3};
        m_fem.m_memory.m_contacts[k].m_slip = {2.0 + k, 0, 0};
    }
    ASSERT_EQ(find(m_ball).size(), count);
    std::size_t found = 0;
    for (std::size_t k = 0; k < count; ++k)
        found +=
            m_fem.m_memory.m_contacts[k].m_impulse.y == 2.0 + k && m_fem.m_memory.m_contacts[k].m_slip.x == 2.0 + k;
    EXPECT_EQ(found, count);
}

TEST_F(ContactFinderTest, KeepsTheDeepestOfTheContactsThinnedToTheLimit)
{
    Vec3& deep = m_fem.m_body.m_state.m_x[4];
    deep.z -= 0.01;
    const std::size_t count = find(m_ground, 8).size();
    EXPECT_LE(count, 8u);
    EXPECT_GE(count, 4u);
    EXPECT_TRUE(m_report.m_limited);
    EXPECT_NEAR(deepest()->m_gap, -0.01, 1e-9);
}

TEST_F(ContactFinderTest, ShapesWithoutSupportAreReported)
{
    btEmptyShape empty;
    m_ground.setCollisionShape(&empty);
    EXPECT_TRUE(find(m_ground).empty());
    EXPECT_TRUE(m_report.m_unknownShape);
}

// Every third body also stands on a triangle mesh, which several threads may not query concurrently.
TEST_F(ContactFinderTest, ThreadedSearchEqualsSearchBodyByBody)
{
    const ConcaveShape sheet = makeTriangleMesh();
    btBoxShape box(btVector3(1, 1, 1));
    btCollisionObject meshObject;
    meshObject.setCollisionShape(&sheet.shape());
    m_ball.setCollisionShape(&box);
    m_ball.getWorldTransform().setOrigin(btVector3(btScalar(1.5), btScalar(0.5), btScalar(-0.5)));
    constexpr int kCount = 50;
    std::vector<std::unique_ptr<TestBox>> boxes;
    std::vector<std::unique_ptr<FemSoftBody>> fems;
    std::vector<FemSoftBody*> bodies;
    for (int b = 0; b < kCount; ++b)
    {
        boxes.push_back(std::make_unique<TestBox>(Vec3{0.02 * b, 0, 0}));
        boxes.back()->m_body->m_worldInfo = &m_info;
        fems.push_back(std::make_unique<FemSoftBody>(*boxes.back()->m_body, m_fem.m_body.m_model, m_fem.m_compliance));
        bodies.push_back(fems.back().get());
        for (const btCollisionObject* object : {&m_ball, &m_ground, &meshObject})
            if (object != &meshObject || b % 3 == 0) recordOverlap(*bodies.back(), *object);
        solveFreeMotion(bodies.back()->m_body, StepSettings());
    }
    Threads threads(3);
    RigidSearch search(threads);
    search.find(bodies, kStep, 1000, m_rigidProxies);
    ASSERT_EQ(search.reports().size(), bodies.size());
    for (int b = 0; b < kCount; ++b)
    {
        const std::vector<ContactPoint> together = bodies[b]->m_memory.m_contacts;
        m_rigidProxies.clear();
        m_search.find({bodies[b]}, kStep, 1000, m_rigidProxies);
        const std::vector<ContactPoint>& alone = bodies[b]->m_memory.m_contacts;
        EXPECT_GE(alone.size(), b % 3 == 0 ? 18u : 9u);
        ASSERT_EQ(together.size(), alone.size());
        for (std::size_t k = 0; k < alone.size(); ++k)
        {
            EXPECT_EQ(together[k].m_soft.m_body, b);
            EXPECT_EQ(together[k].m_gap, alone[k].m_gap);
            EXPECT_EQ(norm(together[k].m_point - alone[k].m_point), 0);
        }
    }
}

/// A shape at the address of one that reported triangles, and reports none.
struct EmptiedSheet : OwnSheet
{
    using OwnSheet::OwnSheet;
    void processAllTriangles(btTriangleCallback* visitor, const btVector3& low, const btVector3& high) const override
    {
        if (!m_isEmpty) OwnSheet::processAllTriangles(visitor, low, high);
    }
    bool m_isEmpty = false;
};

TEST_F(ContactFinderTest, OwnShapesAreAskedForTrianglesAgainAfterAStepWithoutThem)
{
    btTriangleMesh mesh;
    mesh.addTriangle(btVector3(-1, -1, 0), btVector3(1, -1, 0), btVector3(0, 1, 0));
    EmptiedSheet sheet(mesh);
    m_ground.setCollisionShape(&sheet);
    find(m_ground);
    EXPECT_FALSE(m_report.m_unknownShape);
    sheet.m_isEmpty = true;
    m_search.beginStep();
    m_search.beginStep();
    find(m_ground);
    EXPECT_TRUE(m_report.m_unknownShape);
}

TEST_F(ContactFinderTest, ObjectsRecordedByManyThreadsAreFoundOnce)
{
    std::vector<btCollisionObject> objects(16);
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t)
        threads.emplace_back(
            [&]
            {
                for (const btCollisionObject& object : objects) recordOverlap(m_fem, object);
            });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(m_fem.m_overlaps.m_rigid.size(), objects.size());
    m_fem.m_overlaps.m_rigid.clear();
}

}  // namespace
}  // namespace bullet_fem
