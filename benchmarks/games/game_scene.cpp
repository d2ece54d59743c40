// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/games/game_scene.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/fem/mesh/generators.h"

namespace bullet_fem
{
namespace
{

btVector3 at(double x, double y, double z)
{
    return {btScalar(x), btScalar(y), btScalar(z)};
}

// A block centred on the origin.
btSoftBody* makeBlock(GameWorld& world, const Vec3& size, const std::array<int, 3>& cells)
{
    return btFemHelpers::createFromTetMesh(world.info(), makeBox(size, cells, -0.5 * size));
}

btRigidBody& addFloor(GameWorld& world, double friction)
{
    return world.addRigid(new btBoxShape(at(10, 1, 10)), 0, at(0, -1, 0), friction);
}

void buildPit(GameWorld& world)
{
    addFloor(world, 1);
    for (int k = 0; k < 4; ++k)
    {
        const double side = k % 2 == 0 ? 2.2 : -2.2;
        const bool alongX = k < 2;
        world.addRigid(new btBoxShape(alongX ? at(0.5, 3, 3) : at(3, 3, 0.5)), 0,
                       alongX ? at(side, 2, 0) : at(0, 2, side), 1);
    }
    for (int i = 0; i < 10; ++i)
    {
        btSoftBody* body = i % 2 == 1 ? btFemHelpers::createFromTetMesh(world.info(), makeSphere(0.3, 5))
                                      : makeBlock(world, {0.6, 0.5, 0.6}, {6, 6, 6});
        body->translate(at((i % 3 - 1) * 0.9, 0.6 + 0.8 * (i / 3), (i / 2 % 3 - 1) * 0.9));
        world.addSoft(body, 5e5, 1000, 0.5);
    }
    for (int i = 0; i < 50; ++i)
    {
        btCollisionShape* shape = nullptr;
        if (i % 3 == 0)
            shape = new btSphereShape(btScalar(0.15));
        else if (i % 3 == 1)
            shape = new btBoxShape(at(0.15, 0.15, 0.15));
        else
            shape = new btCapsuleShape(btScalar(0.1), btScalar(0.2));
        world.addRigid(shape, 10, at((i % 5 - 2) * 0.6, 3 + 0.5 * (i / 10), (i / 5 % 5 - 2) * 0.6), 0.7);
    }
}

// Spreads the anchors over the upper face.
void anchorTop(btSoftBody& block, btRigidBody& holder, int anchors)
{
    std::vector<int> top;
    btScalar height = 0;
    for (int i = 0; i < block.m_nodes.size(); ++i) height = std::max(height, block.m_nodes[i].m_x.y());
    for (int i = 0; i < block.m_nodes.size(); ++i)
        if (block.m_nodes[i].m_x.y() > height - btScalar(1e-4)) top.push_back(i);
    const double every = double(top.size()) / std::min<double>(anchors, double(top.size()));
    for (double k = 0; k < double(top.size()); k += every)
        block.appendAnchor(top[static_cast<std::size_t>(k)], &holder, true);
}

void buildAnchored(GameWorld& world, int anchors)
{
    btRigidBody& holder = world.addRigid(new btBoxShape(at(0.5, 0.1, 0.5)), 0, at(0, 2.1, 0), 0.5);
    btSoftBody* block = makeBlock(world, {1, 0.4, 1}, {10, 4, 10});
    block->translate(at(0, 1.8, 0));
    anchorTop(world.addSoft(block, 1e6, 1000, 0.5), holder, anchors);
}

void buildMat(GameWorld& world, int cells)
{
    addFloor(world, 0.5);
    btSoftBody* sheet = makeBlock(world, {1, 0.05, 1}, {cells, 1, cells});
    sheet->translate(at(0, 0.03, 0));
    world.addSoft(sheet, 1e6, 1000, 0.5).setVelocity(at(1, 0, 0.3));
}

// Closes both plates by 3 cm each within a second, then lifts them by 0.3 m.
void drivePinch(GameWorld& world, double time)
{
    const double in = 0.09 * std::min(time, 1.0), up = 0.3 * std::clamp(time - 1, 0.0, 1.0);
    for (int k = 0; k < 2; ++k)
    {
        btRigidBody& plate = *world.world().rigid()[static_cast<std::size_t>(k) + 1];
        const double side = k == 0 ? -1 : 1;
        plate.setWorldTransform(btTransform(btQuaternion::getIdentity(), at((0.36 - in) * side, 0.35 + up, 0)));
        plate.setLinearVelocity(at(time < 1 ? -0.09 * side : 0, time >= 1 && time < 2 ? 0.3 : 0, 0));
    }
}

void buildPinch(GameWorld& world)
{
    btSoftBody* block = makeBlock(world, {0.5, 0.5, 0.5}, {10, 8, 10});
    block->translate(at(0, 0.3, 0));
    world.addSoft(block, 1e5, 1000, 10);
    addFloor(world, 1);
    for (const double side : {-1.0, 1.0})
    {
        btRigidBody& plate = world.addRigid(new btBoxShape(at(0.05, 0.3, 0.3)), 0, at(0.36 * side, 0.35, 0), 10);
        plate.setCollisionFlags(plate.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
        plate.setActivationState(DISABLE_DEACTIVATION);
    }
    world.setDrive(drivePinch);
}

void buildTower(GameWorld& world)
{
    addFloor(world, 1);
    for (int k = 0; k < 20; ++k)
    {
        btSoftBody* cube = makeBlock(world, {0.5, 0.5, 0.5}, {3, 3, 3});
        cube->translate(at(0, 0.251 + 0.501 * k, 0));
        world.addSoft(cube, 2e8, 1000, 0.5);
    }
}

}  // namespace

GameScene sceneOf(const std::string& name, int frames, int subSteps, bool carriesItsWeight,
                  const std::function<void(GameWorld&)>& build)
{
    GameScene scene;
    scene.m_name = name;
    scene.m_frames = frames;
    scene.m_subSteps = subSteps;
    scene.m_carriesItsWeight = carriesItsWeight;
    scene.m_start = [build](const GameSettings& settings)
    {
        auto world = std::make_unique<GameWorld>(settings);
        build(*world);
        return world;
    };
    return scene;
}

GameScene pit(int subSteps)
{
    return sceneOf(subSteps == 1 ? "pit" : "pit at 240 Hz", 480 / subSteps, subSteps, false, buildPit);
}

GameScene anchored(int anchors)
{
    const auto build = [anchors](GameWorld& world) { buildAnchored(world, anchors); };
    return sceneOf("anchored by " + std::to_string(anchors), 120, 1, true, build);
}

GameScene mat(int cells)
{
    const auto build = [cells](GameWorld& world) { buildMat(world, cells); };
    return sceneOf("mat of " + std::to_string((cells + 1) * (cells + 1)), 60, 1, true, build);
}

GameScene pinch()
{
    return sceneOf("pinch", 150, 4, true, buildPinch);
}

GameScene tower()
{
    return sceneOf("tower of 20", 600, 1, true, buildTower);
}

std::vector<GameScene> gameScenes(const std::string& bulletSource)
{
    return {pit(1),
            pit(4),
            anchored(9),
            anchored(121),
            mat(20),
            mat(39),
            pinch(),
            tower(),
            lightBoxes(),
            heavyOnLight(200),
            heavyOnLight(1000),
            jam(),
            manyAnchors(),
            cellsAtRest(),
            cellsAsleep(),
            car(),
            balls(false),
            balls(true),
            pinchFriction(bulletSource),
            tetraBunny(bulletSource)};
}

}  // namespace bullet_fem
