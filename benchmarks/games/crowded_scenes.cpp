// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Scenes that strain the contact solver: large mass ratios, overlaps, many joints, many bodies.
#include <string>

#include "benchmarks/games/game_scene.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/fem/mesh/generators.h"

namespace bullet_fem
{
namespace
{

btVector3 vector(double x, double y, double z)
{
    return {btScalar(x), btScalar(y), btScalar(z)};
}

void addGround(GameWorld& world)
{
    world.addRigid(new btBoxShape(vector(20, 1, 20)), 0, vector(0, -1, 0), 0.7);
}

btSoftBody& addCube(GameWorld& world, double edge, int cells, const btVector3& center, double youngModulus)
{
    const Vec3 size = {edge, edge, edge};
    btSoftBody* cube = btFemHelpers::createFromTetMesh(world.info(), makeBox(size, {cells, cells, cells}, -0.5 * size));
    cube->translate(center);
    return world.addSoft(cube, youngModulus, 1000, 0.5);
}

void addRigidCube(GameWorld& world, double edge, double mass, const btVector3& center)
{
    world.addRigid(new btBoxShape(vector(edge / 2, edge / 2, edge / 2)), mass, center, 0.7);
}

void buildLightBoxes(GameWorld& world)
{
    addGround(world);
    for (int k = 0; k < 10; ++k)
    {
        const btVector3 center = vector(0, 0.251 + 0.502 * k, 0);
        if (k % 2 == 0)
            addCube(world, 0.5, 3, center, 1e6);
        else
            addRigidCube(world, 0.5, 2.5, center);
    }
}

void buildHeavyOnLight(GameWorld& world, double mass)
{
    addGround(world);
    addCube(world, 0.1, 4, vector(0, 0.051, 0), 1e7);
    addRigidCube(world, 0.2, mass, vector(0, 0.203, 0));
}

void buildJam(GameWorld& world)
{
    addGround(world);
    for (int i = 0; i < 18; ++i)
        addCube(world, 0.5, 4, vector(0.435 * (i % 3 - 1), 0.25 + 0.435 * (i / 9), 0.435 * (i / 3 % 3 - 1)), 1e6);
}

void buildManyAnchors(GameWorld& world)
{
    btRigidBody& holder = world.addRigid(new btBoxShape(vector(1, 0.1, 1)), 0, vector(0, 2.1, 0), 0.5);
    const Vec3 size = {1.5, 0.1, 1.5};
    btSoftBody* plate = btFemHelpers::createFromTetMesh(world.info(), makeBox(size, {31, 1, 31}, -0.5 * size));
    plate->translate(vector(0, 1.95, 0));
    world.addSoft(plate, 1e6, 1000, 0.5);
    for (int i = 0; i < plate->m_nodes.size(); ++i)
        if (plate->m_nodes[i].m_x.y() > btScalar(1.95)) plate->appendAnchor(i, &holder, true);
}

void buildCells(GameWorld& world, int activation)
{
    addGround(world);
    for (int i = 0; i < 1000; ++i)
        addCube(world, 0.1, 1, vector(0.2 * (i % 32 - 16), 0.05, 0.2 * (i / 32 - 16)), 1e6)
            .setActivationState(activation);
}

}  // namespace

GameScene lightBoxes()
{
    return sceneOf("light boxes", 300, 1, false, buildLightBoxes);
}

GameScene heavyOnLight(int mass)
{
    return sceneOf(std::to_string(mass) + " kg on 1 kg", 120, 1, false,
                   [mass](GameWorld& world) { buildHeavyOnLight(world, mass); });
}

GameScene jam()
{
    return sceneOf("jam of 18", 120, 1, false, buildJam);
}

GameScene manyAnchors()
{
    return sceneOf("anchored by 1024", 60, 1, true, buildManyAnchors);
}

GameScene cellsAtRest()
{
    return sceneOf("1000 cells", 240, 1, false, [](GameWorld& world) { buildCells(world, ACTIVE_TAG); });
}

GameScene cellsAsleep()
{
    return sceneOf("1000 cells asleep", 240, 1, false, [](GameWorld& world) { buildCells(world, ISLAND_SLEEPING); });
}

}  // namespace bullet_fem
