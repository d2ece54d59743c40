// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "BulletSoftBody/btDeformableMassSpringForce.h"
#include "BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h"
#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_boxes.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{

constexpr btScalar kClothMargin = btScalar(0.02);  ///< of the cloth here [m]

/// The kind of world, with its rigid solver.
enum class ClothWorldKind
{
    swap,
    coupled,
    multiBody,
    deformable
};

inline const char* nameOf(ClothWorldKind kind)
{
    const char* names[] = {"swap", "coupled", "multiBody", "deformable"};
    return names[static_cast<int>(kind)];
}

inline auto eachClothWorld()
{
    return testing::Values(ClothWorldKind::swap, ClothWorldKind::coupled, ClothWorldKind::multiBody,
                           ClothWorldKind::deformable);
}

/// The worlds in which Bullet moves cloth by positions (btSoftBody::solveConstraints).
inline auto eachSoftClothWorld()
{
    return testing::Values(ClothWorldKind::swap, ClothWorldKind::coupled, ClothWorldKind::multiBody);
}

/// FEM bodies and cloth that collides with soft bodies, in one of Bullet's worlds.
class ClothWorld
{
public:
    explicit ClothWorld(ClothWorldKind kind, const btVector3& gravity = {0, 0, btScalar(-kGravity)},
                        const btFemSolverInfo& info = btFemSolverInfo())
        : m_kind(kind),
          m_world(kind == ClothWorldKind::deformable  ? WorldClass::deformable
                  : kind == ClothWorldKind::multiBody ? WorldClass::softMultiBody
                                                      : WorldClass::softRigid,
                  kind == ClothWorldKind::coupled ? Coupling::coupled : Coupling::swap, gravity, info)
    {
    }

    FemWorld& world() { return m_world; }
    btFemSoftBodySolver& fem() { return m_world.fem(); }

    /// The flag for collision of soft bodies in that world.
    int softFlag() const
    {
        return m_kind == ClothWorldKind::deformable ? btSoftBody::fCollision::VF_DD : btSoftBody::fCollision::VF_SS;
    }

    btSoftBody& addBox(const SoftBox& box)
    {
        btSoftBody& body = addSoftBox(m_world, fem(), box);
        body.m_cfg.collisions |= softFlag();
        return body;
    }

    btSoftBody& addBall(const Vec3& center, double radius, double density = 100, double young = 1e5)
    {
        btSoftBody* ball = btFemHelpers::createFromTetMesh(m_world.info(), makeSphere(radius, 6));
        ball->translate(bulletVector(center));
        btFemMaterial material;
        material.m_youngModulus = btScalar(young);
        material.m_poissonRatio = btScalar(0.3);
        material.m_density = btScalar(density);
        fem().setMaterial(ball, material);
        ball->m_cfg.collisions |= softFlag();
        ball->m_cfg.kDF = btScalar(0.5);
        return m_world.addSoft(ball);
    }

    /// Adds a square cloth around a point, with this edge [m], mass [kg] and number of nodes along each edge.
    btSoftBody& addPatch(const Vec3& center, double edge, double mass, int nodes, int fixedCorners = 0)
    {
        const btScalar a = btScalar(0.5 * edge);
        const btVector3 c = bulletVector(center);
        btSoftBody* cloth = btSoftBodyHelpers::CreatePatch(m_world.info(), c + btVector3(-a, -a, 0),
                                                           c + btVector3(a, -a, 0), c + btVector3(-a, a, 0),
                                                           c + btVector3(a, a, 0), nodes, nodes, fixedCorners, true);
        return add(cloth, mass);
    }

    /// Adds a rope between two points, with this number of nodes.
    btSoftBody& addRope(const Vec3& from, const Vec3& to, double mass, int nodes, int fixedEnds = 0)
    {
        return add(
            btSoftBodyHelpers::CreateRope(m_world.info(), bulletVector(from), bulletVector(to), nodes - 2, fixedEnds),
            mass);
    }

private:
    btSoftBody& add(btSoftBody* cloth, double mass)
    {
        std::vector<int> fixed;
        for (int i = 0; i < cloth->m_nodes.size(); ++i)
            if (cloth->m_nodes[i].m_im == 0) fixed.push_back(i);
        cloth->getCollisionShape()->setMargin(kClothMargin);
        cloth->setTotalMass(btScalar(mass));
        for (const int i : fixed) cloth->setMass(i, 0);
        cloth->m_cfg.kDF = btScalar(0.5);
        cloth->m_cfg.kDP = btScalar(0.01);
        cloth->m_cfg.piterations = 4;
        cloth->m_cfg.collisions |= softFlag();
        m_world.addSoft(cloth);
        if (m_kind != ClothWorldKind::deformable) return *cloth;
        m_forces.push_back(std::make_unique<btDeformableMassSpringForce>(btScalar(3), btScalar(0.05), false));
        dynamic_cast<btDeformableMultiBodyDynamicsWorld&>(m_world.bullet()).addForce(cloth, m_forces.back().get());
        return *cloth;
    }

    ClothWorldKind m_kind;
    std::vector<std::unique_ptr<btDeformableMassSpringForce>> m_forces;
    FemWorld m_world;
};

}  // namespace bullet_fem
