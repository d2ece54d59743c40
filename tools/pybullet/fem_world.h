// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

class btDeformableBodySolver;
class btDeformableMultiBodyConstraintSolver;
class btDiscreteDynamicsWorld;

// Functions that the lines in pybullet's server call (build.py).
namespace fem_world
{

/// Deletes Bullet's two solvers of a deformable world, sets `bodies` to one of FEM bodies, and returns the constraint
/// solver that belongs to it.
btDeformableMultiBodyConstraintSolver* replaceSolvers(btDeformableBodySolver*& bodies,
                                                      btDeformableMultiBodyConstraintSolver* constraints);

/// Saves a world's state to `bytes`; without effect if `bodies` is null, as in worlds without deformables. False, with
/// the reason on Bullet's log, if the world cannot be saved.
bool save(btDiscreteDynamicsWorld& world, const btDeformableBodySolver* bodies, std::vector<unsigned char>& bytes);

/// Restores a world's state from `bytes` of save(); true and false as there.
bool restore(btDiscreteDynamicsWorld& world, btDeformableBodySolver* bodies, const std::vector<unsigned char>& bytes);

}  // namespace fem_world
