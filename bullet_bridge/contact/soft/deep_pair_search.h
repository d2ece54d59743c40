// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/geometry/surface/soft_surface.h"
#include "bullet_bridge/geometry/surface/surface_contact.h"

namespace bullet_fem
{

/// True if the middle of one of two closed surfaces is inside both: the nodes of each may be nearest to faces of the
/// other that look the same way, and have no way out of their own. Call after SoftSurface::place() of both.
bool areDeepInside(const SoftSurface& a, const SoftSurface& b);

/// Unit vector along which such bodies part: from the middle of `from` to that of `to`, or any if they agree.
Vec3 wayApart(const SoftSurface& from, const SoftSurface& to);

/// Appends a contact for every node inside the other surface, with the first face out along `way`, a unit vector.
void findAlong(const SoftSurface& nodes, const SoftSurface& faces, const Vec3& way,
               std::vector<SurfaceContact>& touches);

}  // namespace bullet_fem
