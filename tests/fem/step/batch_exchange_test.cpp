// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/batch/batch_exchange.h"

#include "fem/common/aligned_array.h"
#include "fem/scenes/element_case.h"

namespace bullet_fem
{
namespace
{

/// Arrays of kBatchWidth bodies with values that encode their index, and memory for lanes.
template <class Real>
class ExchangeCase
{
public:
    explicit ExchangeCase(const BatchLayout& layout) : m_layout(layout)
    {
        const int run = layout.m_rows > 1 ? kLanes : layout.m_count;
        m_size = (layout.m_count + run - 1) / run * run * layout.m_rows;
        for (int b = 0; b < kBatchWidth; ++b)
        {
            m_arrays.emplace_back(m_size);
            for (int k = 0; k < m_size; ++k) m_arrays[b][k] = static_cast<Real>(1000 * b + k);
        }
        m_lanes = allocateAligned<Real>(static_cast<std::size_t>(kBatchWidth) * layout.m_count * layout.m_rows);
    }

    int place(int value, int row) const
    {
        if (m_layout.m_rows == 1) return value;
        return (value / kLanes * m_layout.m_rows + row) * kLanes + value % kLanes;
    }

    void gather()
    {
        const Real* from[kBatchWidth];
        for (int b = 0; b < kBatchWidth; ++b) from[b] = m_arrays[b].data();
        gatherBatch(from, m_lanes.get(), m_layout);
    }

    void expectLanes() const
    {
        for (int value = 0; value < m_layout.m_count; ++value)
            for (int row = 0; row < m_layout.m_rows; ++row)
                for (int b = 0; b < kBatchWidth; ++b)
                    ASSERT_EQ(m_lanes[(value * m_layout.m_rows + row) * kBatchWidth + b],
                              m_arrays[b][place(value, row)])
                        << value << ", " << row << ", " << b;
    }

    // Copies back into arrays of -1, except for two bodies.
    void expectWayBack() const
    {
        std::vector<std::vector<Real>> back(kBatchWidth, std::vector<Real>(m_size, Real(-1)));
        Real* to[kBatchWidth];
        for (int b = 0; b < kBatchWidth; ++b) to[b] = b == 3 || b == 15 ? nullptr : back[b].data();
        scatterBatch(to, m_lanes.get(), m_layout);
        for (int b = 0; b < kBatchWidth; ++b)
            for (int value = 0; value < m_layout.m_count; ++value)
                for (int row = 0; row < m_layout.m_rows; ++row)
                    ASSERT_EQ(back[b][place(value, row)], to[b] ? m_arrays[b][place(value, row)] : Real(-1))
                        << value << ", " << row << ", " << b;
    }

private:
    BatchLayout m_layout;
    int m_size;
    std::vector<std::vector<Real>> m_arrays;
    AlignedArray<Real> m_lanes;
};

class LaneExchange : public OnTarget
{
protected:
    template <class Real>
    static void goThereAndBack(const BatchLayout& layout)
    {
        SCOPED_TRACE(std::to_string(layout.m_count) + " values, " + std::to_string(layout.m_rows) + " rows");
        ExchangeCase<Real> exchange(layout);
        exchange.gather();
        exchange.expectLanes();
        exchange.expectWayBack();
    }
};

// Counts that are multiples of the vector width, and others.
TEST_P(LaneExchange, RestoresAllLanes)
{
    for (const int count : {1, 2, 3, 4, 5, 7, 16, 17, 63})
        for (const int rows : {1, 2, 15})
        {
            goThereAndBack<float>({count, rows});
            goThereAndBack<double>({count, rows});
        }
}

INSTANTIATE_TEST_SUITE_P(Targets, LaneExchange, testing::ValuesIn(availableTargets()), targetName);

}  // namespace
}  // namespace bullet_fem
