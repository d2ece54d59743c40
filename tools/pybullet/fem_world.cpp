// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem_world.h"

#include <string>

#include "Bullet3Common/b3Logging.h"
#include "bullet_fem/btFemDeformableBodySolver.h"
#include "bullet_fem/btFemDeformableConstraintSolver.h"
#include "bullet_fem/btFemWorldState.h"

namespace fem_world
{

btDeformableMultiBodyConstraintSolver* replaceSolvers(btDeformableBodySolver*& bodies,
                                                      btDeformableMultiBodyConstraintSolver* constraints)
{
    delete constraints;
    delete bodies;
    auto* fem = new btFemDeformableBodySolver();
    bodies = fem;
    return new btFemDeformableConstraintSolver(fem);
}

bool save(btDiscreteDynamicsWorld& world, const btDeformableBodySolver* bodies, std::vector<unsigned char>& bytes)
{
    if (!bodies) return true;
    std::string why;
    const auto* fem = static_cast<const btFemDeformableBodySolver*>(bodies);
    if (btFemWorldState::save(world, fem->fem(), bytes, &why)) return true;
    b3Error("saveState: %s\n", why.c_str());
    return false;
}

bool restore(btDiscreteDynamicsWorld& world, btDeformableBodySolver* bodies, const std::vector<unsigned char>& bytes)
{
    if (!bodies) return true;
    std::string why;
    auto* fem = static_cast<btFemDeformableBodySolver*>(bodies);
    if (btFemWorldState::restore(world, fem->fem(), bytes.data(), bytes.size(), &why)) return true;
    b3Error("restoreState: %s\n", why.c_str());
    return false;
}

}  // namespace fem_world
