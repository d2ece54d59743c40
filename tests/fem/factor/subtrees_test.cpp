// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/factor/subtrees.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "fem/factor/rest_factor.h"
#include "fem/scenes/elasticity_scenes.h"

namespace bullet_fem
{
namespace
{

std::shared_ptr<const BodyModel> cube(int cells)
{
    return makeBody(makeBox({1, 1, 1}, {cells, cells, cells}), elasticMaterial(1e4, 0.3)).m_model;
}

class Division : public testing::Test
{
protected:
    const std::shared_ptr<const BodyModel> m_model = cube(10);
    const PackedFactor& m_packed = m_model->factor().lower();
    const SupernodeTree& m_tree = m_packed.tree();
    const TreeDivision m_division{m_tree};
};

TEST_F(Division, HasEverySupernodeOnce)
{
    std::vector<int> all = m_division.m_top;
    for (const Subtree& subtree : m_division.m_subtrees)
        for (int s = subtree.m_begin; s < subtree.m_end; ++s) all.push_back(s);
    std::sort(all.begin(), all.end());
    EXPECT_EQ(all, m_packed.allSupernodes());
    EXPECT_GE(m_division.m_subtrees.size(), 3u);
}

TEST_F(Division, SubtreesAreRootsWithAllTheirDescendants)
{
    for (const Subtree& subtree : m_division.m_subtrees)
        for (int s = 0; s < static_cast<int>(m_tree.m_supernodes.size()); ++s)
        {
            const bool inside = s >= subtree.m_begin && s < subtree.m_end;
            const int parent = m_tree.m_supernodes[s].m_parent;
            const bool parentInside = parent >= subtree.m_begin && parent < subtree.m_end;
            EXPECT_EQ(parentInside, inside && s != subtree.m_end - 1) << s;
        }
}

// A subtree's own rows above it are in the order of the rows that they stand for, and no two subtrees share one.
TEST_F(Division, SubtreesHaveTheirOwnRowsAbove)
{
    int next = m_tree.m_nodeCount;
    for (const Subtree& subtree : m_division.m_subtrees)
    {
        const Supernode& root = m_tree.m_supernodes[subtree.m_end - 1];
        const int columnsEnd = root.m_first + root.m_columns;
        for (int s = subtree.m_begin; s < subtree.m_end; ++s)
            for (int k = 0; k < m_tree.m_supernodes[s].m_rows; ++k)
            {
                const int place = m_tree.m_supernodes[s].m_rowStart + k, row = m_tree.m_row[place];
                const int own = m_division.m_forwardRow[place] - subtree.m_firstAbove;
                if (row < columnsEnd)
                    ASSERT_EQ(m_division.m_forwardRow[place], row);
                else
                    ASSERT_EQ(m_tree.m_row[root.m_rowStart + own], row);
            }
        next += root.m_rows;
    }
    EXPECT_EQ(m_division.m_rowCount, next);
    std::set<int> starts;
    for (const Subtree& subtree : m_division.m_subtrees) starts.insert(subtree.m_firstAbove);
    EXPECT_EQ(starts.size(), m_division.m_subtrees.size());
}

TEST(SmallDivision, IsAllTop)
{
    const std::shared_ptr<const BodyModel> model = cube(3);
    const TreeDivision division(model->factor().lower().tree());
    EXPECT_TRUE(division.m_subtrees.empty());
    EXPECT_EQ(division.m_top, model->factor().lower().allSupernodes());
    EXPECT_EQ(division.m_rowCount, model->factor().freeNodeCount());
}

TEST(SmallDivision, IsEmptyForAnEmptyTree)
{
    const TreeDivision division{SupernodeTree()};
    EXPECT_TRUE(division.m_top.empty());
    EXPECT_EQ(division.m_rowCount, 0);
}

// The sixteen-wide solve does not use the division.
TEST_F(Division, SolvesLikeTheWhole)
{
    const int size = m_packed.size();
    AlignedFloats one = allocateFloats(m_packed.vectorSize()), scratch = allocateFloats(m_packed.scratchSize());
    AlignedFloats lanes = allocateFloats(static_cast<std::size_t>(size) * kPanelLanes),
                  laneScratch = allocateFloats(m_packed.laneScratchSize());
    std::fill(one.get(), one.get() + m_packed.vectorSize(), 1e30f);  // memory behind the vector does not matter
    RandomVectors random(5);
    for (int i = 0; i < size; ++i)
    {
        one[i] = static_cast<float>(random.next().x);
        for (int l = 0; l < kPanelLanes; ++l) lanes[static_cast<std::size_t>(i) * kPanelLanes + l] = one[i];
    }
    m_packed.solve(one.get(), scratch.get());
    m_packed.solveLanes(m_packed.allSupernodes(), m_packed.allSupernodes(), lanes.get(), laneScratch.get());
    double error = 0, norm = 0;
    for (int i = 0; i < size; ++i)
    {
        const double expected = lanes[static_cast<std::size_t>(i) * kPanelLanes];
        error += (one[i] - expected) * (one[i] - expected);
        norm += expected * expected;
    }
    EXPECT_LE(std::sqrt(error / norm), 1e-5);  // 6e-8 of single precision times a condition of some 100
}

}  // namespace
}  // namespace bullet_fem
