// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <vector>

#include "bullet_bridge/geometry/surface/surface_tree.h"

class btSoftBody;

namespace bullet_fem
{

/// True of a btSoftBody that Bullet moves as nodes and springs: cloth, ropes, shells.
bool isCloth(const btSoftBody& body);

/// A cloth in a step, after Bullet has moved it: its nodes are particles, its faces, or the links of a rope, are what
/// vertices of FEM bodies touch. Grows with the numbers of nodes and faces only.
class ClothSurface
{
public:
    explicit ClothSurface(btSoftBody& cloth);

    btSoftBody& body() const { return *m_cloth; }
    int id() const { return m_id; }  ///< in the broadphase, as it was made

    /// Takes the nodes as they are now; a step that Bullet did not give the cloth is `worldStep` [s]. False if a node
    /// is not usable.
    bool update(double worldStep);

    double step() const { return m_step; }            ///< of the cloth [s]
    double thickness() const { return m_thickness; }  ///< its collision margin: surfaces stay as far off its nodes [m]
    int nodeCount() const { return static_cast<int>(m_position.size()); }

    /// Per node: as the step begins [m]; h v [m]; v [m/s]; 1/m [1/kg], 0 of those that nothing moves.
    const std::vector<Vec3>& position() const { return m_position; }
    const std::vector<Vec3>& change() const { return m_change; }
    const std::vector<Vec3>& velocity() const { return m_velocity; }
    const std::vector<double>& inverseMass() const { return m_inverseMass; }

    const std::vector<Triangle>& triangles() const { return m_triangles; }  ///< a link's last two corners are the same
    const SurfaceTree* tree() const { return m_tree.get(); }                ///< over the triangles; null if none

    /// Adds an impulse to a node [N s], and a displacement [m]. What is not finite or too fast is left out.
    void move(int node, const Vec3& impulse, const Vec3& displacement);

private:
    void readTriangles();

    btSoftBody* m_cloth;
    int m_id;
    double m_step = 0, m_thickness = 0;
    std::vector<Vec3> m_position, m_change, m_velocity;
    std::vector<double> m_inverseMass;
    std::vector<Triangle> m_triangles, m_built;  // as they are; those of the tree
    std::unique_ptr<SurfaceTree> m_tree;
};

}  // namespace bullet_fem
