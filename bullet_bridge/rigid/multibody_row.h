// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cmath>

#include "BulletDynamics/Featherstone/btMultiBody.h"
#include "BulletDynamics/Featherstone/btMultiBodyConstraint.h"
#include "BulletDynamics/Featherstone/btMultiBodySolverConstraint.h"
#include "bullet_bridge/rigid/multibody_dynamics.h"
#include "bullet_bridge/rigid/row_parts.h"

namespace bullet_fem
{

/// A row of Bullet's multibody solver.
using MultiBodyRow = btMultiBodySolverConstraint;

/// Coordinates of a multibody: those of its base and its joints.
inline int coordinatesOf(const btMultiBody& body)
{
    return kBaseCoordinates + body.getNumDofs();
}

/// True if both sides of a row belong to one multibody.
inline bool isOneBody(const MultiBodyRow& row)
{
    return row.m_multiBodyA && row.m_multiBodyA == row.m_multiBodyB;
}

/// Velocity of a row before the solve, of its multibodies [m/s] or [rad/s].
double velocityOf(const btMultiBodyJacobianData& data, const MultiBodyRow& row);

/// True if the row's Jacobians and responses are finite.
bool isFiniteRow(const btMultiBodyJacobianData& data, const MultiBodyRow& row);

/// Gives a row without impulse one [N s] or [N m s], also to its multibodies, whose worlds add it to their velocities
/// after Bullet's solver.
void setImpulse(const btMultiBodyJacobianData& data, const MultiBodyRow& row, double impulse);

}  // namespace bullet_fem
