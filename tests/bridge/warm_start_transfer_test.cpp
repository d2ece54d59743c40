// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/warm_start_transfer.h"

#include <gtest/gtest.h>

namespace bullet_fem
{
namespace
{

const Vec3 kUp = {0, 0, 1};

ContactPoint contactAt(double x, double impulse, const Vec3& normal = kUp)
{
    ContactPoint contact;
    contact.m_point = {x, 0, 0};
    contact.m_normal = normal;
    contact.m_impulse = impulse * normal;
    return contact;
}

TEST(WarmStartTransfer, NearestContactWithoutAnImpulseReceivesIt)
{
    ContactPoint rich = contactAt(0.1, 5), near = contactAt(0.3, 0), far = contactAt(0.4, 0);
    WarmStartTransfer candidates;
    candidates.addLost({0.1, 0, 0}, kUp, {0, 0, 2});
    for (ContactPoint* contact : {&rich, &far, &near}) candidates.addCandidate(*contact, 1);
    candidates.assign(1);
    EXPECT_EQ(near.m_impulse.z, 2);
    EXPECT_EQ(far.m_impulse.z, 0);
    EXPECT_EQ(rich.m_impulse.z, 5);
}

TEST(WarmStartTransfer, NearestContactReceivesTheSumIfAllHaveImpulses)
{
    ContactPoint near = contactAt(0.1, 5), far = contactAt(0.4, 3);
    WarmStartTransfer candidates;
    candidates.addLost({0, 0, 0}, kUp, {0.5, 0, 2});
    candidates.addCandidate(far, 1);
    candidates.addCandidate(near, 1);
    candidates.assign(1);
    EXPECT_EQ(near.m_impulse.z, 7);
    EXPECT_EQ(near.m_impulse.x, 0.5);
    EXPECT_EQ(far.m_impulse.z, 3);
}

TEST(WarmStartTransfer, ClosedContactsPrecedeNearerOpenOnes)
{
    ContactPoint apart = contactAt(0.1, 0), touching = contactAt(0.4, 0), sunk = contactAt(0.5, 0);
    apart.m_gap = 0.02;
    sunk.m_gap = -0.02;
    WarmStartTransfer candidates;
    candidates.addLost({0, 0, 0}, kUp, {0, 0, 2});
    for (ContactPoint* contact : {&apart, &touching, &sunk}) candidates.addCandidate(*contact, 1);
    candidates.assign(1);
    EXPECT_EQ(touching.m_impulse.z, 2);
    EXPECT_EQ(apart.m_impulse.z, 0);
    EXPECT_EQ(sunk.m_impulse.z, 0);
}

TEST(WarmStartTransfer, TwoLostContactsPassToTwoNewOnes)
{
    ContactPoint near = contactAt(0.1, 0), far = contactAt(0.2, 0);
    WarmStartTransfer candidates;
    candidates.addLost({0, 0, 0}, kUp, {0, 0, 2});
    candidates.addLost({0, 0, 0}, kUp, {0, 0, 3});
    candidates.addCandidate(far, 1);
    candidates.addCandidate(near, 1);
    candidates.assign(1);
    EXPECT_EQ(near.m_impulse.z, 2);
    EXPECT_EQ(far.m_impulse.z, 3);
}

TEST(WarmStartTransfer, ContactsOutOfReachOrOfOtherNormalReceiveNothing)
{
    ContactPoint far = contactAt(1, 0), turned = contactAt(0, 0, {1, 0, 0}), opposite = contactAt(0, 0, {0, 0, -1});
    WarmStartTransfer candidates;
    candidates.addLost({0, 0, 0}, kUp, {0, 0, 2});
    for (ContactPoint* contact : {&far, &turned, &opposite}) candidates.addCandidate(*contact, 1);
    candidates.assign(1);
    for (const ContactPoint* contact : {&far, &turned, &opposite})
        EXPECT_EQ(dot(contact->m_impulse, contact->m_impulse), 0);
}

TEST(WarmStartTransfer, OppositeSideContactReceivesTheOppositeImpulse)
{
    ContactPoint candidate = contactAt(0, 0, {0, 0, -1});
    WarmStartTransfer candidates;
    candidates.addLost({0, 0, 0}, kUp, {0.5, 0, 2});
    candidates.addCandidate(candidate, -1);
    candidates.assign(1);
    EXPECT_EQ(candidate.m_impulse.z, -2);
    EXPECT_EQ(candidate.m_impulse.x, -0.5);
}

TEST(WarmStartTransfer, ImpulseIsTransferredOnce)
{
    ContactPoint candidate = contactAt(0, 0);
    WarmStartTransfer candidates;
    candidates.addLost({0, 0, 0}, kUp, {0, 0, 2});
    candidates.clear(1);
    candidates.addCandidate(candidate, 1);
    candidates.assign(1);
    EXPECT_EQ(candidate.m_impulse.z, 0);
}

}  // namespace
}  // namespace bullet_fem
