// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/geometry/surface/lanes.h"
#include "bullet_bridge/geometry/surface/swept_box.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

/// Two axis-aligned boxes that are processed together as SIMD lanes; initially empty.
class BoxPair
{
public:
    /// The bounding boxes of two triangles with corners at x.
    static BoxPair of(const std::vector<Vec3>& x, const Triangle& first, const Triangle& second)
    {
        BoxPair pair;
        for (int c = 0; c < 3; ++c)
            for (int k = 0; k < 3; ++k)
            {
                const DoubleLanes corner = {x[first[k]][c], x[second[k]][c]};
                pair.m_low[c] = laneMin(pair.m_low[c], corner);
                pair.m_high[c] = laneMax(pair.m_high[c], corner);
            }
        return pair;
    }

    /// The bounding boxes of two pairs.
    static BoxPair around(const BoxPair& first, const BoxPair& second)
    {
        BoxPair pair;
        for (int c = 0; c < 3; ++c)
        {
            pair.m_low[c] = laneMin(DoubleLanes{first.m_low[c][0], second.m_low[c][0]},
                                    DoubleLanes{first.m_low[c][1], second.m_low[c][1]});
            pair.m_high[c] = laneMax(DoubleLanes{first.m_high[c][0], second.m_high[c][0]},
                                     DoubleLanes{first.m_high[c][1], second.m_high[c][1]});
        }
        return pair;
    }

    /// Squared distances of p to both boxes [m2], equal to VectorBounds::squaredDistance of each.
    DoubleLanes squaredDistances(const Vec3& p) const
    {
        const DoubleLanes none = {};
        DoubleLanes sum = {};
        for (int c = 0; c < 3; ++c)
        {
            const DoubleLanes d = laneMax(laneMax(m_low[c] - p[c], p[c] - m_high[c]), none);
            sum += d * d;
        }
        return sum;
    }

    VectorBounds operator[](int number) const
    {
        return {{m_low[0][number], m_low[1][number], m_low[2][number]},
                {m_high[0][number], m_high[1][number], m_high[2][number]}};
    }

private:
    static constexpr double kInfinity = VectorBounds::kInfinity;
    static constexpr DoubleLanes kLow = {kInfinity, kInfinity}, kHigh = {-kInfinity, -kInfinity};
    DoubleLanes m_low[3] = {kLow, kLow, kLow}, m_high[3] = {kHigh, kHigh, kHigh};
};

}  // namespace bullet_fem
