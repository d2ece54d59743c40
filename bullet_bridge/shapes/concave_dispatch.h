// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

class btDispatcher;

namespace bullet_fem
{

/// Makes a dispatcher call the soft body solver once for a FEM body and a concave shape, with that shape, also as a
/// compound's child. Bullet's own algorithm calls it once a triangle, with a hull that it makes and keeps for every
/// triangle, and looks for the triangles of a compound's child where the compound is. Bodies moved by Bullet's springs
/// keep Bullet's algorithm. Does nothing if `dispatcher` is null or no btCollisionDispatcher.
void dispatchConcaveShapesOnce(btDispatcher* dispatcher);

}  // namespace bullet_fem
