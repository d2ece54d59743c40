// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "fem/elements/node_rotations.h"

namespace bullet_fem
{

/// Squared length of the plain sum of V_e q_e around a node below which robustAverage() is needed [m6].
inline float minSquaredLength(const NodeCorners& nodes, int node)
{
    constexpr float kAlignedShare = 0.98f;
    const float least = kAlignedShare * nodes.m_volumeAround[node];
    return least * least;
}

/// R_i of one node in plain double precision, with all safeguards: signs aligned with the first element's quaternion;
/// if the rotations are far apart, polar(sum V_e R_e), and where the sum leaves it undetermined, the solution nearest
/// to the first element's rotation.
NodeRotation robustAverage(const NodeRotations& rotations, int node);

/// The polar rotation of one of kLanes matrices (row-major, a lane each) by polarRotation(); `guess` if the matrix is
/// not finite. Among the two quaternions it returns the one in the hemisphere of `guess`, so that signs persist from
/// step to step.
template <class Real>
BasicQuaternion<Real> robustPolar(const Real (*F)[kLanes], int lane, const BasicQuaternion<Real>& guess);

}  // namespace bullet_fem
