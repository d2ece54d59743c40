// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
// btCollisionWorld's contactTest and contactPairTest with FEM bodies.
#include <gtest/gtest.h>

#include <vector>

#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "plugin/scenes/each_world.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

/// Records the contacts passed to the callback.
struct Told : btCollisionWorld::ContactResultCallback
{
    btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper* a, int, int indexA,
                             const btCollisionObjectWrapper* b, int, int indexB) override
    {
        m_points.push_back(point);
        m_first.push_back(a->getCollisionObject());
        m_second.push_back(b->getCollisionObject());
        m_indices.push_back(a->getCollisionObject()->getInternalType() == btCollisionObject::CO_SOFT_BODY ? indexB
                                                                                                          : indexA);
        return 0;
    }

    std::vector<btManifoldPoint> m_points;
    std::vector<const btCollisionObject*> m_first, m_second;
    std::vector<int> m_indices;
};

/// A cube at rest on a compound, and a sphere on the cube.
class ContactQuery : public EachWorld
{
protected:
    void SetUp() override
    {
        auto* compound = new btCompoundShape;
        for (const btScalar x : {btScalar(-4), btScalar(0)})
            compound->addChildShape(at(x, 0, -1), m_world.keep(new btBoxShape(btVector3(2, 2, 1))));
        m_ground = &m_world.addRigid(compound);
        m_cube = &addCube(btScalar(0.001));
        m_sphere = &m_world.addRigid(new btSphereShape(btScalar(0.1)), {1, at(0, 0, btScalar(0.502))});
        m_world.step(60);
    }

    btSoftBody& addCube(btScalar lowest, btScalar x = 0)
    {
        btSoftBody& cube = addSmallCube(m_world, lowest, x);
        cube.m_cfg.collisions |= btSoftBody::fCollision::VF_SS;
        return cube;
    }

    int pointsWith(const btSoftBody& body, const btCollisionObject* other) const
    {
        int count = 0;
        for (int k = 0; k < m_fem.touches(&body).size(); ++k)
            if (m_fem.touches(&body)[k].m_other == other) count += m_fem.touches(&body)[k].m_points;
        return count;
    }

    FemWorld m_world{GetParam()};
    btFemSoftBodySolver& m_fem = m_world.fem();
    btRigidBody *m_ground, *m_sphere;
    btSoftBody* m_cube;
};

INSTANTIATE_TEST_SUITE_P(Worlds, ContactQuery, eachWorld(), nameOfWorld);

TEST_P(ContactQuery, SoftBodyReportsAllItsContacts)
{
    Told told;
    m_world.bullet().contactTest(m_cube, told);
    const int onGround = pointsWith(*m_cube, m_ground), onSphere = pointsWith(*m_cube, m_sphere);
    EXPECT_GT(onGround, 4);
    EXPECT_GT(onSphere, 0);
    EXPECT_EQ(int(told.m_points.size()), onGround + onSphere);
    for (std::size_t k = 0; k < told.m_points.size(); ++k) EXPECT_EQ(told.m_first[k], m_cube);
}

TEST_P(ContactQuery, RigidBodyReportsTheSoftOne)
{
    Told told;
    m_world.bullet().contactTest(m_sphere, told);
    ASSERT_GT(told.m_points.size(), 0u);
    EXPECT_EQ(int(told.m_points.size()), pointsWith(*m_cube, m_sphere));
    for (std::size_t k = 0; k < told.m_points.size(); ++k)
    {
        EXPECT_EQ(told.m_first[k], m_sphere);
        EXPECT_EQ(told.m_second[k], m_cube);
        const btManifoldPoint& point = told.m_points[k];
        EXPECT_GT(point.m_normalWorldOnB.z(), 0.9);  // from the cube to the sphere above
        EXPECT_NEAR(point.getPositionWorldOnB().z(), 0.4, 0.02);
    }
}

