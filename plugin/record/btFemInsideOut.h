// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstdint>
#include <vector>

#include "bullet_fem/fem/mesh/tet_mesh.h"

/// Looks for elements that are inside out: at a part of them in every step, since all would cost a share of a step that
/// is worth something, and those that matter stay so.
class btFemInsideOut
{
public:
    static constexpr int kParts = 32;  ///< steps in which all elements are looked at

    /// Looks at the next part, with the nodes at x [m].
    void look(const std::vector<bullet_fem::Tet>& tets, const std::vector<bullet_fem::Vec3>& x);

    /// True if some element was inside out when it was looked at last.
    bool isAny() const { return m_found != 0; }

    /// Its members, to or from a snapshot; and whether they can be those of one.
    template <class Bytes>
    void transfer(Bytes& bytes)
    {
        bytes(m_next, m_found);
    }
    bool valid() const { return m_next >= 0 && m_next < kParts; }

private:
    int m_next = 0;             // part
    std::uint32_t m_found = 0;  // a bit for every part that has one
};
