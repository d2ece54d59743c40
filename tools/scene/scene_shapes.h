// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>

#include "bullet_fem/fem/cage/surface_mesh.h"
#include "tools/scene/scene_description.h"

class btCollisionShape;

namespace bullet_fem
{

/// Bullet's shape, around the body's origin; of a plane through it.
std::unique_ptr<btCollisionShape> makeShape(const SceneShape& shape);

/// What is drawn of it, in the same frame; nothing of a plane, which is endless.
SurfaceMesh drawnShape(const SceneShape& shape);

}  // namespace bullet_fem