TEST_P(ContactQuery, PairIsTheSameBothWays)
{
    Told there, back;
    m_world.bullet().contactPairTest(m_cube, m_ground, there);
    m_world.bullet().contactPairTest(m_ground, m_cube, back);
    ASSERT_GT(there.m_points.size(), 0u);
    EXPECT_EQ(int(there.m_points.size()), pointsWith(*m_cube, m_ground));
    ASSERT_EQ(back.m_points.size(), there.m_points.size());
    for (std::size_t k = 0; k < there.m_points.size(); ++k)
    {
        const btManifoldPoint &a = there.m_points[k], &b = back.m_points[k];
        EXPECT_GT(a.m_normalWorldOnB.z(), 0.9);
        EXPECT_LT((a.m_normalWorldOnB + b.m_normalWorldOnB).length(), 1e-6);
        EXPECT_LT((a.getPositionWorldOnA() - b.getPositionWorldOnB()).length(), 1e-6);
        EXPECT_LT((a.getPositionWorldOnB() - b.getPositionWorldOnA()).length(), 1e-6);
        EXPECT_EQ(a.getDistance(), b.getDistance());
        EXPECT_NEAR(a.getPositionWorldOnB().z(), 0, 1e-5);  // the ground's top
        EXPECT_EQ(there.m_indices[k], back.m_indices[k]);
    }
}

TEST_P(ContactQuery, SoftBodiesReportTheirContactPoints)
{
    btSoftBody &lower = addCube(btScalar(0.001), 1), &upper = addCube(btScalar(0.402), 1);
    m_world.step(60);
    Told told;
    m_world.bullet().contactPairTest(&upper, &lower, told);
    EXPECT_EQ(int(told.m_points.size()), pointsWith(upper, &lower));
    ASSERT_GT(told.m_points.size(), 0u);
    EXPECT_GT(told.m_points[0].m_normalWorldOnB.z(), 0.9);
    for (const btManifoldPoint& point : told.m_points)
    {
        const btVector3 apart = point.getPositionWorldOnA() - point.getPositionWorldOnB();
        EXPECT_NEAR(apart.dot(point.m_normalWorldOnB), point.getDistance(), 1e-6);
        const btVector3 middle = (point.getPositionWorldOnA() + point.getPositionWorldOnB()) / 2;
        int matches = 0;
        for (int k = 0; k < m_fem.contacts(&upper).size(); ++k)
            matches += (m_fem.contacts(&upper)[k].m_point - middle).length() < 1e-6;
        EXPECT_EQ(matches, 1);
    }
}

TEST_P(ContactQuery, TellsNearPointsWithinTheThresholdOfThePairTest)
{
    m_world.setSoftGravity(btVector3(0, 0, 0));
    btSoftBody& near = addCube(btScalar(0.003), 1);  // 3 mm; the slack is about 1 mm
    m_world.step(2);
    for (const btScalar threshold : {btScalar(0), btScalar(0.005)})
    {
        Told told;
        told.m_closestDistanceThreshold = threshold;
        m_world.bullet().contactPairTest(&near, m_ground, told);
        EXPECT_EQ(told.m_points.empty(), threshold == 0);
    }
}

TEST_P(ContactQuery, TellsNothingOfBodiesApartRemovedOrNew)
{
    btSoftBody& apart = addCube(1, 1);
    m_world.step();
    Told told;
    m_world.bullet().contactTest(&apart, told);
    m_world.bullet().contactPairTest(&apart, m_ground, told);
    btSoftBody& fresh = addCube(btScalar(-0.01), 2);  // not stepped yet
    m_world.bullet().contactPairTest(&fresh, m_ground, told);
    m_world.bullet().contactPairTest(m_ground, &fresh, told);
    m_world.deleteRigid(*m_sphere);
    m_world.bullet().contactTest(m_cube, told);
    EXPECT_GT(told.m_points.size(), 0u);
    EXPECT_EQ(int(told.m_points.size()), pointsWith(*m_cube, m_ground));
}

TEST_P(ContactQuery, SpringBodiesAreLeftToBullet)
{
    btSoftBody& ball = m_world.addSoft(btSoftBodyHelpers::CreateEllipsoid(
        m_world.info(), btVector3(1, 0, btScalar(0.2)), btVector3(0.3, 0.3, 0.3), 64));
    m_world.step();
    Told told;
    m_world.bullet().contactTest(&ball, told);
    m_world.bullet().contactPairTest(m_ground, &ball, told);
    EXPECT_TRUE(told.m_points.empty());
}

}  // namespace
}  // namespace bullet_fem
