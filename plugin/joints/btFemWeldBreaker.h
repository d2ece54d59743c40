// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "LinearMath/btAlignedObjectArray.h"
#include "bullet_bridge/joints/welds.h"
#include "bullet_fem/btFemWelds.h"

/// Breaks welds as steps end, and keeps what broke for the user.
class btFemWeldBreaker
{
public:
    /// A step [s] of the world begins.
    void beginStep(double step) { m_time += step; }

    /// Breaks what bore more than its limit in a step [s] of these bodies: it holds no more from the next one on. After
    /// SoftJoints::takeBack.
    void breakWelds(const std::vector<bullet_fem::FemSoftBody*>& bodies, double step);

    /// So that no step allocates where so many more nodes tear off.
    void makeRoom(int nodes);

    /// See btFemWelds.
    const btAlignedObjectArray<btFemWeldBreak>& breaks() const { return m_breaks; }
    void clearBreaks() { m_breaks.resize(0); }
    bullet_fem::WeldLoads& loads() { return m_loads; }

    double time() const { return m_time; }  ///< of all steps so far [s]
    void setTime(double time) { m_time = time; }

private:
    void tell(const bullet_fem::FemSoftBody& fem, const bullet_fem::WeldBreak& broken);

    bullet_fem::WeldLoads m_loads;
    std::vector<bullet_fem::WeldBreak> m_broken;  // of one body
    btAlignedObjectArray<btFemWeldBreak> m_breaks;
    int m_most = 0;     // nodes of all welds that were made
    double m_time = 0;  // [s]
};
