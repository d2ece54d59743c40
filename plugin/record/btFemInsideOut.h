// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstdint>
#include <vector>

#include "bullet_fem/fem/mesh/tet_mesh.h"

/// Search for inverted elements, in one part of the mesh per step: checking all would cost a noticeable share of a
/// step, and relevant inversions persist.
class btFemInsideOut
{
public:
    static constexpr int kParts = 32;  ///< number of steps in which all elements are checked

    /// Checks the next part, with the nodes at x [m].
    void look(const std::vector<bullet_fem::Tet>& tets, const std::vector<bullet_fem::Vec3>& x);

    /// True if some element was inverted at its last check.
    bool isAny() const { return m_found != 0; }

    /// Reads or writes the members of a snapshot; valid() checks untrusted ones.
    template <class Bytes>
    void transfer(Bytes& bytes)
    {
        bytes(m_next, m_found);
    }
    bool valid() const { return m_next >= 0 && m_next < kParts; }

private:
    int m_next = 0;             // next part
    std::uint32_t m_found = 0;  // one bit per part: it has inverted elements
};
