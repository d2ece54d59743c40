// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/record/btFemCoupling.h"

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/btFemSoftBodySolver.h"

namespace
{

const btFemSoftBodySolver* femSolverOf(const btSoftBody& body)
{
    return dynamic_cast<const btFemSoftBodySolver*>(body.getSoftBodySolver());
}

}  // namespace

const btFemBodyRecord* btFemCoupling::recordOf(const btSoftBody& body)
{
    const btFemSoftBodySolver* solver = femSolverOf(body);
    return solver ? record(*solver, body) : nullptr;
}

std::shared_ptr<btFemManifolds> btFemCoupling::manifoldsOf(const btSoftBody& body)
{
    const btFemSoftBodySolver* solver = femSolverOf(body);
    return solver ? manifolds(*solver) : nullptr;
}
