// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "LinearMath/btAlignedObjectArray.h"
#include "bullet_bridge/joints/welds.h"
#include "bullet_fem/btFemWelds.h"

/// Breaks welds at the end of steps, and keeps the events for the user.
class btFemWeldBreaker
{
public:
    /// Call at the start of a step of `step` [s].
    void beginStep(double step) { m_time += step; }

    /// Breaks welds of these bodies whose load in a step of `step` [s] exceeded a limit: they no longer hold from the
    /// next step on. Call after SoftJoints::takeBack.
    void breakWelds(const std::vector<bullet_fem::FemSoftBody*>& bodies, double step);

    /// Reserves memory for the events of `nodes` more welded nodes, so that steps do not allocate.
    void makeRoom(int nodes);

    /// See btFemWelds.
    const btAlignedObjectArray<btFemWeldBreak>& breaks() const { return m_breaks; }
    void clearBreaks() { m_breaks.resize(0); }
    bullet_fem::WeldLoads& loads() { return m_loads; }

    double time() const { return m_time; }  ///< duration of all steps so far [s]
    void setTime(double time) { m_time = time; }

private:
    void tell(const bullet_fem::FemSoftBody& fem, const bullet_fem::WeldBreak& broken);

    bullet_fem::WeldLoads m_loads;
    std::vector<bullet_fem::WeldBreak> m_broken;  // scratch, of one body
    btAlignedObjectArray<btFemWeldBreak> m_breaks;
    int m_max = 0;      // number of nodes of all welds made
    double m_time = 0;  // [s]
};
