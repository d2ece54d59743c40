// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "benchmarks/stiffness/stiffness_case.h"
#include "bullet_fem/fem/body/body.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

/// A body without pins, factored for implicit Euler.
Body makeFreeBody(const TetMesh& mesh, const StiffnessCase& of);

/// A cube between jaws, solved by ContactSolver at its defaults: one contact for each node of two faces, in double
/// precision, with the last step's impulses as warm start.
CubeFigures pressBySolver(const StiffnessCase& of);

}  // namespace bullet_fem
