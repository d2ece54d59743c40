// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>

/// Notices when a body cannot be solved in real time, and not just for a moment.
class btFemRealTime
{
public:
    /// Takes over what a step took and how long it is [both ms]. True if most of the steps of late took longer than
    /// they are: from 10 more of those than of the others on, until there are as many of either.
    bool isTooSlow(double taken, double step)
    {
        m_slowSteps = std::clamp(m_slowSteps + (taken > step ? 1 : -1), 0, kMax);
        m_tooSlow = m_slowSteps >= kPersistent || (m_tooSlow && m_slowSteps > 0);
        return m_tooSlow;
    }

private:
    static constexpr int kPersistent = 10, kMax = 20;
    int m_slowSteps = 0;  // more than others, of late
    bool m_tooSlow = false;
};
