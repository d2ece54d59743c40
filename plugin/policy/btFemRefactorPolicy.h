// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/btFemSoftBodySolver.h"
#include "plugin/policy/btFemFactorThread.h"

class btFemBodyRegistry;
struct btFemEntry;

/// By how much a body's factor is off for a step [s]: 1 if it is fresh, the largest ratio of step or masses if it is
/// not, infinity if other nodes are fixed than those that it was made for.
double staleness(const btFemEntry& entry, double step);

/// Tells, and if the user wants it arranges, that bodies get new factors where the old ones cost too many iterations.
class btFemRefactorPolicy
{
public:
    explicit btFemRefactorPolicy(const btFemSolverInfo& info)
        : m_refactoring(info.m_refactoring), m_tolerance(info.m_tolerance)
    {
    }

    /// Before a body is stepped by `step` [s], when its nodes were read: gives it a new factor, or asks for one in the
    /// background, or takes over the one that has become ready there. Flags a new one in the report.
    void refresh(btFemBodyRegistry& registry, btFemEntry& entry, double step);

    /// After its free motion has taken some iterations to the tolerance with a factor of that staleness: takes account
    /// of them, and flags the report if a new one would pay. Different bodies may be noted by different threads.
    void note(btFemEntry& entry, int iterations, double staleness) const;

private:
    void takeOver(btFemBodyRegistry& registry, btFemEntry& entry, double step) const;
    void startJob(const btFemBodyRegistry& registry, btFemEntry& entry, double step);

    btFemRefactoring m_refactoring;
    double m_tolerance;
    btFemFactorThread m_thread;
};
