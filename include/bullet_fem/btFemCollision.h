// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/btFemPrecision.h"

/// Bits of btSoftBody::m_cfg.collisions beyond Bullet's own, which ignores them.
enum btFemCollisionFlags
{
    /// What collides is the surface that follows the tetrahedra (m_renderNodes, m_renderFaces), not their boundary: of
    /// a cage the surface that it was made of. It is read when the body becomes FEM and when the bit is set; after
    /// changes take it away, step, and set it again. One that cannot collide is refused: prepare() throws, and a step
    /// goes on with the boundary, BT_FEM_BAD_SURFACE in its report.
    BT_FEM_RENDER_SURFACE = 1 << 16
};
