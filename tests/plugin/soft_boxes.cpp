// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/soft_boxes.h"

#include "bullet_bridge/bullet_vectors.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/fem/generators.h"

namespace bullet_fem
{

btSoftBody* makeSoftBox(SoftWorld& world, btFemSoftBodySolver& fem, const SoftBox& box)
{
    btSoftBody* body = btFemHelpers::createFromTetMesh(world.info(), makeBox(box.m_size, box.m_cells));
    body->translate(bulletVector(box.m_center - 0.5 * box.m_size));
    body->m_cfg.kDF = box.m_friction;
    btFemMaterial material;
    material.m_youngModulus = box.m_youngModulus;
    material.m_density = box.m_density;
    fem.setMaterial(body, material);
    return body;
}

btSoftBody& addSoftBox(SoftWorld& world, btFemSoftBodySolver& fem, const SoftBox& box)
{
    return world.addSoft(makeSoftBox(world, fem, box));
}

btRigidBody& addRigidBox(SoftWorld& world, const Vec3& size, const RigidSettings& settings)
{
    return world.addRigid(new btBoxShape(bulletVector(0.5 * size)), settings);
}

}  // namespace bullet_fem
