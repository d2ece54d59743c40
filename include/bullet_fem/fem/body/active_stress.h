// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/body/body.h"
#include "bullet_fem/fem/common/export.h"

namespace bullet_fem
{

/// Sets the initial stress of a body (setInitialStress) to m_actuators.m_ownStress and the stresses of its fibres and
/// expansions: after every change of any of them, and when the body has got another material, with which that of
/// expansions changes. Throws std::invalid_argument,
/// naming the value, if a number leaves [-1e13, 1e13] Pa; the body keeps what it had. Allocates.
BULLETFEM_API void applyActiveStress(Body& body);

}  // namespace bullet_fem
