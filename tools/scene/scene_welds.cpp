// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/scene_welds.h"

#include <stdexcept>
#include <string>

namespace bullet_fem
{
namespace
{

btFemWeldStrength strengthOf(const SceneWeldStrength& from)
{
    btFemWeldStrength strength;
    strength.m_breakForce = btScalar(from.m_breakForce);
    strength.m_breakStress = btScalar(from.m_breakStress);
    strength.m_breakStretch = btScalar(from.m_breakStretch);
    strength.m_compliance = btScalar(from.m_compliance);
    return strength;
}

}  // namespace

CutSceneBody cutBody(const btSoftBody& whole, const ScenePieces& pieces)
{
    CutSceneBody result;
    std::vector<int> labels;
    btFemPieces::voronoiLabels(&whole, pieces.m_cells, static_cast<unsigned>(pieces.m_seed), labels);
    btFemPieces::cut(&whole, labels, result.m_pieces);
    for (const btFemPiece& piece : result.m_pieces) result.m_bodies.emplace_back(piece.m_body);
    return result;
}

void weldPieces(btFemSoftBodySolver& fem, const std::vector<btFemPiece>& pieces, const SceneWeldStrength& strength)
{
    btFemWelds::weldPieces(fem, pieces, strengthOf(strength));
}

void addWeld(btFemSoftBodySolver& fem, const std::vector<btSoftBody*>& a, const std::vector<btSoftBody*>& b,
             const SceneWeld& from)
{
    const btFemWeldStrength strength = strengthOf(from.m_strength);
    int welds = 0;
    std::string why;
    for (btSoftBody* bodyA : a)
        for (btSoftBody* bodyB : b)
            if (btFemWelds::weld(fem, bodyA, bodyB, strength, btScalar(from.m_reach), &why) > 0) ++welds;
    if (welds == 0) throw std::runtime_error("'" + from.m_a + "': its weld to '" + from.m_b + "': " + why);
}

}  // namespace bullet_fem
