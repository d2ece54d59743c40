// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "plugin/scenes/random_program.h"

namespace bullet_fem
{

/// Prints an act and the resulting state of each body: mass [kg], centre [m], the fastest node and its speed [m/s],
/// kinetic energy [J], pinned nodes, anchors, flags and iterations of the last step; for rigid bodies mass, position,
/// velocities [m/s], [rad/s].
void printTrace(int act, RandomProgram& program);

}  // namespace bullet_fem
