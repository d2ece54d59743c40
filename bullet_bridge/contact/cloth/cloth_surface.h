// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <vector>

#include "bullet_bridge/geometry/surface/surface_tree.h"

class btSoftBody;

namespace bullet_fem
{

/// True if Bullet simulates the btSoftBody as nodes and springs (cloth, ropes, shells): it has nodes and no tetrahedra.
bool isCloth(const btSoftBody& body);

/// A cloth in a step, after Bullet has moved it. Its nodes are particles. Its faces, or the links of a rope, are the
/// triangles that vertices of FEM bodies are tested against. Memory grows with the numbers of nodes and faces only.
class ClothSurface
{
public:
    explicit ClothSurface(btSoftBody& cloth);

    btSoftBody& body() const { return *m_cloth; }
    int id() const { return m_id; }  ///< broadphase id at construction

    /// Reads the present nodes. Uses `worldStep` [s] where Bullet gave the cloth no step of its own. Returns false if a
    /// node is not finite or too fast.
    bool update(double worldStep);

    double step() const { return m_step; }  ///< time step of the cloth [s]
    /// Collision margin of the cloth [m]; surfaces keep this distance from it.
    double thickness() const { return m_thickness; }
    int nodeCount() const { return static_cast<int>(m_position.size()); }

    /// Per node: position as the step begins [m], displacement h v [m], velocity v [m/s], inverse mass 1/m [1/kg]. The
    /// inverse mass is 0 for fixed nodes and for sleeping cloth.
    const std::vector<Vec3>& position() const { return m_position; }
    const std::vector<Vec3>& change() const { return m_change; }
    const std::vector<Vec3>& velocity() const { return m_velocity; }
    const std::vector<double>& inverseMass() const { return m_inverseMass; }

    const std::vector<Triangle>& triangles() const { return m_triangles; }  ///< a link repeats its last corner
    const SurfaceTree* tree() const { return m_tree.get(); }  ///< over the triangles; null if there are none

    /// Adds an impulse [N s] and a displacement [m] to a node. Ignores them if the result is not finite or too large.
    void move(int node, const Vec3& impulse, const Vec3& displacement);

private:
    void readTriangles();

    btSoftBody* m_cloth;
    int m_id;
    double m_step = 0, m_thickness = 0;
    std::vector<Vec3> m_position, m_change, m_velocity;
    std::vector<double> m_inverseMass;
    std::vector<Triangle> m_triangles, m_built;  // the present triangles; those that the tree was built with
    std::unique_ptr<SurfaceTree> m_tree;
};

}  // namespace bullet_fem
