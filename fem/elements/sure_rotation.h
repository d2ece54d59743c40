// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/elements/element_blocks.h"

namespace bullet_fem
{

/// The polar rotation of one of kLanes matrices (row-major, a lane each) by polarRotation(); `guess` where the matrix
/// is not finite. Of its two quaternions the one on the side of `guess`, so that signs stay as they are from step to
/// step.
template <class Real>
BasicQuaternion<Real> sureRotation(const Real (*F)[kLanes], int lane, const BasicQuaternion<Real>& guess);

}  // namespace bullet_fem
