// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/btFemInterest.h"

struct btFemBodyRecord;

/// Chooses the details of bodies whose user left that to an interest function. Knows no more than the function and the
/// policy; what lasts is in the records.
class btFemDetailChooser
{
public:
    /// Null: everything is worth nodalWarp. Throws std::invalid_argument on a bad policy.
    void setInterest(btFemInterest* interest, const btFemDetailPolicy& policy);

    /// Asks for the interest of a body that is about to be stepped by `step` [s]. Writes its level, and a flag to its
    /// report.
    void choose(btFemBodyRecord& record, double step) const;

private:
    btFemInterest* m_interest = nullptr;
    btFemDetailPolicy m_policy;
};
