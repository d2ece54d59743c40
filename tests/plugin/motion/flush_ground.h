// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "plugin/scenes/soft_world.h"

class btTriangleMesh;

namespace bullet_fem
{

/// What a flat ground is made of.
enum class Ground
{
    oneBox,
    boxes,
    compound,
    hulls,
    kinematicBoxes,
    meshTiles,
    meshBoxes,
    heightfield,
    mesh  ///< one, whose squares have their diagonals in turn
};

std::string groundName(Ground ground);

/// A ground whose surface is the plane z = 0, in pieces of half a metre along x, whose seams are at whole and half
/// metres. The pieces from `edge` [m] on lie `down` [m] lower (negative: higher); a heightfield, a mesh and one box are
/// flat.
class FlushGround
{
public:
    FlushGround(FemWorld& world, Ground ground, double edge = 0, double down = 0);
    ~FlushGround();

private:
    void addPiece(FemWorld& world, Ground ground, const btVector3& center);
    btTriangleMesh& newMesh();

    std::vector<std::unique_ptr<btTriangleMesh>> m_meshes;  // the shapes refer to them
    std::vector<btScalar> m_heights;                        // as Bullet reads PHY_FLOAT
};

}  // namespace bullet_fem
