// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "python/core/bullet_world.h"

#include <memory>
#include <type_traits>

#include "BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h"
#include "BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h"
#include "BulletSoftBody/btSoftMultiBodyDynamicsWorld.h"
#include "BulletSoftBody/btSoftRigidDynamicsWorld.h"
#include "bullet_fem/btFemConstraintSolver.h"
#include "bullet_fem/btFemMultiBodyConstraintSolver.h"
#include "tools/scene/scene_reader.h"
#include "tools/scene/scene_world.h"

namespace bullet_fem::python
{
namespace
{

// Manifolds and algorithms in the pools of a world; more are allocated one by one. Bullet's 4096 take 7 MB.
constexpr int kPooledPairs = 64;

btDefaultCollisionConstructionInfo smallPools()
{
    btDefaultCollisionConstructionInfo info;
    info.m_defaultMaxPersistentManifoldPoolSize = info.m_defaultMaxCollisionAlgorithmPoolSize = kPooledPairs;
    return info;
}

template <class World, class RigidSolver>
class OwnWorld : public BulletWorld
{
public:
    explicit OwnWorld(const btFemSolverInfo& info)
        : m_fem(info),
          m_rigidSolver(makeSolver()),
          m_world(&m_dispatcher, &m_broadphase, m_rigidSolver.get(), &m_configuration, &m_fem)
    {
        m_configuration.setPlaneConvexMultipointIterations();  // otherwise boxes get one contact point and penetrate
    }

    btDiscreteDynamicsWorld& world() override { return m_world; }
    btSoftBodyWorldInfo& info() override { return m_world.getWorldInfo(); }
    btFemSoftBodySolver& fem() override { return m_fem; }
    void add(btSoftBody& body, int group, int mask) override { m_world.addSoftBody(&body, group, mask); }
    void remove(btSoftBody& body) override { m_world.removeSoftBody(&body); }

private:
    std::unique_ptr<RigidSolver> makeSolver()
    {
        if constexpr (std::is_constructible_v<RigidSolver, btFemSoftBodySolver*>)
            return std::make_unique<RigidSolver>(&m_fem);
        else
            return std::make_unique<RigidSolver>();
    }

    btSoftBodyRigidBodyCollisionConfiguration m_configuration{smallPools()};
    btCollisionDispatcher m_dispatcher{&m_configuration};
    btDbvtBroadphase m_broadphase;
    btFemSoftBodySolver m_fem;
    std::unique_ptr<RigidSolver> m_rigidSolver;
    World m_world;
};

class WorldOfScene : public BulletWorld
{
public:
    explicit WorldOfScene(const std::string& path) : m_scene(readScene(path)) {}

    btDiscreteDynamicsWorld& world() override { return m_scene.world(); }
    btSoftBodyWorldInfo& info() override { return m_scene.world().getWorldInfo(); }
    btFemSoftBodySolver& fem() override { return m_scene.fem(); }
    void add(btSoftBody& body, int group, int mask) override { m_scene.world().addSoftBody(&body, group, mask); }
    void remove(btSoftBody& body) override { m_scene.world().removeSoftBody(&body); }
    void step(double) override { m_scene.step(); }
    SceneWorld* scene() override { return &m_scene; }

private:
    SceneWorld m_scene;
};

}  // namespace

std::unique_ptr<BulletWorld> makeWorld(WorldKind kind, const btFemSolverInfo& info)
{
    switch (kind)
    {
        case WorldKind::swap:
            return std::make_unique<OwnWorld<btSoftRigidDynamicsWorld, btSequentialImpulseConstraintSolver>>(info);
        case WorldKind::multibody:
            return std::make_unique<OwnWorld<btSoftMultiBodyDynamicsWorld, btFemMultiBodyConstraintSolver>>(info);
        default:
            return std::make_unique<OwnWorld<btSoftRigidDynamicsWorld, btFemConstraintSolver>>(info);
    }
}

std::unique_ptr<BulletWorld> readSceneWorld(const std::string& path)
{
    return std::make_unique<WorldOfScene>(path);
}

}  // namespace bullet_fem::python
