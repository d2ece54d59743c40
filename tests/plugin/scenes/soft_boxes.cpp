// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/scenes/soft_boxes.h"

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/mesh/generators.h"

namespace bullet_fem
{

btSoftBody* makeSoftBox(btSoftBodyWorldInfo& info, btFemSoftBodySolver& fem, const SoftBox& box)
{
    btSoftBody* body = btFemHelpers::createFromTetMesh(info, makeBox(box.m_size, box.m_cells));
    if (box.m_turn != 0)
    {
        const btVector3 middle = bulletVector(0.5 * box.m_size);
        body->translate(-middle);
        body->rotate(btQuaternion(btVector3(0, 0, 1), btScalar(box.m_turn)));
        body->translate(middle);
    }
    body->translate(bulletVector(box.m_center - 0.5 * box.m_size));
    body->m_cfg.kDF = box.m_friction;
    btFemMaterial material;
    material.m_youngModulus = box.m_youngModulus;
    material.m_density = box.m_density;
    material.m_bending = box.m_bending;
    fem.setMaterial(body, material);
    return body;
}

btSoftBody* makeSoftBox(SoftWorld& world, btFemSoftBodySolver& fem, const SoftBox& box)
{
    return makeSoftBox(world.info(), fem, box);
}

btSoftBody& addSoftBox(SoftWorld& world, btFemSoftBodySolver& fem, const SoftBox& box)
{
    return world.addSoft(makeSoftBox(world, fem, box));
}

btSoftBody& addUnitCube(SoftWorld& world, const btVector3& center)
{
    return world.addSoft(btFemHelpers::createBox(world.info(), center, btVector3(0.5, 0.5, 0.5), btScalar(0.25)));
}

btSoftBody& addSmallCube(SoftWorld& world, btScalar lowest, btScalar x)
{
    return world.addSoft(btFemHelpers::createBox(world.info(), btVector3(x, 0, lowest + btScalar(0.2)),
                                                 btVector3(0.2, 0.2, 0.2), btScalar(0.1)));
}

void clampBelow(btSoftBody& body, double height)
{
    for (int i = 0; i < body.m_nodes.size(); ++i)
        if (body.m_nodes[i].m_x.z() < height) body.setMass(i, 0);
}

void addWalls(SoftWorld& world, double halfX, double halfY)
{
    for (int side : {-1, 1})
    {
        world.addRigid(new btBoxShape(btVector3(0.5, 4, 4)), {0, at(btScalar(side * (halfX + 0.5)), 0, 4)});
        world.addRigid(new btBoxShape(btVector3(4, 0.5, 4)), {0, at(0, btScalar(side * (halfY + 0.5)), 4)});
    }
}

btRigidBody& addRigidBox(SoftWorld& world, const Vec3& size, const RigidSettings& settings)
{
    return world.addRigid(new btBoxShape(bulletVector(0.5 * size)), settings);
}

}  // namespace bullet_fem
