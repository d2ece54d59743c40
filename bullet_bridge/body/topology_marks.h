// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <cstdint>

#include "BulletSoftBody/btSoftBody.h"

namespace bullet_fem
{

/// Detects changes of the nodes of a body's tetrahedra. Bullet flags its own changes (m_bUpdateRtCst), but a program
/// may write to m_tetras as well. Checking all tetrahedra in each step would take a twentieth of its time, because each
/// is in cache lines of its own: so parts take turns.
class TopologyMarks
{
public:
    static constexpr int kTurns = 8;  ///< number of parts: all are checked after so many steps

    /// Takes the present state of a body with at least one node and one tetrahedron.
    explicit TopologyMarks(const btSoftBody& body);

    /// False if a tetrahedron has other nodes, by index. The body must have the former numbers of nodes and tetrahedra.
    bool match(const btSoftBody& body) const;

    /// match() for all tetrahedra if Bullet has flagged a change or their array has moved; otherwise for the part whose
    /// turn it is.
    bool matchInTurn(const btSoftBody& body);

private:
    bool partMatches(const btSoftBody& body, int part) const;

    std::array<std::uint64_t, kTurns> m_marks;
    const btSoftBody::Tetra* m_tetras;  // array at the last check
    int m_turn = 0;
};

}  // namespace bullet_fem
