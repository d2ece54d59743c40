// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/body/body.h"
#include "bullet_fem/fem/common/export.h"

namespace bullet_fem
{

/// Sets the initial stress of a body (setInitialStress) to m_actuators.m_ownStress plus the stresses of its fibres and
/// expansions. To be called after every change of these, and after a change of material, on which the stress of
/// expansions depends. Throws std::invalid_argument, naming the value, if a component leaves [-1e13, 1e13] Pa; the body
/// is unchanged then. Allocates.
BULLETFEM_API void applyActiveStress(Body& body);

}  // namespace bullet_fem
