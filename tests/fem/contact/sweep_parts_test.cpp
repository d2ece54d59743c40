// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/solver/sweep_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <set>
#include <vector>

namespace bullet_fem
{
namespace
{

struct GridRow
{
    int m_a, m_b;
};

/// A block of movable bodies, each with rows to its neighbours on three sides and one row to a static object.
class SweepPartsTest : public ::testing::Test
{
protected:
    static constexpr int kSide = 6, kRowsOfPair = 12;

    SweepPartsTest()
    {
        m_parts.clear(kSide * kSide * kSide);
        for (int x = 0; x < kSide; ++x)
            for (int y = 0; y < kSide; ++y)
                for (int z = 0; z < kSide; ++z)
                {
                    const int own = index(x, y, z);
                    addRow(own, -1, x, y, z);
                    if (x + 1 < kSide) addPair(own, index(x + 1, y, z), {x + 0.5, double(y), double(z)});
                    if (y + 1 < kSide) addPair(own, index(x, y + 1, z), {double(x), y + 0.5, double(z)});
                    if (z + 1 < kSide) addPair(own, index(x, y, z + 1), {double(x), double(y), z + 0.5});
                }
    }

    static int index(int x, int y, int z) { return (x * kSide + y) * kSide + z; }
    void addRow(int a, int b, double x, double y, double z)
    {
        m_parts.add(a, b, {x, y, z});
        m_rows.push_back({a, b});
    }
    void addPair(int a, int b, const Vec3& at)
    {
        for (int k = 0; k < kRowsOfPair; ++k) addRow(a, b, at.x, at.y, at.z);
    }
    std::vector<int> all() const
    {
        std::vector<int> rows(m_rows.size());
        std::iota(rows.begin(), rows.end(), 0);
        return rows;
    }
    std::set<int> moversOf(const std::vector<int>& rows, Range range) const
    {
        std::set<int> movers;
        for (int k = range.m_begin; k < range.m_end; ++k)
            for (int mover : {m_rows[rows[k]].m_a, m_rows[rows[k]].m_b})
                if (mover >= 0) movers.insert(mover);
        return movers;
    }

    SweepParts m_parts;
    std::vector<GridRow> m_rows;
};

TEST_F(SweepPartsTest, PartsOfOneLevelHaveNoMoverInCommon)
{
    m_parts.divide(true);
    std::vector<int> rows = all();
    m_parts.sort(rows);
    ASSERT_GE(m_parts.levels(), 3);
    for (int level = 0; level < m_parts.levels(); ++level)
    {
        std::set<int> movers;
        for (int part = 1 << level; part < 2 << level; ++part)
            for (int mover : moversOf(rows, m_parts.rows(part)))
                EXPECT_TRUE(movers.insert(mover).second) << "level " << level << ", mover " << mover;
    }
}

TEST_F(SweepPartsTest, EveryRowIsInOnePartInItsOldOrder)
{
    m_parts.divide(true);
    std::vector<int> some;
    for (int row : all())
        if (row % 3 != 1) some.push_back(row);
    std::vector<int> rows = some;
    m_parts.sort(rows);
    int end = 0;
    for (int part = 1; part < m_parts.parts(); ++part)
    {
        const Range range = m_parts.rows(part);
        EXPECT_EQ(range.m_begin, end);
        end = range.m_end;
        EXPECT_TRUE(std::is_sorted(rows.begin() + range.m_begin, rows.begin() + range.m_end)) << "part " << part;
        for (int k = range.m_begin; k < range.m_end; ++k) EXPECT_EQ(m_parts.partOf(rows[k]), part);
    }
    EXPECT_EQ(end, static_cast<int>(some.size()));
    std::sort(rows.begin(), rows.end());
    EXPECT_EQ(rows, some);
}

// Rows across the first cut are swept by one thread: it cuts one of 15 planes of pairs.
TEST_F(SweepPartsTest, TheWholeHasFewRowsAndTheHalvesAreAlike)
{
    m_parts.divide(true);
    std::vector<int> inHalf(2, 0);
    int across = 0;
    for (int row : all())
    {
        int part = m_parts.partOf(row);
        if (part == 1)
            ++across;
        else
        {
            while (part > 3) part /= 2;
            ++inHalf[part - 2];
        }
    }
    const int rows = static_cast<int>(m_rows.size());
    EXPECT_GT(across, 0);
    EXPECT_LT(across, rows / 8);
    EXPECT_LT(std::abs(inHalf[0] - inHalf[1]), rows / 8);
}

TEST_F(SweepPartsTest, LargerPartsComeAfterTheirOwn)
{
    m_parts.divide(true);
    std::vector<int> rows = all(), order;
    m_parts.sort(rows);
    m_parts.inTurn(nullptr, [&](int part, Range) { order.push_back(part); });
    EXPECT_EQ(static_cast<int>(order.size()), m_parts.parts() - 1);
    EXPECT_EQ(order.back(), 1);
    for (std::size_t k = 0; k + 1 < order.size(); ++k)
    {
        const auto parent = std::find(order.begin(), order.end(), order[k] / 2) - order.begin();
        EXPECT_GT(parent, static_cast<std::ptrdiff_t>(k)) << "part " << order[k];
    }
}

TEST_F(SweepPartsTest, FewRowsFormOnePartUnchanged)
{
    m_parts.divide(false);
    std::vector<int> rows = all();
    std::reverse(rows.begin(), rows.end());
    const std::vector<int> before = rows;
    m_parts.sort(rows);
    EXPECT_EQ(rows, before);
    EXPECT_EQ(m_parts.parts(), 2);
    EXPECT_EQ(m_parts.rows(1).m_begin, 0);
    EXPECT_EQ(m_parts.rows(1).m_end, static_cast<int>(rows.size()));
}

}  // namespace
}  // namespace bullet_fem
