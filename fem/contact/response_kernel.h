// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>

#include "bullet_fem/fem/vec3.h"

namespace bullet_fem
{

/// velocity_i += w_0i x + w_1i y + w_2i z for i in [0, order), with w_c = columns + c order. On the widest vectors that
/// the processor has.
void addResponse(const float* columns, std::size_t order, const Vec3& impulse, double* velocity);

/// The same in plain C++: what the kernel is tested against.
namespace scalar
{
void addResponse(const float* columns, std::size_t order, const Vec3& impulse, double* velocity);
}  // namespace scalar

}  // namespace bullet_fem
