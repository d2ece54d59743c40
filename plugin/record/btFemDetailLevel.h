// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/btFemInterest.h"
#include "bullet_fem/btFemReports.h"

/// Level of detail of a body by its interest.
class btFemDetailLevel
{
public:
    /// Updates the level by the interest of a step [-], in [0, 1]; `step` [s] has passed since the last call. The first
    /// interest sets the level directly.
    void update(double interest, double step, const btFemDetailPolicy& policy);

    /// nodalWarp, oneIteration or direct; nodalWarp before the first interest.
    btFemDetail detail() const;

    /// Reads or writes the members of a snapshot; valid() checks untrusted ones.
    template <class Bytes>
    void transfer(Bytes& bytes)
    {
        bytes(m_begun, m_level, m_seconds);
    }
    bool valid() const { return m_level >= 0 && m_level <= 2 && m_seconds >= 0; }

private:
    bool m_begun = false;
    int m_level = 2;       // 0: direct, 1: oneIteration, 2: nodalWarp
    double m_seconds = 0;  // time on that level [s]
};
