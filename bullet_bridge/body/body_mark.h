// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstdint>

class btSoftBody;

namespace bullet_fem
{

/// Puts a mark on a body with tetrahedra, unique in this process, and returns it. Addresses and broadphase ids are
/// reused for other bodies; the mark is in a field of the first tetrahedron that Bullet no longer uses
/// (btSoftBody::Tetra::m_c0), so it is deleted with its body. Thread-safe for different bodies.
std::uint64_t markBody(btSoftBody& body);

/// Removes the mark of a body, if it has one: it is no longer a FEM body.
void unmarkBody(btSoftBody& body);

/// True if the body has any mark: it is a FEM body, or was one in a world that it has left.
bool isMarked(const btSoftBody& body);

/// True if the body has this mark.
bool hasMark(const btSoftBody& body, std::uint64_t mark);

}  // namespace bullet_fem
