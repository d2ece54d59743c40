// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/tunnelling_scene.h"

/// Rigid bodies between soft ones and the objects of Bullet's own contacts: in staggered and in monolithic coupling.
namespace bullet_fem
{
namespace
{

constexpr double kRadius = 0.09;  // of rigid balls; soft ones are half a centimetre larger [m]
// The median over steps; impacts of rigid bodies are deeper for a while. Piles depend on rounding, and their depths are
// .1 to 3.9 mm, for any damping of the steps [m].
constexpr double kDeepest = 5e-3;

double medianOf(std::vector<double> values)
{
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

class Squeezed : public testing::TestWithParam<Coupling>
{
protected:
    FastScene m_scene{GetParam(), kGravity};

    btRigidBody& addBall(double x, double y, double z)
    {
        RigidSettings settings;
        settings.m_mass = btScalar(3);
        settings.m_transform = at(btScalar(x), btScalar(y), btScalar(z));
        return m_scene.m_world.addRigid(new btSphereShape(btScalar(kRadius)), settings);
    }

    /// A static wall at this distance from the origin, facing it [m].
    void addWall(double distance, const btVector3& towards)
    {
        RigidSettings settings;
        settings.m_transform.setOrigin(btScalar(distance + 1) * towards);
        m_scene.m_world.addRigid(new btBoxShape(btVector3(3, 3, 3) - 2 * towards.absolute()), settings);
    }

    btSoftBody& addSoftBall(double x, double y, double z, const btVector3& velocity)
    {
        btSoftBody& body = m_scene.addSoft(makeSphere(0.095, 4), 2e5);
        body.translate(btVector3(btScalar(x), btScalar(y), btScalar(z)));
        body.setVelocity(velocity);
        return body;
    }

    /// Maximum depth of rigid bodies in soft ones [m].
    double depth(const std::vector<btSoftBody*>& bodies) const
    {
        double deepest = 0;
        for (const btSoftBody* body : bodies)
        {
            const btAlignedObjectArray<btFemContact>& contacts = m_scene.m_fem.contacts(body);
            for (int k = 0; k < contacts.size(); ++k)
                if (!btSoftBody::upcast(contacts[k].m_other)) deepest = std::max(deepest, -double(contacts[k].m_gap));
        }
        return deepest;
    }
};

}  // namespace

// Balls fall in four columns, every third one rigid.
TEST_P(Squeezed, BallsInAPitStayOutOfWallsAndOfEachOther)
{
    const double half = 0.25;
    m_scene.m_world.addFloorBox();
    for (const int side : {-1, 1})
    {
        addWall(half, btVector3(btScalar(side), 0, 0));
        addWall(half, btVector3(0, btScalar(side), 0));
    }
    std::vector<btRigidBody*> rigid;
    std::vector<btSoftBody*> soft;
    for (int k = 0; k < 16; ++k)
    {
        const double x = 0.13 * (k % 2 == 0 ? -1 : 1) + 0.005 * (k % 5),
                     y = 0.13 * (k / 2 % 2 == 0 ? -1 : 1) + 0.004 * (k % 7);
        const double z = 0.13 + 0.25 * (k / 4);
        if (k % 3 == 0)
            rigid.push_back(&addBall(x, y, z));
        else
            soft.push_back(&addSoftBall(x, y, z, btVector3(0, 0, 0)));
    }
    std::vector<double> outsides, overlaps, depths;
    for (int k = 0; k < 120; ++k)
    {
        m_scene.m_world.step();
        if (k < 60) continue;
        double outside = 0, overlap = 0;
        for (const btRigidBody* ball : rigid)
        {
            const btVector3& x = ball->getCenterOfMassPosition();
            const double most = std::max<double>({std::fabs(x.x()) - half, std::fabs(x.y()) - half, -x.z()});
            outside = std::max(outside, most + kRadius);
            for (const btRigidBody* other : rigid)
                if (other != ball)
                    overlap = std::max(overlap, 2 * kRadius - double((x - other->getCenterOfMassPosition()).length()));
        }
        outsides.push_back(outside);
        overlaps.push_back(overlap);
        depths.push_back(depth(soft));
    }
    EXPECT_LT(medianOf(outsides), kDeepest);
    EXPECT_LT(medianOf(overlaps), kDeepest);
    EXPECT_LT(medianOf(depths), kDeepest);
}

TEST_P(Squeezed, ABallOnAnotherStaysOutOfIt)
{
    m_scene.m_world.addFloorBox();
    for (const int side : {-1, 1})
    {
        addWall(0.1, btVector3(btScalar(side), 0, 0));
        addWall(0.1, btVector3(0, btScalar(side), 0));
    }
    const btRigidBody& lower = addBall(-0.01, 0, kRadius);
    const btRigidBody& upper = addBall(0.01, 0, 3 * kRadius);
    std::vector<btSoftBody*> soft;
    for (int k = 0; k < 5; ++k) soft.push_back(&addSoftBall(0, 0, 0.48 + 0.21 * k, btVector3(0, 0, -3)));
    std::vector<double> overlaps, depths, heights;
    for (int k = 0; k < 120; ++k)
    {
        m_scene.m_world.step();
        if (k < 60) continue;
        const btVector3 apart = upper.getCenterOfMassPosition() - lower.getCenterOfMassPosition();
        overlaps.push_back(2 * kRadius - double(apart.length()));
        heights.push_back(lower.getCenterOfMassPosition().z());
        depths.push_back(depth(soft));
    }
    EXPECT_LT(medianOf(overlaps), kDeepest);
    EXPECT_GT(medianOf(heights), kRadius - kDeepest);
    EXPECT_LT(medianOf(depths), kDeepest);
}

// The support behind it counts, but is no static wall: nothing gains energy.
TEST_P(Squeezed, FreeBallInContactWithAnotherYieldsWithIt)
{
    m_scene.m_world.bullet().setGravity(btVector3(0, 0, 0));
    m_scene.m_world.setSoftGravity(btVector3(0, 0, 0));
    for (int k = 0; k < 3; ++k) addBall(0, 0, -2 * kRadius * k);
    btSoftBody& soft = addSoftBall(0, 0, 0.2, btVector3(0, 0, -3));
    const auto sum = [&]
    {
        Motion all = motionOf(soft);
        for (int k = 0; k < m_scene.m_world.bullet().getNumCollisionObjects(); ++k)
            if (const auto* body = btRigidBody::upcast(m_scene.m_world.bullet().getCollisionObjectArray()[k]))
                all += motionOf(*body);
        return all;
    };
    m_scene.m_world.step();
    const Motion before = sum();
    m_scene.m_world.step(60);
    const Motion after = sum();
    EXPECT_NEAR(after.m_linear.z, before.m_linear.z, 1e-5 * std::fabs(before.m_linear.z));
    EXPECT_LT(after.m_energy, before.m_energy);
    EXPECT_GT(velocityOf(soft).z, -2) << "they were in contact";
}

INSTANTIATE_TEST_SUITE_P(Contact, Squeezed, testing::Values(Coupling::swap, Coupling::coupled),
                         [](const auto& coupling) { return couplingName(coupling.param); });

}  // namespace bullet_fem
