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

/// Initial state of a soft body; its mesh is the rest shape in world coordinates.
struct SoftPart
{
    TetMesh m_mesh;
    std::vector<int> m_pinned;  ///< fixed nodes
    Vec3 m_velocity;            ///< of all nodes [m/s]
};

/// Initial state of a rigid box aligned with the world's axes.
struct BoxPart
{
    Vec3 m_center;       ///< [m]
    Vec3 m_halfExtents;  ///< [m], each > 0
    double m_mass = 0;   ///< [kg]; 0 is static
    Vec3 m_velocity;     ///< [m/s]
};

/// A scene for both engines: equal meshes, material, friction and step.
struct ContactScene
{
    std::string m_name;
    Material m_material;             ///< of all soft bodies
    Vec3 m_gravity = {0, 0, -9.81};  ///< [m/s2]
    double m_friction = 0.5;         ///< of every pair [-]
    double m_size = 1;               ///< length of the soft body to which its penetration is compared [m]
    double m_cellSize = 0;           ///< of the mesh [m]
    double m_step = 1.0 / 60;        ///< h [s]
    int m_steps = 45;                ///< number of steps
    std::vector<SoftPart> m_soft;
    std::vector<BoxPart> m_boxes;

    int tetCount() const;
    int nodeCount() const;
    /// True if total momentum is conserved: no gravity, no pinned nodes, no static boxes.
    bool isFree() const;
};

/// True if a block of about `tets` elements can rest on about `contacts` nodes: at most the nodes of a plate of one
/// layer, and at least a fifteenth of a cube's lower nodes, below which it would be crushed.
bool hasBlock(int contacts, int tets);

/// A block of about `tets` elements with 5 cm cells, dropped by 5 mm onto a static box that supports about `contacts`
/// nodes of its lower side: a cube on a pedestal, or a slab on a floor if a cube has too few nodes. Throws
/// std::invalid_argument unless hasBlock(contacts, tets).
ContactScene blockOnBox(int contacts, int tets);

/// Cost of steady contact: a column of about `tets` elements with 5 cm cells and a square foot of about `contacts`
/// nodes, at rest on a static box. `pinned`: the foot is fixed and there is no box, which gives the same body and load
/// without contact.
ContactScene columnOnBox(int contacts, int tets, bool pinned);

/// A soft ball of 1 m and a rigid cube of `massRatio` times its mass collide off-centre at 1 m/s in zero gravity, with
/// friction. `cells` along the ball's diameter, even.
ContactScene ballAndCube(double massRatio, int cells);

/// Two slabs face to face with about `contacts` nodes each. The lower one is fixed at its lower side; the upper one is
/// dropped by 5 mm and shifted by a fraction of a cell, so that no two nodes coincide.
ContactScene slabOnSlab(int contacts);

/// From below: floor, soft slab, rigid box of 50 times its mass, soft slab, rigid box. The lower slab is compressed by
/// 8 %.
ContactScene rigidOnSoftStack(int cells);

}  // namespace bullet_fem
