// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "BulletSoftBody/btDeformableMultiBodyConstraintSolver.h"
#include "BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h"
#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "bullet_fem/btFemDeformableBodySolver.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/link_world.h"
#include "plugin/scenes/scene_measures.h"

namespace bullet_fem
{

using DeformableWorld =
    LinkWorld<btDeformableMultiBodyDynamicsWorld, btDeformableMultiBodyConstraintSolver, btDeformableBodySolver>;

/// Material of the bodies here [Pa], [-], [kg/m3], and its Lame coefficients [Pa].
constexpr double kYoung = 2e5, kPoisson = 0.3, kDensity = 1000;
constexpr double kMu = kYoung / (2 * (1 + kPoisson));
constexpr double kLambda = kYoung * kPoisson / ((1 + kPoisson) * (1 - 2 * kPoisson));

/// Bullet's elastic forces.
enum class Elastic
{
    linear,
    corotated,
    neoHookean
};

inline const char* nameOf(Elastic elastic)
{
    return elastic == Elastic::linear ? "linear" : elastic == Elastic::corotated ? "corotated" : "neoHookean";
}

inline std::unique_ptr<btDeformableLagrangianForce> makeForce(Elastic elastic, double mu, double lambda)
{
    const btScalar m = btScalar(mu), l = btScalar(lambda);
    if (elastic == Elastic::linear) return std::make_unique<btDeformableLinearElasticityForce>(m, l, 0, btScalar(0.01));
    if (elastic == Elastic::corotated) return std::make_unique<btDeformableCorotatedForce>(m, l);
    return std::make_unique<btDeformableNeoHookeanForce>(m, l, btScalar(0.01));
}

/// Soft boxes and cloth as in programs for Bullet's deformables.
class DeformableWorldTest : public ::testing::Test
{
protected:
    explicit DeformableWorldTest(const btFemSolverInfo& info = {}) : m_solver(info), m_world(m_solver) {}

    // Adds a box of density kDensity with its lower face at `lowest`, as Bullet's programs do.
    btSoftBody& addBox(DeformableWorld& world, const Vec3& size, const std::array<int, 3>& cells, const Vec3& center)
    {
        btSoftBody* body = btFemHelpers::createFromTetMesh(world.info(), makeBox(size, cells));
        body->translate(bulletVector(center - 0.5 * size));
        body->m_cfg.collisions = btSoftBody::fCollision::SDF_RD | btSoftBody::fCollision::SDF_RDN;
        body->setTotalMass(btScalar(kDensity * size.x * size.y * size.z));
        return world.addSoft(body);
    }
    btSoftBody& addCube(DeformableWorld& world, const Vec3& center, double edge = 0.4)
    {
        return addBox(world, {edge, edge, edge}, {4, 4, 4}, center);
    }

    void addForces(DeformableWorld& world, btSoftBody& body, Elastic elastic = Elastic::linear)
    {
        addForce(world, body, makeForce(elastic, kMu, kLambda));
        addForce(world, body, std::make_unique<btDeformableGravityForce>(btVector3(0, 0, btScalar(-kGravity))));
    }

    btDeformableLagrangianForce& addForce(DeformableWorld& world, btSoftBody& body,
                                          std::unique_ptr<btDeformableLagrangianForce> force)
    {
        m_forces.push_back(std::move(force));
        world.world().addForce(&body, m_forces.back().get());
        return *m_forces.back();
    }

    // Sets the data that Bullet's file readers add.
    static void makeReadyForBullet(btSoftBody& body)
    {
        for (int t = 0; t < body.m_tetras.size(); ++t)
            for (int a = 0; a < 4; ++a)
                for (int b = 0; b < a; ++b)
                    body.appendLink(body.m_tetras[t].m_n[a], body.m_tetras[t].m_n[b], nullptr, true);
        body.initializeDmInverse();
        body.m_tetraScratches.resizeNoInitialize(body.m_tetras.size());
        body.m_tetraScratchesTn.resizeNoInitialize(body.m_tetras.size());
    }

    btSoftBody& addCloth(DeformableWorld& world)
    {
        auto* cloth = btSoftBodyHelpers::CreatePatch(world.info(), btVector3(-1, -1, 1), btVector3(1, -1, 1),
                                                     btVector3(-1, 1, 1), btVector3(1, 1, 1), 9, 9, 0, true);
        cloth->getCollisionShape()->setMargin(btScalar(0.05));
        cloth->setTotalMass(1);
        cloth->m_cfg.kDF = btScalar(0.5);
        cloth->m_cfg.collisions = btSoftBody::fCollision::SDF_RD | btSoftBody::fCollision::VF_DD;
        cloth->setCollisionFlags(0);
        world.addSoft(cloth);
        addForce(world, *cloth, std::make_unique<btDeformableMassSpringForce>(btScalar(30), btScalar(1), true));
        addForce(world, *cloth, std::make_unique<btDeformableGravityForce>(btVector3(0, 0, btScalar(-kGravity))));
        return *cloth;
    }

    std::vector<std::unique_ptr<btDeformableLagrangianForce>> m_forces;
    btFemDeformableBodySolver m_solver;
    DeformableWorld m_world;
};

}  // namespace bullet_fem
