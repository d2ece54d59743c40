// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/btFemInterest.h"
#include "bullet_fem/btFemReports.h"
#include "bullet_fem/fem/step/step_types.h"

struct btFemEntry;

/// The detail that a body's interest has brought it to.
class btFemDetailLevel
{
public:
    /// Takes over the interest of a step [-], in [0, 1]; `step` [s] has passed since the last one. The first interest
    /// sets the level as it stands.
    void update(double interest, double step, const btFemDetailPolicy& policy);

    /// A level up, for a dwell at least: the present one was not good enough.
    void raise();

    /// nodalWarp, oneIteration or direct; nodalWarp before the first interest.
    btFemDetail detail() const;

    /// Its members, to or from a snapshot; and whether they can be those of a level.
    template <class Bytes>
    void transfer(Bytes& bytes)
    {
        bytes(m_begun, m_level, m_seconds);
    }
    bool valid() const { return m_level >= 0 && m_level <= 2 && m_seconds >= 0; }

private:
    bool m_begun = false;
    int m_level = 2;       // 0: direct, 1: oneIteration, 2: nodalWarp
    double m_seconds = 0;  // in that level
};

/// Chooses the details of bodies whose user left that to an interest function. Knows no more than the function and the
/// policy; what lasts is in the entries.
class btFemDetailChooser
{
public:
    /// Null: everything is worth nodalWarp. Throws std::invalid_argument on a bad policy.
    void setInterest(btFemInterest* interest, const btFemDetailPolicy& policy);

    /// Asks for the interest of a body that is about to be stepped by `step` [s]. Writes its level, and a flag to its
    /// report.
    void choose(btFemEntry& entry, double step) const;

    /// After its free motion was solved so: raises a body that is too far from the solution. Different bodies may be
    /// judged by different threads.
    static void judge(btFemEntry& entry, const bullet_fem::SolveReport& solved);

private:
    btFemInterest* m_interest = nullptr;
    btFemDetailPolicy m_policy;
};

/// The detail that a body's next free motion is solved with: what touches something is iterated to the tolerance.
btFemDetail detailInUse(const btFemEntry& entry);
