// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/factor/panel_group_kernels.h"

#include <gtest/gtest.h>

#include "fem/vector_targets.h"

#include <hwy/targets.h>
#include <cstdint>
#include <tuple>
#include <vector>

#include "fem/aligned_floats.h"
#include "fem/scenes/elasticity_scenes.h"

namespace bullet_fem
{
namespace
{

using GroupCase = std::tuple<std::array<int, 2>, int>;  // nodes of the columns and of the rows below; vectors

// A panel of random entries: columns are nodes 1, 2, ..., rows below are every other node after them.
class PanelGroupKernels : public testing::TestWithParam<GroupCase>
{
protected:
    PanelGroupKernels()
    {
        const int columns = std::get<0>(GetParam())[0], rows = std::get<0>(GetParam())[1];
        for (int k = 0; k < rows; ++k) m_rows.push_back(1 + columns + 2 * k);
        m_panel = {nullptr, m_rows.data(), 1, 3 * columns, 3 * rows};
        m_values = randomFloats(static_cast<std::size_t>(kPanelLanes) * m_panel.blocks() * m_panel.m_columns, 1);
        m_panel.m_values = m_values.get();
        m_size = 3 * (1 + columns + 2 * rows);
    }

    static AlignedFloats randomFloats(std::size_t count, unsigned seed)
    {
        AlignedFloats values = allocateFloats(count);
        RandomVectors random(seed);
        for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<float>(random.next().x);
        return values;
    }

    // Every vector of a group is to have the bits that it has alone, on every instruction set.
    template <class Together, class Alone>
    void compare(const Together& together, const Alone& alone) const
    {
        const std::size_t scratchSize = static_cast<std::size_t>(kPanelLanes) * m_panel.blocks();
        for (const std::int64_t target : hwy::SupportedAndGeneratedTargets())
        {
            hwy::SetSupportedTargetsForTest(target);
            std::vector<AlignedFloats> memory;
            PanelGroup group;
            group.m_count = std::get<1>(GetParam());
            for (int k = 0; k < group.m_count; ++k)
            {
                memory.push_back(randomFloats(m_size, 10 + k));
                memory.push_back(randomFloats(scratchSize, 20 + k));  // what it held does not matter
                group.m_y[k] = memory[2 * k].get();
                group.m_scratch[k] = memory[2 * k + 1].get();
            }
            together(m_panel, group);
            for (int k = 0; k < group.m_count; ++k)
            {
                const AlignedFloats y = randomFloats(m_size, 10 + k), scratch = randomFloats(scratchSize, 30);
                alone(m_panel, y.get(), scratch.get());
                EXPECT_TRUE(std::equal(y.get(), y.get() + m_size, group.m_y[k])) << k << hwy::TargetName(target);
            }
        }
        hwy::SetSupportedTargetsForTest(0);
    }

    Panel m_panel;
    std::vector<int> m_rows;
    AlignedFloats m_values;
    int m_size = 0;
};

TEST_P(PanelGroupKernels, ForwardGivesEveryVectorItsOwnBits)
{
    compare(forwardPanelGroup, forwardPanel);
}

TEST_P(PanelGroupKernels, BackwardGivesEveryVectorItsOwnBits)
{
    compare(backwardPanelGroup, backwardPanel);
}

// All widths of a last chunk, and rows that fill their last block or do not.
const std::array<int, 2> kSizes[] = {{1, 0}, {1, 1}, {2, 5}, {3, 16}, {4, 7}, {5, 11}, {16, 0}, {23, 40}, {30, 3}};
INSTANTIATE_TEST_SUITE_P(SizesAndCounts, PanelGroupKernels,
                         testing::Combine(testing::ValuesIn(kSizes), testing::Range(1, kPanelGroup + 1)));

}  // namespace
}  // namespace bullet_fem
