// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/elements/element_blocks.h"

namespace bullet_fem
{

/// The polar rotation of one of kLanes matrices (row-major, a lane each) by polarRotation(); `guess` if the matrix is
/// not finite. Among the two quaternions it returns the one in the hemisphere of `guess`, so that signs persist from
/// step to step.
template <class Real>
BasicQuaternion<Real> robustPolar(const Real (*F)[kLanes], int lane, const BasicQuaternion<Real>& guess);

}  // namespace bullet_fem
