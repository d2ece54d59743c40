// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstdint>

class btSoftBody;

namespace bullet_fem
{

/// Puts a mark on a body with tetrahedra that no other body of this process has, and returns it. Addresses and
/// broadphase ids are used again for other bodies; the mark, in a field of the first tetrahedron that Bullet no longer
/// uses (btSoftBody::Tetra::m_c0), dies with its body. Thread-safe for different bodies.
std::uint64_t markBody(btSoftBody& body);

/// Takes the mark off a body, if it bears one: finite elements move it no more.
void unmarkBody(btSoftBody& body);

/// True if the body bears any mark: finite elements move it, or did in a world that it has left.
bool isMarked(const btSoftBody& body);

/// True if the body bears this mark.
bool hasMark(const btSoftBody& body, std::uint64_t mark);

}  // namespace bullet_fem
