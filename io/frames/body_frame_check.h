// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/io/body_frame.h"

namespace bullet_fem
{

/// Throws std::invalid_argument, in the name of `caller`, on arrays of different length, an index out of range, or a
/// number that single precision does not hold.
void checkFrame(const char* caller, const std::vector<BodyFrame>& bodies);

/// The same for a time [s], which must be finite.
void checkTime(const char* caller, double time);

}  // namespace bullet_fem
