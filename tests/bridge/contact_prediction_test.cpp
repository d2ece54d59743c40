// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/soft/contact_prediction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bridge/bridge_test_bodies.h"
#include "bullet_bridge/rigid/rigid_proxies.h"
#include "bullet_fem/fem/common/threads.h"

namespace bullet_fem
{
namespace
{

constexpr double kStep = 1.0 / 60, kGravity = 9.81;

// A cube, 1 kg a node, under gravity, in contact with rigid and soft bodies.
class ContactPredictionTest : public testing::Test
{
protected:
    ContactPredictionTest()
    {
        for (Vec3& f : m_fem.m_body.m_loads.m_force) f = {0, 0, -kGravity};
        m_weight = kStep * kGravity * double(m_fem.m_body.m_state.m_mass.size());
    }

    void rest(double share)
    {
        m_fem.m_memory.m_contacts.assign(1, ContactPoint());
        m_fem.m_memory.m_contacts[0].m_impulse = {0, 0, share * m_weight};
    }

    // Rests on another soft body.
    void restOnSoft(SoftPairKind kind, double impulse)
    {
        ContactPoint contact;
        contact.m_impulse = {0, 0, impulse};
        SoftPairOrigin origin;
        origin.m_firstId = broadphaseId(*m_box.m_body);
        origin.m_secondId = origin.m_firstId + 1;
        origin.m_kind = kind;
        m_memory.remember({&contact, &origin, 1});
        m_memory.beginStep();
        m_fem.m_memory.m_place.note(m_fem.m_surface.position());
    }

    bool isSteady()
    {
        ContactPrediction steady;
        steady.sumImpulses({&m_fem}, m_memory, Threads());
        ContactPrediction::accept(m_fem, kStep);
        return !m_fem.m_memory.m_predicted.empty();
    }

    TestBox m_box;
    FemSoftBody m_fem = makeFemSoftBody(*m_box.m_body);
    SoftPairMemory m_memory;
    double m_weight = 0;  // times the step [N s]
};

TEST_F(ContactPredictionTest, BodyWithoutContactIsNotSteady)
{
    EXPECT_FALSE(isSteady());
}

TEST_F(ContactPredictionTest, SupportedBodyIsSteady)
{
    rest(1);
    EXPECT_TRUE(isSteady());
}

// A quarter of the band, 1.25 % of an edge of .6 m, is 7.5 mm a step: gravity alone is 2.7 mm.
TEST_F(ContactPredictionTest, OverloadedBodyIsNotSteady)
{
    rest(3);
    EXPECT_TRUE(isSteady());
    rest(4.5);
    EXPECT_FALSE(isSteady());
    rest(0.1);
    for (Vec3& f : m_fem.m_body.m_loads.m_force) f = {0, 0, -4 * kGravity};
    EXPECT_FALSE(isSteady());
}

TEST_F(ContactPredictionTest, BodyCarriedBySoftBodiesIsSteady)
{
    for (Vec3& f : m_fem.m_body.m_loads.m_force) f = {0, 0, -10 * kGravity};
    restOnSoft(SoftPairKind::edges, 10 * m_weight);
    EXPECT_TRUE(isSteady());
    restOnSoft(SoftPairKind::nodeOfSecond, -10 * m_weight);  // the impulses act on the second body
    EXPECT_TRUE(isSteady());
    restOnSoft(SoftPairKind::nodeOfSecond, 10 * m_weight);
    EXPECT_FALSE(isSteady());
}

TEST_F(ContactPredictionTest, RigidlyMovingBodyIsSteady)
{
    rest(1);
    for (Vec3& v : m_fem.m_body.m_state.m_v) v = {20, -10, 3};
    EXPECT_TRUE(isSteady());
    m_fem.m_body.m_state.m_v[5].x += 1;
    EXPECT_FALSE(isSteady());
}

// A jammed body: its motion depends on small differences of large impulses.
TEST_F(ContactPredictionTest, BodyCarryingManyTimesItsLoadsIsNotSteady)
{
    m_fem.m_memory.m_contacts.assign(3, ContactPoint());
    m_fem.m_memory.m_contacts[0].m_impulse = {0, 0, m_weight};
    m_fem.m_memory.m_contacts[1].m_soft.m_nodes = {1, 1, 1};
    m_fem.m_memory.m_contacts[1].m_impulse = {14 * m_weight, 0, 0};
    m_fem.m_memory.m_contacts[2].m_soft.m_nodes = {2, 2, 2};
    m_fem.m_memory.m_contacts[2].m_impulse = {-14 * m_weight, 0, 0};
    EXPECT_TRUE(isSteady());
    m_fem.m_memory.m_contacts[1].m_impulse.x = 15 * m_weight;
    m_fem.m_memory.m_contacts[2].m_impulse.x = -15 * m_weight;
    EXPECT_FALSE(isSteady());
}

TEST_F(ContactPredictionTest, PredictsNodeImpulsesOfTheLastStep)
{
    rest(0.5);
    m_fem.m_memory.m_contacts[0].m_soft.m_nodes = {3, 4, 3};
    m_fem.m_memory.m_contacts[0].m_soft.m_weights = {0.5, 0.3, 0.2};
    restOnSoft(SoftPairKind::nodeOfSecond, -0.5 * m_weight);
    ASSERT_TRUE(isSteady());
    Vec3 sum;
    for (const Vec3& impulse : m_fem.m_memory.m_predicted) sum += impulse;
    EXPECT_NEAR(sum.z, m_weight, 1e-12);
    EXPECT_NEAR(m_fem.m_memory.m_predicted[3].z, 0.35 * m_weight, 1e-12);
    EXPECT_NEAR(m_fem.m_memory.m_predicted[4].z, 0.15 * m_weight, 1e-12);
    EXPECT_NEAR(m_fem.m_memory.m_predicted[0].z, 0.5 * m_weight, 1e-12);
}

// The state after a new attachment or a new setup, when contacts may belong to other nodes.
TEST_F(ContactPredictionTest, BodyWithForgottenPlaceIsNotCarriedBySoftBodies)
{
    restOnSoft(SoftPairKind::edges, m_weight);
    ASSERT_TRUE(isSteady());
    m_fem.m_memory.m_place.forget();
    EXPECT_FALSE(isSteady());
}

TEST_F(ContactPredictionTest, BodyWithNonFiniteVelocitiesIsNotSteady)
{
    rest(1);
    m_fem.m_body.m_state.m_v[5].x = std::nan("");
    EXPECT_FALSE(isSteady());
}

}  // namespace
}  // namespace bullet_fem
