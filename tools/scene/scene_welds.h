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

/// A soft body of a scene in pieces.
struct CutSceneBody
{
    std::vector<btFemPiece> m_pieces;                   ///< as they were cut
    std::vector<std::unique_ptr<btSoftBody>> m_bodies;  ///< theirs, until the world takes them
};

/// Cuts a body, which stands where it starts, into its scene's Voronoi cells. Throws std::invalid_argument on more
/// cells than tetrahedra.
CutSceneBody cutBody(const btSoftBody& whole, const ScenePieces& pieces);

/// Welds the pieces, which must be FEM, to each other. Throws what btFemWelds::weldPieces throws.
void weldPieces(btFemSoftBodySolver& fem, const std::vector<btFemPiece>& pieces, const SceneWeldStrength& strength);

/// Welds every body of `a` to every one of `b` with which it has faces in common. Throws std::runtime_error, which
/// names both, where none has one.
void addWeld(btFemSoftBodySolver& fem, const std::vector<btSoftBody*>& a, const std::vector<btSoftBody*>& b,
             const SceneWeld& from);

}  // namespace bullet_fem
