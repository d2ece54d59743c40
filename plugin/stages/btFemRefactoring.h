// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/btFemSolverInfo.h"
#include "plugin/setup/btFemFactorThread.h"

class btFemBodySetUp;
struct btFemBodyRecord;

/// Detects bodies whose outdated factors cost too many iterations, and refactors them if the user's settings permit.
class btFemRefactorPolicy
{
public:
    explicit btFemRefactorPolicy(const btFemSolverInfo& info)
        : m_refactoring(info.m_refactoring), m_tolerance(info.m_tolerance)
    {
    }

    /// Call before a body is stepped by `step` [s], after its nodes were read. Refactors it, or starts a background
    /// job, or takes over the factor of a finished job; flags a new factor in the report. A body with contacts or
    /// joints is refactored at once if its factor is far off.
    void renew(btFemBodySetUp& setUp, btFemBodyRecord& record, double step);

    /// Call after the free motion, with the iterations that it took to the tolerance with the present factor. Adds them
    /// to the account, and flags the report if refactoring would pay off. Different bodies may be noted by different
    /// threads.
    void note(btFemBodyRecord& record, int iterations) const;

private:
    void refresh(btFemBodySetUp& setUp, btFemBodyRecord& record, double step);
    void takeOver(btFemBodySetUp& setUp, btFemBodyRecord& record, double step) const;
    void startJob(const btFemBodySetUp& setUp, btFemBodyRecord& record, double step);

    btFemRefactoring m_refactoring;
    double m_tolerance;
    btFemFactorThread m_thread;
};
