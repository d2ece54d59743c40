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

/// Kinds of flat ground.
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
    mesh  ///< a mesh, whose squares have alternating diagonals
};

std::string groundName(Ground ground);

/// A ground with the surface z = 0, in segments of half a metre along x, whose seams are at multiples of half a metre.
/// The segments from x = `edge` [m] on are lower by `down` [m] (negative: higher); a heightfield, a mesh and a single
/// box are flat.
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
