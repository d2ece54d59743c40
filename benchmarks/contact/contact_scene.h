// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

#include "bullet_fem/fem/common/vec3.h"
#include "bullet_fem/fem/mesh/material.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

/// A soft body as it starts; its mesh is its rest shape, in world coordinates.
struct SoftPart
{
    TetMesh m_mesh;
    std::vector<int> m_pinned;  ///< nodes that never move
    Vec3 m_velocity;            ///< of all nodes [m/s]
};

/// A rigid box as it starts, axes along the world's.
struct BoxPart
{
    Vec3 m_center;       ///< [m]
    Vec3 m_halfExtents;  ///< [m], each > 0
    double m_mass = 0;   ///< [kg]; 0 is static
    Vec3 m_velocity;     ///< [m/s]
};

/// What both engines run: the same meshes, material, friction and step.
struct ContactScene
{
    std::string m_name;
    Material m_material;             ///< of all soft bodies
    Vec3 m_gravity = {0, 0, -9.81};  ///< [m/s2]
    double m_friction = 0.5;         ///< of every pair [-]
    double m_size = 1;               ///< of the soft body, what its penetration is compared with [m]
    double m_cellSize = 0;           ///< of the mesh [m]
    double m_step = 1.0 / 60;        ///< h [s]
    int m_steps = 45;                ///< to run
    std::vector<SoftPart> m_soft;
    std::vector<BoxPart> m_boxes;

    int tetCount() const;
    int nodeCount() const;
    /// True if nothing takes momentum away: no gravity, nothing pinned or static.
    bool isFree() const;
};

/// True if there is a block of about `tets` elements of which about `contacts` nodes can touch: no more than a plate of
/// one layer has, and no fewer than a fifteenth of a cube's lower nodes, which would be crushed.
bool hasBlock(int contacts, int tets);

/// A block of about `tets` elements, 5 cm cells, dropped by 5 mm onto a static box that about `contacts` nodes of its
/// lower side touch: a cube on a pedestal, or a slab on a floor if a cube has not so many. Throws
/// std::invalid_argument unless hasBlock(contacts, tets).
ContactScene blockOnBox(int contacts, int tets);

/// What steady contact costs: a column of about `tets` elements, 5 cm cells, a square foot of about `contacts` nodes,
/// at rest on a static box; or its foot `pinned` and no box: the same body and load without contact.
ContactScene columnOnBox(int contacts, int tets, bool pinned);

/// A soft ball of 1 m and `massRatio` times its mass in a rigid cube meet at 1 m/s in zero gravity, off-centre, with
/// friction. `cells` along the ball's diameter, even.
ContactScene ballAndCube(double massRatio, int cells);

/// Two slabs face to face, about `contacts` nodes each: the lower one pinned at its lower side, the upper one dropped
/// by 5 mm and shifted by a part of a cell, so that no two nodes meet.
ContactScene slabOnSlab(int contacts);

/// Floor, soft slab, rigid box of 50 times its mass, and both once more: the lower slab is strained by 8 %.
ContactScene rigidOnSoftStack(int cells);

}  // namespace bullet_fem
