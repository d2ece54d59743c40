// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/scene_weld_reader.h"

#include <limits>

namespace bullet_fem
{
namespace
{

void readStrength(const JsonCursor& at, SceneWeldStrength& strength)
{
    at.read("breakForce", {0, 1e12, true}, strength.m_breakForce);
    at.read("breakStress", {0, 1e13, true}, strength.m_breakStress);
    at.read("breakStretch", {0, 1e6, true}, strength.m_breakStretch);
    at.read("compliance", {0, 1}, strength.m_compliance);
}

}  // namespace

ScenePieces readPieces(const JsonCursor& at, SceneMesh::Kind mesh)
{
    if (mesh == SceneMesh::Kind::surface || mesh == SceneMesh::Kind::baked)
        at.fail("are given, but what is embedded or baked is not cut; take a box, sphere, cylinder or tetrahedra");
    at.onlyMembers({"cells", "seed", "breakForce", "breakStress", "breakStretch", "compliance"});
    ScenePieces pieces;
    pieces.m_cells = at["cells"].integer(2, 100000);
    at.read("seed", 0, std::numeric_limits<int>::max(), pieces.m_seed);
    readStrength(at, pieces.m_strength);
    return pieces;
}

SceneFracture readFracture(const JsonCursor& at, SceneMesh::Kind mesh)
{
    if (mesh == SceneMesh::Kind::surface)
        at.fail("is given, but what is embedded does not split; take a box, sphere, cylinder or tetrahedra");
    at.onlyMembers({"tension", "mostCracks", "partsTouch"});
    SceneFracture fracture;
    fracture.m_tension = at["tension"].number({0, 1e13, true});
    at.read("mostCracks", 1, 1000, fracture.m_mostCracks);
    at.read("partsTouch", fracture.m_partsTouch);
    return fracture;
}

SceneWeld readWeld(const JsonCursor& at)
{
    at.onlyMembers({"a", "b", "reach", "breakForce", "breakStress", "breakStretch", "compliance"});
    SceneWeld weld;
    weld.m_a = at["a"].text();
    weld.m_b = at["b"].text();
    at.read("reach", {0, 1e3, true}, weld.m_reach);
    readStrength(at, weld.m_strength);
    return weld;
}

}  // namespace bullet_fem
