// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <string>

#include "BulletSoftBody/btSoftBody.h"
#include "btBulletDynamicsCommon.h"
#include "bullet_fem/btFemSoftBodySolver.h"

namespace bullet_fem
{
class SceneWorld;
}

namespace bullet_fem::python
{

/// One of Bullet's worlds with the solver of its soft bodies.
class BulletWorld
{
public:
    virtual ~BulletWorld() = default;

    virtual btDiscreteDynamicsWorld& world() = 0;
    virtual btSoftBodyWorldInfo& info() = 0;
    virtual btFemSoftBodySolver& fem() = 0;
    virtual void add(btSoftBody& body, int group, int mask) = 0;
    virtual void remove(btSoftBody& body) = 0;
    /// One step of this size [s].
    virtual void step(double size) { world().stepSimulation(btScalar(size), 0); }
    virtual SceneWorld* scene() { return nullptr; }
};

/// Coupling of rigid and soft bodies.
enum class WorldKind
{
    coupled,   ///< within the step (btFemConstraintSolver)
    swap,      ///< rigid bodies first (staggered)
    multibody  ///< as coupled, with multibodies (btFemMultiBodyConstraintSolver)
};

std::unique_ptr<BulletWorld> makeWorld(WorldKind kind, const btFemSolverInfo& info);

/// A world with the bodies of a scene file. Throws the exceptions of readScene and of SceneWorld.
std::unique_ptr<BulletWorld> readSceneWorld(const std::string& path);

/// Throws std::runtime_error if another extension of this process has Bullet in single precision and shares static
/// objects of Bullet's with this one, whose values are then wrong.
void checkSharedBullet();

}  // namespace bullet_fem::python
