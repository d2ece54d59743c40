// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>

#include "BulletSoftBody/btSoftRigidDynamicsWorld.h"
#include "bullet_fem/btFemMaterial.h"

namespace bullet_fem
{

/// How Bullet's own soft body is set up. The defaults are those of Bullet's SoftDemo for meshes of tetrahedra (a link
/// an edge at full stiffness, 16 clusters that collide), but for the iterations, of which it takes one or two.
struct SpringSettings
{
    double m_linear = 1;    ///< kLST, the share of a link's error that an iteration corrects [-], in [0, 1]
    int m_iterations = 10;  ///< piterations, >= 1
    int m_clusters = 16;    ///< that collide with rigid bodies; 0: nodes collide with distance fields (SDF_RS)
};

/// One side of the comparison: a world of Bullet whose soft body solver is Bullet's own or ours.
class ComparedSide
{
public:
    virtual ~ComparedSide() = default;
    virtual btSoftRigidDynamicsWorld& world() = 0;
    /// A rigid body of that mass [kg], 0 for a static one; it takes over the shape.
    virtual btRigidBody& addRigid(btCollisionShape* shape, double mass, const btTransform& pose, double friction) = 0;
    /// Takes over a body made by btFemHelpers. Bullet's own has the material's density alone: its springs know no
    /// modulus.
    virtual btSoftBody& addSoft(btSoftBody* body, const btFemMaterial& material, double friction) = 0;
};

std::unique_ptr<ComparedSide> makeBulletSide(const SpringSettings& settings);
std::unique_ptr<ComparedSide> makeFemSide();

}  // namespace bullet_fem
