// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/btFemInterest.h"

struct btFemBodyRecord;

/// Chooses the level of detail of bodies with btFemDetail::automatic by an interest function and a policy. State is
/// kept in the records.
class btFemDetailChooser
{
public:
    /// Sets the interest function; null: all bodies get nodalWarp. Throws std::invalid_argument on an invalid policy.
    void setInterest(btFemInterest* interest, const btFemDetailPolicy& policy);

    /// Gets the interest of a body that is about to be stepped by `step` [s]. Updates its level of detail, and flags an
    /// invalid interest in its report.
    void choose(btFemBodyRecord& record, double step) const;

private:
    btFemInterest* m_interest = nullptr;
    btFemDetailPolicy m_policy;
};
