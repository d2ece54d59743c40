// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemVectors.h"
#include "plugin/scenes/each_world.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"

namespace bullet_fem
{
namespace
{

btSoftBody& addCube(SoftWorld& world, btScalar lowest)
{
    return addUnitCube(world, btVector3(0, 0, lowest + btScalar(0.5)));
}

/// A cube that rests on two static boxes, one under each half.
class CubeOnTwoBoxes : public EachWorld
{
protected:
    void SetUp() override
    {
        RigidSettings settings;
        for (const int k : {0, 1})
        {
            settings.m_transform = at(k == 0 ? btScalar(-1.1) : btScalar(1.1), 0, -1);
            m_ground[k] = &m_world.addRigid(new btBoxShape(btVector3(1, 1, 1)), settings);
        }
        m_cube = &addCube(m_world, btScalar(0.001));
        m_world.step(240);
    }

    FemWorld m_world{GetParam()};
    btFemSoftBodySolver& m_fem = m_world.fem();
    btRigidBody* m_ground[2];
    btSoftBody* m_cube;
};

INSTANTIATE_TEST_SUITE_P(Worlds, CubeOnTwoBoxes, eachWorld(), nameOfWorld);

TEST_P(CubeOnTwoBoxes, ContactForceIsThatOfEachOfThem)
{
    const double weight = massOf(*m_cube) * kGravity;
    Vec3 mean[2], torque;  // about the cube's centre: how two supports share a weight is open, their torques are not
    for (int frame = 0; frame < 60; ++frame)
    {
        m_world.step();
        for (const int k : {0, 1})
        {
            mean[k] += (1.0 / 60) * vec3(m_fem.contactForce(m_cube, m_ground[k]));
            const Vec3 impulse = impulseOn(m_fem, *m_cube, m_ground[k]);
            EXPECT_LT(norm((1 / double(kStep)) * impulse - vec3(m_fem.contactForce(m_cube, m_ground[k]))),
                      1e-4 * weight);
        }
        const auto& contacts = m_fem.contacts(m_cube);
        for (int k = 0; k < contacts.size(); ++k)
            torque +=
                (1.0 / 60 / kStep) * cross(vec3(contacts[k].m_point) - centerOf(*m_cube), vec3(contacts[k].m_impulse));
    }
    EXPECT_NEAR(mean[0].z, weight / 2, 0.15 * weight);
    EXPECT_NEAR(mean[1].z, weight / 2, 0.15 * weight);
    EXPECT_LT(norm(mean[0] + mean[1] - Vec3{0, 0, weight}), 1e-4 * weight);
    EXPECT_LT(norm(torque), 1e-4 * weight);  // the cube is 1 m wide
}

TEST_P(CubeOnTwoBoxes, ContactsNamePlaceAndObject)
{
    const btAlignedObjectArray<btFemContact>& contacts = m_fem.contacts(m_cube);
    ASSERT_GT(contacts.size(), 0);
    EXPECT_EQ(m_fem.stepReport(m_cube).m_contacts, contacts.size());
    for (int k = 0; k < contacts.size(); ++k)
    {
        const btFemContact& c = contacts[k];
        EXPECT_TRUE(c.m_other == m_ground[0] || c.m_other == m_ground[1]);
        EXPECT_EQ(c.m_other == m_ground[1], c.m_point.x() > 0);
        EXPECT_NEAR(c.m_point.z(), 0, 0.01);
        EXPECT_NEAR(c.m_normal.length(), 1, 1e-5);
        EXPECT_GT(c.m_normal.z(), 0.9);
        EXPECT_GE(c.m_impulse.dot(c.m_normal), -1e-6);
        EXPECT_NEAR(c.m_weights[0] + c.m_weights[1] + c.m_weights[2], 1, 1e-5);
        Vec3 point;
        for (int a = 0; a < 3; ++a)
        {
            ASSERT_GE(c.m_nodes[a], 0);
            ASSERT_LT(c.m_nodes[a], m_cube->m_nodes.size());
            point += double(c.m_weights[a]) * vec3(m_cube->m_nodes[c.m_nodes[a]].m_q);  // at the start of the step
        }
        EXPECT_LT(norm(point - vec3(c.m_point)), 1e-5);
        const btScalar friction = (c.m_impulse - c.m_impulse.dot(c.m_normal) * c.m_normal).length();
        EXPECT_LE(friction, m_cube->m_cfg.kDF * c.m_other->getFriction() * c.m_impulse.dot(c.m_normal) * 1.0001 + 1e-6);
    }
}

TEST_P(CubeOnTwoBoxes, TheReportHasEveryField)
{
    const btFemStepReport& report = m_fem.stepReport(m_cube);
    EXPECT_EQ(report.m_flags, 0);
    EXPECT_STREQ(report.m_message, "");
    EXPECT_EQ(report.m_nodes, m_cube->m_nodes.size());
    EXPECT_EQ(report.m_tets, m_cube->m_tetras.size());
    EXPECT_LE(report.m_residual, 1e-3);
    EXPECT_GE(report.m_deepestPenetration, 0);
    EXPECT_GT(report.m_factorEntries, 9 * m_cube->m_nodes.size() / 2);
    for (const btScalar cost : {report.m_factorSeconds, report.m_freeMotionMs, report.m_contactMs})
        EXPECT_TRUE(std::isfinite(cost) && cost >= 0) << cost;
    m_cube->addVelocity(btVector3(0, 0, -1));  // at rest contact may need neither a sweep nor an iteration
    m_world.step();
    EXPECT_GT(m_fem.stepReport(m_cube).m_contactSweeps, 0);
    EXPECT_GT(m_fem.stepReport(m_cube).m_contactIterations, 0);
}

TEST_P(CubeOnTwoBoxes, ContactsEndWithSeparation)
{
    m_cube->translate(btVector3(0, 0, 5));
    m_world.step();
    EXPECT_EQ(m_fem.contacts(m_cube).size(), 0);
    EXPECT_EQ(m_fem.stepReport(m_cube).m_contacts, 0);
    EXPECT_EQ(m_fem.stepReport(m_cube).m_contactSweeps, 0);
    EXPECT_EQ(m_fem.contactForce(m_cube, m_ground[0]), btVector3(0, 0, 0));
}

class ContactOffset : public EachWorld
{
};

INSTANTIATE_TEST_SUITE_P(Worlds, ContactOffset, eachWorld(), nameOfWorld);

class ContactFlags : public EachWorld
{
};

INSTANTIATE_TEST_SUITE_P(Worlds, ContactFlags, eachWorld(), nameOfWorld);

TEST_P(ContactOffset, KeepsTheSurfaceAway)
{
    FemWorld world(GetParam());
    btFemSoftBodySolver& fem = world.fem();
    world.addPlane();
    btSoftBody& onPlane = addCube(world, btScalar(0.1));
    fem.setContactOffset(&onPlane, btScalar(0.05));
    world.step(240);
    EXPECT_NEAR(lowestHeight(onPlane), 0.05, 1e-4);
}

struct HardnessCase
{
    double m_mass;      // of the support [kg]; 0: static
    double m_hardness;  // kKHR of static ones, kCHR of others
    double m_share;     // of the penetration, corrected in a step with m_erp = .2
};

class ContactHardness : public EachWorldWith<HardnessCase>
{
};

TEST_P(ContactHardness, IsHowMuchOfAPenetrationAStepTakesBack)
{
    constexpr double kDepth = 0.01;  // less than m_maxPushVelocity corrects in a step
    FemWorld world(worldClass(), btVector3(0, 0, 0));
    world.addRigid(new btBoxShape(btVector3(2, 2, 1)), {btScalar(value().m_mass), at(0, 0, -1)});
    btSoftBody& cube = addCube(world, btScalar(-kDepth));
    (value().m_mass > 0 ? cube.m_cfg.kCHR : cube.m_cfg.kKHR) = static_cast<btScalar>(value().m_hardness);
    world.step();
    // Up to 1e-4 of the size may remain.
    EXPECT_NEAR(lowestHeight(cube), -(1 - value().m_share) * kDepth, 1.1e-4);
}

std::string hardnessName(const HardnessCase& hardness)
{
    return std::string(hardness.m_mass > 0 ? "kCHR" : "kKHR") + std::to_string(int(1000 * hardness.m_hardness));
}

INSTANTIATE_TEST_SUITE_P(Cases, ContactHardness,
                         testing::Combine(eachWorld(),
                                          testing::Values(HardnessCase{0, 0.1, 0.2}, HardnessCase{0, 0.05, 0.1},
                                                          HardnessCase{0, 0, 0}, HardnessCase{0, 1, 1},
                                                          HardnessCase{1e9, 1, 0.2}, HardnessCase{1e9, 0.5, 0.1})),
                         nameOfWorldWith(hardnessName));

TEST_P(ContactFlags, BodiesWithoutContactResponseMakeNoContact)
{
    FemWorld world(GetParam());
    btRigidBody& ghost = world.addFloorBox();
    ghost.setCollisionFlags(ghost.getCollisionFlags() | btCollisionObject::CF_NO_CONTACT_RESPONSE);
    btSoftBody& cube = addCube(world, btScalar(0.01));
    world.step(30);
    EXPECT_NEAR(velocityOf(cube).z, -kGravity * 30 * kStep, 1e-4);
}

TEST_P(ContactFlags, NonCollidingSoftBodiesFallThrough)
{
    FemWorld world(GetParam());
    world.addFloorBox();
    btSoftBody& cube = addCube(world, btScalar(0.01));
    cube.m_cfg.collisions = 0;
    world.step(30);
    EXPECT_NEAR(velocityOf(cube).z, -kGravity * 30 * kStep, 1e-4);
}

TEST(ContactLimit, IsFlaggedAndTheDeepestPointsCarryTheBody)
{
    btFemSolverInfo info;
    info.m_maxContacts = 12;
    btFemSoftBodySolver fem(info);
    SoftWorld world(fem);
    world.addPlane();
    btSoftBody& cube = addCube(world, btScalar(0.001));
    int flags = 0;
    for (int k = 0; k < 120; ++k)
    {
        world.step();
        flags |= fem.stepReport(&cube).m_flags;
        EXPECT_LE(fem.contacts(&cube).size(), 12);
    }
    EXPECT_TRUE(flags & BT_FEM_CONTACT_LIMIT);
    EXPECT_GT(lowestHeight(cube), -0.1);
}

TEST(ContactOverlap, ABodySpawnedInsideIsPushedOutWithoutFlyingOff)
{
    btFemSoftBodySolver fem;
    SoftWorld world(fem);
    world.addFloorBox();
    btSoftBody& cube = addCube(world, btScalar(-0.1));
    double highest = 0;
    for (int k = 0; k < 180; ++k)
    {
        world.step();
        highest = std::max(highest, lowestHeight(cube));
    }
    EXPECT_LT(highest, 0.01);
    EXPECT_GT(lowestHeight(cube), -1e-3);
}

}  // namespace
}  // namespace bullet_fem
