// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/btFemPrecision.h"

/// Bits of btSoftBody::m_cfg.collisions beyond Bullet's own, which ignores them.
enum btFemCollisionFlags
{
    /// The collision surface is the embedded surface, which follows the tetrahedra (m_renderNodes, m_renderFaces),
    /// instead of their boundary; for a cage, that is the surface that it was made of. The surface is read when the
    /// body becomes FEM and when the bit is set; after changing it, clear the bit, step, and set the bit again. An
    /// unsuitable surface is refused: prepare() throws, and a step continues with the boundary and reports
    /// BT_FEM_BAD_SURFACE.
    BT_FEM_RENDER_SURFACE = 1 << 16
};
