// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/soft_pairs/coarse_box.h"

#include <algorithm>
#include <cmath>
#include <limits>

// Loops run over four components, which compilers take as one vector here; where they are inlined they do not.
namespace bullet_fem
{
namespace
{

// More than what four operations round away. Where boxes are apart, all they take is a share of the distance at the
// start: of two values that are near each other the difference is exact.
constexpr float kShrink = 1 - 1e-6f;

// More than what rounding to single precision can have changed.
float rounding(float a)
{
    return 2e-7f * std::fabs(a) + std::numeric_limits<float>::min();
}

}  // namespace

CoarseBox CoarseBox::empty()
{
    constexpr float kMost = std::numeric_limits<float>::max();
    return {
        {kMost, kMost, kMost, 0}, {-kMost, -kMost, -kMost, 0}, {kMost, kMost, kMost, 0}, {-kMost, -kMost, -kMost, 0}};
}

CoarseBox CoarseBox::of(const Vec3& point, const Vec3& change)
{
    CoarseBox box = {};
    for (int c = 0; c < 3; ++c)
    {
        const float x = static_cast<float>(point[c]), d = static_cast<float>(change[c]);
        box.m_low[c] = x - rounding(x);
        box.m_high[c] = x + rounding(x);
        box.m_changeLow[c] = d - rounding(d);
        box.m_changeHigh[c] = d + rounding(d);
    }
    return box;
}

void CoarseBox::add(const CoarseBox& b)
{
    for (int c = 0; c < 4; ++c)
    {
        m_low[c] = std::min(m_low[c], b.m_low[c]);
        m_high[c] = std::max(m_high[c], b.m_high[c]);
        m_changeLow[c] = std::min(m_changeLow[c], b.m_changeLow[c]);
        m_changeHigh[c] = std::max(m_changeHigh[c], b.m_changeHigh[c]);
    }
}

void CoarseBox::last(int steps)
{
    const float count = static_cast<float>(steps);
    for (int c = 0; c < 4; ++c)
    {
        m_changeLow[c] *= count;
        m_changeHigh[c] *= count;
    }
}

bool CoarseBox::startsWithin(const CoarseBox& b, float reach) const
{
    int apart = 0;
    for (int c = 0; c < 4; ++c)
    {
        const float above = m_low[c] - b.m_high[c], below = b.m_low[c] - m_high[c];
        apart |= kShrink * std::max(above, below) > reach ? 1 : 0;
    }
    return apart == 0;
}

bool CoarseBox::meets(const CoarseBox& b, float reach) const
{
    int apart = 0;
    for (int c = 0; c < 4; ++c)
    {
        const float above = kShrink * (m_low[c] - b.m_high[c]) + std::min(0.f, m_changeLow[c] - b.m_changeHigh[c]);
        const float below = kShrink * (b.m_low[c] - m_high[c]) + std::min(0.f, b.m_changeLow[c] - m_changeHigh[c]);
        apart |= std::max(above, below) > reach ? 1 : 0;
    }
    return apart == 0;
}

}  // namespace bullet_fem
