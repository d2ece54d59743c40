// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include "bridge/soft_pair_bodies.h"
#include "support/allocation_counter.h"

namespace bullet_fem
{
namespace
{

// A search that finds fewer contacts than the one before allocates nothing.
TEST(SoftPairAllocation, NothingIsAllocatedOnceTheListsHaveGrown)
{
    PairBody upper(makeBox({1, 1, 1}, {4, 4, 4})), lower(makeSphere(1, 6));
    upper.turn(testRotation(0.3, 0.2, 0.1)).move({-0.5, -0.5, 0.6}).throwAt({0, 0, -1});
    PairContacts found(upper, lower);
    ASSERT_GT(found.m_contacts.size(), 10u);
    found.m_memory.remember(found.solved());
    found.m_memory.beginStep();
    upper.move({0, 0, 0.3});
    found.m_contacts.clear();
    found.m_origins.clear();
    const SoftPairSide first = {upper.m_fem, 0}, second = {lower.m_fem, 1};
    found.m_finder.find(second, second, 1000, found.m_contacts, found.m_origins);
    const AllocationCounter allocations;
    upper.ready();
    lower.ready();
    found.m_finder.find(first, second, 1000, found.m_contacts, found.m_origins);
    found.m_finder.find(second, second, 1000, found.m_contacts, found.m_origins);
    found.m_memory.remember(found.solved());
    found.m_memory.beginStep();
    EXPECT_EQ(allocations.count(), 0);
    EXPECT_FALSE(found.m_contacts.empty());
}

}  // namespace
}  // namespace bullet_fem
