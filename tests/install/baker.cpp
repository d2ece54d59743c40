// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// A baking tool: bakes a body to <argument>.bfem, and writes to <argument>.bits the final coordinates of an unbaked
// body that is dropped.
#ifdef BULLETFEM_AMALGAM
#include "bullet_fem_runtime.h"
#else
#include <bullet_fem/btFemHelpers.h>
#include <bullet_fem/fem/baked/baked_body.h>
#include <bullet_fem/fem/mesh/generators.h>
#endif

#include "drop_bits.h"

int main(int argc, char** argv)
{
    if (argc != 2) return 2;
    const std::string name = argv[1];
    const bullet_fem::TetMesh mesh = bullet_fem::makeBox({.6, .4, .4}, {6, 4, 4}, {.1, .3, -.2});
    bullet_fem::BakeSettings settings;
    settings.m_material = bullet_fem::Material::rubber();
    settings.m_material.m_stiffnessDamping = .005;  // as in a btFemMaterial
    settings.m_singlePrecision = sizeof(btScalar) == sizeof(float);
    bullet_fem::writeBakedBody(name + ".bfem", bullet_fem::bakeBody(mesh, settings));

    DropWorld world;
    btSoftBody* body = btFemHelpers::createFromTetMesh(world.m_world.getWorldInfo(), mesh);
    world.m_fem.setMaterial(body, btFemMaterial::rubber());
    world.m_fem.prepare(body, btScalar(1) / 60);
    std::ofstream(name + ".bits") << world.bitsAfterDrop(body);
    return world.m_touches && !world.m_baked ? 0 : 1;
}
