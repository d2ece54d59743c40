// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstddef>

#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// Lengths of responses are padded to a multiple of this, so that kernels need no remainder loop.
constexpr std::size_t kResponsePadding = 8;

/// The smallest multiple of a number that is not less than a count.
constexpr std::size_t padded(std::size_t count, std::size_t multiple)
{
    return (count + multiple - 1) / multiple * multiple;
}

/// An impulse and the responses to its components: w_c = m_columns + c m_stride.
struct Response
{
    const float* m_columns = nullptr;
    std::size_t m_stride = 0;
    Vec3 m_impulse;
};

/// velocity_i += w_0i x + w_1i y + w_2i z for every response, in their order, for i in [0, order), a multiple of
/// kResponsePadding. On the widest vectors of the processor.
void addResponses(const Response* responses, std::size_t count, std::size_t order, double* velocity);

/// Reference in plain C++, against which the kernel is tested.
namespace scalar
{
void addResponses(const Response* responses, std::size_t count, std::size_t order, double* velocity);
}  // namespace scalar

}  // namespace bullet_fem
