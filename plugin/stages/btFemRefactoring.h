// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/btFemSolverInfo.h"
#include "plugin/setup/btFemFactorThread.h"

class btFemBodySetUp;
struct btFemBodyRecord;

/// Tells, and if the user wants it arranges, that bodies get new factors where the old ones cost too many iterations.
class btFemRefactorPolicy
{
public:
    explicit btFemRefactorPolicy(const btFemSolverInfo& info)
        : m_refactoring(info.m_refactoring), m_tolerance(info.m_tolerance)
    {
    }

    /// Before a body is stepped by `step` [s], when its nodes were read: gives it a new factor, or asks for one in the
    /// background, or takes over the one that has become ready there. Flags a new one in the report. What touches
    /// something gets one at once if the old one is far off.
    void renew(btFemBodySetUp& setUp, btFemBodyRecord& record, double step);

    /// After its free motion has taken some iterations to the tolerance with the factor that it has: takes account
    /// of them, and flags the report if a new one would pay. Different bodies may be noted by different threads.
    void note(btFemBodyRecord& record, int iterations) const;

private:
    void refresh(btFemBodySetUp& setUp, btFemBodyRecord& record, double step);
    void takeOver(btFemBodySetUp& setUp, btFemBodyRecord& record, double step) const;
    void startJob(const btFemBodySetUp& setUp, btFemBodyRecord& record, double step);

    btFemRefactoring m_refactoring;
    double m_tolerance;
    btFemFactorThread m_thread;
};
