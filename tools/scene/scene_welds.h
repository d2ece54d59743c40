// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <vector>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/btFemWelds.h"
#include "tools/scene/scene_description.h"

namespace bullet_fem
{

/// A soft body of a scene after division into fragments.
struct CutSceneBody
{
    std::vector<btFemPiece> m_pieces;                   ///< result of the cut
    std::vector<std::unique_ptr<btSoftBody>> m_bodies;  ///< bodies of m_pieces, until the world takes ownership
};

/// Cuts a body at its initial pose into Voronoi cells. Throws std::invalid_argument if there are more cells than
/// tetrahedra.
CutSceneBody cutBody(const btSoftBody& whole, const ScenePieces& pieces);

/// Welds the fragments, which must be FEM, to each other. Throws the exceptions of btFemWelds::weldPieces.
void weldPieces(btFemSoftBodySolver& fem, const std::vector<btFemPiece>& pieces, const SceneWeldStrength& strength);

/// Welds each body of `a` to each body of `b` that shares faces with it. Throws std::runtime_error with both names if
/// no pair does.
void addWeld(btFemSoftBodySolver& fem, const std::vector<btSoftBody*>& a, const std::vector<btSoftBody*>& b,
             const SceneWeld& from);

}  // namespace bullet_fem
