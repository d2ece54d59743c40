// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/soft/soft_pair_memory.h"

#include <gtest/gtest.h>

#include <vector>

namespace bullet_fem
{
namespace
{

struct Given
{
    int m_first, m_second, m_feature;
};

// Remembers one contact for each entry, with its index as gap, and begins the next step.
void remember(SoftPairMemory& memory, const std::vector<Given>& given)
{
    std::vector<ContactPoint> contacts(given.size());
    std::vector<SoftPairOrigin> origins(given.size());
    for (std::size_t k = 0; k < given.size(); ++k)
    {
        contacts[k].m_gap = static_cast<double>(k);
        origins[k].m_firstId = given[k].m_first;
        origins[k].m_secondId = given[k].m_second;
        origins[k].m_feature = given[k].m_feature;
    }
    memory.remember({contacts.data(), origins.data(), contacts.size()});
    memory.beginStep();
}

std::vector<double> gapsOf(const SoftPairMemory::Last& last)
{
    std::vector<double> gaps;
    for (std::size_t k = 0; k < last.m_count; ++k) gaps.push_back(last.m_contacts[k].m_gap);
    return gaps;
}

using Gaps = std::vector<double>;

// Contacts come in any order; those of one origin keep their order. The step before the last is forgotten.
TEST(SoftPairMemory, HasTheContactsOfAPairInTheOrderOfTheirOrigins)
{
    SoftPairMemory memory;
    remember(memory, {{1, 2, 4}, {1, 2, 7}, {1, 2, 7}, {1, 3, 0}, {2, 3, 5}});
    EXPECT_EQ(gapsOf(memory.last()), (Gaps{0, 1, 2, 3, 4}));
    EXPECT_EQ(gapsOf(memory.lastOf(1, 2)), (Gaps{0, 1, 2}));
    EXPECT_EQ(gapsOf(memory.lastOf(2, 3)), (Gaps{4}));

    remember(memory, {{2, 3, 5}, {1, 2, 7}, {1, 2, 4}, {1, 2, 7}});
    EXPECT_EQ(gapsOf(memory.last()), (Gaps{2, 1, 3, 0}));
    EXPECT_EQ(gapsOf(memory.lastOf(1, 2)), (Gaps{2, 1, 3}));
    EXPECT_EQ(gapsOf(memory.lastOf(1, 3)), Gaps{});

    remember(memory, {{1, 3, 1}});
    EXPECT_EQ(gapsOf(memory.last()), Gaps{0});
    memory.beginStep();
    EXPECT_EQ(gapsOf(memory.last()), Gaps{});
}

}  // namespace
}  // namespace bullet_fem
