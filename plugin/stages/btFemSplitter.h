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

/// Splits bodies that have a strength as steps end, and keeps what split for the user. Allocates only when one splits,
/// and when it looks at a body for the first time.
class btFemSplitter
{
public:
    /// Of the bodies that were stepped and are awake, at the `time` since the first step [s]. `threads` look for
    /// cracks.
    void split(btFemBodySetUp& setUp, const btFemRecords& records, const bullet_fem::Threads& threads, double time);

    /// See btFemFracture.
    const btAlignedObjectArray<btFemSplit>& splits() const { return m_splits; }
    void clearSplits() { m_splits.resize(0); }

private:
    void splitBody(btFemBodySetUp& setUp, btFemBodyRecord& record, double time);

    std::vector<btFemBodyRecord*> m_due;
    btAlignedObjectArray<btFemSplit> m_splits;
};
