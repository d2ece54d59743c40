// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/factor/panel_kernels.h"

#include <gtest/gtest.h>

#include "fem/common/vector_targets.h"

#include <hwy/targets.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "fem/common/aligned_array.h"
#include "fem/scenes/elasticity_scenes.h"

#include "fem/scenes/reference_kernels.h"

namespace bullet_fem
{
namespace
{

struct PanelSize
{
    int m_columns, m_rowsBelow;  // nodes
};

void PrintTo(const PanelSize& size, std::ostream* out)
{
    *out << size.m_columns << " columns over " << size.m_rowsBelow << " rows";
}

// A panel of random entries: columns are nodes 2, 3, ..., rows below are every third node after them. RowsOfNode: 3 if
// an entry is for one direction, 1 if it serves all three.
template <int RowsOfNode>
class PanelKernelsTest : public testing::TestWithParam<PanelSize>
{
protected:
    PanelKernelsTest()
    {
        const PanelSize size = GetParam();
        m_panel = {nullptr, nullptr, 2, RowsOfNode * size.m_columns, RowsOfNode * size.m_rowsBelow};
        for (int k = 0; k < size.m_rowsBelow; ++k) m_rows.push_back(2 + size.m_columns + 3 * k);
        m_nodes = 2 + size.m_columns + 3 * size.m_rowsBelow;
        const std::size_t count = static_cast<std::size_t>(kPanelLanes) * m_panel.blocks() * m_panel.m_columns;
        m_values = allocateFloats(count);
        fillRandomly(m_values.get(), count, 1);
        m_scratch = allocateFloats(static_cast<std::size_t>(kRowLanes) * kPanelLanes * m_panel.blocks());
        m_panel.m_values = m_values.get();
        m_panel.m_row = m_rows.data();
    }

    static void fillRandomly(float* values, std::size_t count, unsigned seed)
    {
        RandomVectors random(seed);
        for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<float>(random.next().x);
    }

    // |y - expected| relative to the summed terms.
    double error(const float* y, const std::vector<float>& expected) const
    {
        double largest = 0;
        for (std::size_t i = 0; i < expected.size(); ++i)
            largest = std::max(largest, std::fabs(static_cast<double>(y[i]) - expected[i]));
        return largest / (m_panel.m_columns + m_panel.m_rowsBelow);
    }

    template <class Run, class Twin>
    void compare(int lanes, const Run& run, const Twin& twin)
    {
        const std::size_t count = static_cast<std::size_t>(3) * m_nodes * lanes;
        AlignedFloats y = allocateFloats(count);
        for (const std::int64_t target : hwy::SupportedAndGeneratedTargets())
        {
            hwy::SetSupportedTargetsForTest(target);
            fillRandomly(y.get(), count, 2);
            fillRandomly(m_scratch.get(), static_cast<std::size_t>(kRowLanes) * lanes * m_panel.blocks(), 3);
            std::vector<float> expected(y.get(), y.get() + count);
            run(m_panel, y.get(), m_scratch.get());
            twin(m_panel, expected.data(), lanes);
            EXPECT_LE(error(y.get(), expected), 2e-7) << hwy::TargetName(target);
            ++m_targets;
        }
        hwy::SetSupportedTargetsForTest(0);
        EXPECT_GE(m_targets, 1);
    }

    static constexpr int kRowLanes = 3 * kPanelLanes / RowsOfNode;  // of 16 rows of one right-hand side
    Panel m_panel;
    std::vector<int> m_rows;
    int m_nodes = 0, m_targets = 0;
    AlignedFloats m_values, m_scratch;
};

using PanelKernels = PanelKernelsTest<3>;
using IsotropicKernels = PanelKernelsTest<1>;

TEST_P(PanelKernels, ForwardMatchesItsScalarReference)
{
    compare(1, forwardPanel, reference::forwardPanel);
}

TEST_P(PanelKernels, BackwardMatchesItsScalarReference)
{
    compare(1, backwardPanel, reference::backwardPanel);
}

TEST_P(PanelKernels, ForwardOfSixteenMatchesItsScalarReference)
{
    compare(kPanelLanes, forwardPanelLanes, reference::forwardPanel);
}

TEST_P(PanelKernels, BackwardOfSixteenMatchesItsScalarReference)
{
    compare(kPanelLanes, backwardPanelLanes, reference::backwardPanel);
}

TEST_P(IsotropicKernels, ForwardMatchesItsScalarReference)
{
    compare(1, forwardIsotropic, reference::forwardIsotropic);
}

TEST_P(IsotropicKernels, BackwardMatchesItsScalarReference)
{
    compare(1, backwardIsotropic, reference::backwardIsotropic);
}

TEST_P(IsotropicKernels, ForwardOfSixteenMatchesItsScalarReference)
{
    compare(kPanelLanes, forwardIsotropicLanes, reference::forwardIsotropic);
}

TEST_P(IsotropicKernels, BackwardOfSixteenMatchesItsScalarReference)
{
    compare(kPanelLanes, backwardIsotropicLanes, reference::backwardIsotropic);
}

// All widths of a last chunk, with row counts that fill their last block and others that do not.
const PanelSize kPanelSizes[] = {{1, 0}, {1, 1}, {2, 5}, {3, 16}, {4, 7}, {5, 11}, {16, 0}, {23, 40}, {30, 3}};
INSTANTIATE_TEST_SUITE_P(Sizes, PanelKernels, testing::ValuesIn(kPanelSizes));
INSTANTIATE_TEST_SUITE_P(Sizes, IsotropicKernels, testing::ValuesIn(kPanelSizes));

// One node over one: M = 2 I, S = 3 I, padded.
TEST(PanelKernelsByHand, OneNodeOverOneMatchesHandValues)
{
    AlignedFloats values = allocateFloats(3 * kPanelLanes), scratch = allocateFloats(kPanelLanes);
    std::fill(values.get(), values.get() + 3 * kPanelLanes, 0.f);
    for (int c = 0; c < 3; ++c)
    {
        values[c * kPanelLanes + c] = 2;
        values[c * kPanelLanes + 3 + c] = 3;
    }
    const int row = 1;
    const Panel panel = {values.get(), &row, 0, 3, 3};
    float y[] = {1, 2, 3, 10, 20, 30};
    forwardPanel(panel, y, scratch.get());
    EXPECT_EQ(y[3], 8);
    EXPECT_EQ(y[5], 24);
    backwardPanel(panel, y, scratch.get());
    EXPECT_EQ(y[0], 3 * 1 - 2 * 8);
    EXPECT_EQ(y[2], 3 * 3 - 2 * 24);
}

// One node over one: M = 2, S = 3, padded.
TEST(IsotropicKernelsByHand, OneNodeOverOneMatchesHandValues)
{
    AlignedFloats values = allocateFloats(kPanelLanes), scratch = allocateFloats(3 * kPanelLanes);
    std::fill(values.get(), values.get() + kPanelLanes, 0.f);
    values[0] = 2;
    values[1] = 3;
    const int row = 1;
    const Panel panel = {values.get(), &row, 0, 1, 1};
    float y[] = {1, 2, 3, 10, 20, 30};
    forwardIsotropic(panel, y, scratch.get());
    EXPECT_EQ(y[3], 8);
    EXPECT_EQ(y[5], 24);
    backwardIsotropic(panel, y, scratch.get());
    EXPECT_EQ(y[0], 3 * 1 - 2 * 8);
    EXPECT_EQ(y[2], 3 * 3 - 2 * 24);
}

}  // namespace
}  // namespace bullet_fem
