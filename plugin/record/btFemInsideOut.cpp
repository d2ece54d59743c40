// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/record/btFemInsideOut.h"

#include <algorithm>

using namespace bullet_fem;

void btFemInsideOut::look(const std::vector<Tet>& tets, const std::vector<Vec3>& x)
{
    const auto isInsideOut = [&x](const Tet& t)
    { return dot(cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]]), x[t[3]] - x[t[0]]) < 0; };
    const auto placeOf = [&tets](int part)
    { return tets.begin() + static_cast<std::ptrdiff_t>(tets.size() * static_cast<std::size_t>(part) / kParts); };
    const std::uint32_t bit = std::uint32_t(1) << m_next;
    m_found &= ~bit;
    if (std::any_of(placeOf(m_next), placeOf(m_next + 1), isInsideOut)) m_found |= bit;
    m_next = (m_next + 1) % kParts;
}
