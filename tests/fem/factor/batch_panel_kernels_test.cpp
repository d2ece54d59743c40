// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/factor/panel_kernels.h"

#include <gtest/gtest.h>

#include "fem/common/vector_targets.h"

#include <hwy/targets.h>
#include <array>
#include <cstdint>
#include <vector>

#include "fem/common/aligned_array.h"
#include "fem/scenes/elasticity_scenes.h"

namespace bullet_fem
{
namespace
{

// A panel of random entries: columns are nodes 1, 2, ..., rows below are every other node after them.
class SidePanelKernels : public testing::TestWithParam<std::array<int, 2>>  // nodes of the columns, of the rows below
{
protected:
    SidePanelKernels()
    {
        const int columns = GetParam()[0], rows = GetParam()[1];
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

    // Each vector has the bits of a single solve, on every instruction set.
    template <class Together, class Alone>
    void compare(const Together& together, const Alone& alone) const
    {
        for (const std::int64_t target : hwy::SupportedAndGeneratedTargets())
        {
            hwy::SetSupportedTargetsForTest(target);
            const AlignedFloats y = randomFloats(static_cast<std::size_t>(m_size) * kPanelLanes, 10);
            const AlignedFloats before = randomFloats(static_cast<std::size_t>(m_size) * kPanelLanes, 10);
            const AlignedFloats scratch = randomFloats(batchScratchOf(m_panel), 20);  // its contents do not matter
            together(m_panel, y.get(), scratch.get());
            for (int lane = 0; lane < kPanelLanes; ++lane)
            {
                const AlignedFloats own = allocateFloats(m_size);
                const AlignedFloats ownScratch =
                    randomFloats(static_cast<std::size_t>(kPanelLanes) * m_panel.blocks(), 30);
                for (int i = 0; i < m_size; ++i) own[i] = before[i * kPanelLanes + lane];
                alone(m_panel, own.get(), ownScratch.get());
                for (int i = 0; i < m_size; ++i)
                    ASSERT_EQ(y[i * kPanelLanes + lane], own[i]) << i << ", " << lane << hwy::TargetName(target);
            }
        }
        hwy::SetSupportedTargetsForTest(0);
    }

    Panel m_panel;
    std::vector<int> m_rows;
    AlignedFloats m_values;
    int m_size = 0;
};

TEST_P(SidePanelKernels, ForwardGivesEveryVectorItsOwnBits)
{
    compare(forwardPanelBatch, forwardPanel);
}

TEST_P(SidePanelKernels, BackwardGivesEveryVectorItsOwnBits)
{
    compare(backwardPanelBatch, backwardPanel);
}

// All widths of a last chunk, with row counts that fill their last block and others that do not.
const std::array<int, 2> kSizes[] = {{1, 0}, {1, 1}, {2, 5}, {3, 16}, {4, 7}, {5, 11}, {16, 0}, {23, 40}, {30, 3}};
INSTANTIATE_TEST_SUITE_P(Sizes, SidePanelKernels, testing::ValuesIn(kSizes));

}  // namespace
}  // namespace bullet_fem
