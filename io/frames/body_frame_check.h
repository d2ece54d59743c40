// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/io/body_frame.h"

namespace bullet_fem
{

/// Throws std::invalid_argument, with `caller` in the message, on arrays of different length, an index out of range, or
/// a number that single precision cannot represent.
void checkFrame(const char* caller, const std::vector<BodyFrame>& bodies);

/// Throws std::invalid_argument, with `caller` in the message, unless the time [s] is finite.
void checkTime(const char* caller, double time);

}  // namespace bullet_fem
