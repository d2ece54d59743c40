// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "LinearMath/btAlignedObjectArray.h"
#include "bullet_fem/btFemFracture.h"
#include "plugin/record/btFemBodyRecord.h"

class btFemBodySetUp;

namespace bullet_fem
{
class Threads;
}

/// Splits bodies with a tensile strength at the end of steps, and keeps the events for the user. Allocates only when a
/// body splits, and at the first check of a body.
class btFemSplitter
{
public:
    /// Checks the stepped active bodies at `time` since the first step [s]. `threads` search for cracks.
    void split(btFemBodySetUp& setUp, const btFemRecords& records, const bullet_fem::Threads& threads, double time);

    /// See btFemFracture.
    const btAlignedObjectArray<btFemSplit>& splits() const { return m_splits; }
    void clearSplits() { m_splits.resize(0); }

private:
    void splitBody(btFemBodySetUp& setUp, btFemBodyRecord& record, double time);

    std::vector<btFemBodyRecord*> m_due;
    btAlignedObjectArray<btFemSplit> m_splits;
};
