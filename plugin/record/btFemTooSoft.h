// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>

#include "bullet_bridge/fem_soft_body.h"

/// Whether a body is too soft for its own weight; see BT_FEM_TOO_SOFT.
class btFemTooSoft
{
public:
    /// Free while the body's model and gravity are those of the last look; else it passes over nodes and elements, and
    /// allocates where the body has several connected parts.
    bool look(const bullet_fem::FemSoftBody& fem);

private:
    std::weak_ptr<const bullet_fem::BodyModel> m_model;  // as of the last look
    bullet_fem::Vec3 m_gravity;                          // likewise
    bool m_isTooSoft = false;
};
