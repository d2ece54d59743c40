// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>

#include "bullet_fem/fem/cage/surface_mesh.h"
#include "tools/scene/scene_description.h"

class btCollisionShape;

namespace bullet_fem
{

/// Bullet's shape in the body's frame; a plane passes through the origin.
std::unique_ptr<btCollisionShape> makeShape(const SceneShape& shape);

/// Surface of the shape for pictures, in the body's frame; empty for a plane, which is unbounded.
SurfaceMesh drawnShape(const SceneShape& shape);

}  // namespace bullet_fem
