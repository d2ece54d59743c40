// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>

/// Detects bodies that persistently cannot be solved in real time.
class btFemRealTime
{
public:
    /// Adds the cost and the length of a step [both ms]. True once ten more of the recent steps took longer than their
    /// length than did not, until both are equally many.
    bool isTooSlow(double taken, double step)
    {
        m_slowSteps = std::clamp(m_slowSteps + (taken > step ? 1 : -1), 0, kMax);
        m_tooSlow = m_slowSteps >= kPersistent || (m_tooSlow && m_slowSteps > 0);
        return m_tooSlow;
    }

private:
    static constexpr int kPersistent = 10, kMax = 20;
    int m_slowSteps = 0;  // excess of slow steps
    bool m_tooSlow = false;
};
