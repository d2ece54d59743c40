// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>

#include "BulletSoftBody/btSoftRigidDynamicsWorld.h"
#include "bullet_fem/btFemMaterial.h"

namespace bullet_fem
{

/// Settings of Bullet's own soft body. The defaults are those of Bullet's SoftDemo for tetrahedral meshes (a link per
/// edge at full stiffness, 16 clusters that collide) except for the iterations: SoftDemo uses one or two.
struct SpringSettings
{
    double m_linear = 1;    ///< kLST, fraction of a link's error that an iteration corrects [-], in [0, 1]
    int m_iterations = 10;  ///< piterations, >= 1
    int m_clusters = 16;    ///< clusters that collide with rigid bodies; 0: nodes collide with distance fields (SDF_RS)
};

/// One side of the comparison: a Bullet world with Bullet's or BulletFEM's soft body solver.
class ComparedSide
{
public:
    virtual ~ComparedSide() = default;
    virtual btSoftRigidDynamicsWorld& world() = 0;
    /// Adds a rigid body of that mass [kg], 0 for a static one; takes ownership of the shape.
    virtual btRigidBody& addRigid(btCollisionShape* shape, double mass, const btTransform& pose, double friction) = 0;
    /// Takes ownership of a body made by btFemHelpers. Bullet's side uses the material's density alone: its springs
    /// have no modulus.
    virtual btSoftBody& addSoft(btSoftBody* body, const btFemMaterial& material, double friction) = 0;
};

std::unique_ptr<ComparedSide> makeBulletSide(const SpringSettings& settings);
std::unique_ptr<ComparedSide> makeFemSide();

}  // namespace bullet_fem
