// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "fem/scenes/test_surfaces.h"

namespace bullet_fem
{
namespace
{

struct ProgressCase
{
    const char* m_name;
    double m_cellSize, m_snap, m_cellsAcross;  // a cell size of 0: by the number of elements
};

class CageProgressTest : public testing::TestWithParam<ProgressCase>
{
protected:
    CageSettings settings() const
    {
        CageSettings settings;
        settings.m_cellSize = GetParam().m_cellSize;
        settings.m_targetTets = GetParam().m_cellSize > 0 ? 0 : 3000;
        settings.m_snap = GetParam().m_snap;
        settings.m_cellsAcross = GetParam().m_cellsAcross;
        return settings;
    }
    const SurfaceMesh m_ball = sphereSurface(1, {0.3, 0, 0}, 3);
};

TEST_P(CageProgressTest, RisesFromZeroToOne)
{
    CageSettings told = settings();
    std::vector<double> shares;
    told.m_progress = [&](double share)
    {
        shares.push_back(share);
        return true;
    };
    const Cage cage = makeCage(m_ball, told);
    ASSERT_GT(shares.size(), 6u);
    EXPECT_EQ(shares.front(), 0);
    EXPECT_EQ(shares.back(), 1);
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    double longest = 0;
    for (std::size_t k = 1; k < shares.size(); ++k) longest = std::max(longest, shares[k] - shares[k - 1]);
    EXPECT_LT(longest, 0.45) << "largest gap between reports";

    const Cage same = makeCage(m_ball, settings());
    ASSERT_EQ(cage.m_mesh.tetCount(), same.m_mesh.tetCount());
    EXPECT_EQ(cage.m_mesh.tets(), same.m_mesh.tets());
    EXPECT_EQ(cage.m_filled, same.m_filled) << "a progress callback does not change the cage";
}

// After a cancellation at any call, no further progress is reported.
TEST_P(CageProgressTest, CanBeCancelledAtAnyTime)
{
    int words = 0;
    CageSettings told = settings();
    told.m_progress = [&](double) { return ++words > 0; };
    makeCage(m_ball, told);
    const int all = words;
    for (int last = 1; last <= all; last += std::max(1, all / 5))
    {
        words = 0;
        told.m_progress = [&](double) { return ++words < last; };
        EXPECT_THROW(makeCage(m_ball, told), CageCancelled) << last << " of " << all;
        EXPECT_EQ(words, last);
    }
}

INSTANTIATE_TEST_SUITE_P(Cages, CageProgressTest,
                         testing::Values(ProgressCase{"ofElements", 0, 0, 0}, ProgressCase{"ofCells", 0.15, 0, 0},
                                         ProgressCase{"snapped", 0.2, 0.7, 0}, ProgressCase{"graded", 0, 0, 2}),
                         [](const auto& tested) { return tested.param.m_name; });

}  // namespace
}  // namespace bullet_fem
