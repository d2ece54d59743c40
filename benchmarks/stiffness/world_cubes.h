// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "benchmarks/benchmark_world.h"
#include "benchmarks/stiffness/stiffness_case.h"

namespace bullet_fem
{

/// A cube between kinematic boxes of a Bullet world, default settings; the force is that on the upper one. `gravity`
/// [m/s2], downwards.
CubeFigures pressInWorld(const StiffnessCase& of, BenchmarkLine line, double gravity);

/// A cube that is set down on a plane and rests under its weight; counts are of the second second.
CubeFigures restOnPlane(const StiffnessCase& of);

}  // namespace bullet_fem
