// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "bullet_fem/fem/mesh/generators.h"
#include "examples/energy_book.h"
#include "examples/example_bodies.h"
#include "plugin/scenes/deformable_scene.h"

namespace bullet_fem
{

/// A soft block of a deformable example.
struct ExampleBlock
{
    btVector3 m_scale{1, 1, 1};   ///< of the mesh [-]
    btVector3 m_center{0, 0, 0};  ///< [m]
    btScalar m_mass = 1;          ///< [kg]
    btScalar m_friction = 1;      ///< kDF [-]
    int m_collisions = btSoftBody::fCollision::SDF_RD | btSoftBody::fCollision::SDF_RDN;
};

/// Common setup of Bullet's deformable examples; y is up.
class DeformableExample : public DeformableWorldTest
{
protected:
    DeformableExample() : DeformableWorldTest(withoutRebounds()) {}

    void setGravity(double gravity)
    {
        m_gravity = {0, -gravity, 0};
        m_world.world().setGravity(bulletVector(m_gravity));
        m_world.info().m_gravity = bulletVector(m_gravity);
    }

    void useImplicitSolver()
    {
        m_world.world().setImplicit(true);
        m_world.world().setLineSearch(false);
        m_world.world().setUseProjection(true);
        m_world.world().getSolverInfo().m_leastSquaresResidualThreshold = btScalar(1e-3);
        m_world.world().getSolverInfo().m_splitImpulse = true;
        m_world.world().getSolverInfo().m_numIterations = 100;
    }

    btRigidBody& addRigidBox(const btVector3& half, const btVector3& center, btScalar mass,
                             btScalar friction = btScalar(0.5))
    {
        RigidSettings settings;
        settings.m_mass = mass;
        settings.m_transform = at(center.x(), center.y(), center.z());
        settings.m_friction = friction;
        return m_world.addRigid(new btBoxShape(half), settings);
    }

    // Adds the block first and places it afterwards, as the examples do.
    btSoftBody& addBlock(const TetMesh& mesh, const ExampleBlock& block)
    {
        btSoftBody& body = m_world.addSoft(createFromTetGenText(m_world.info(), mesh));
        body.scale(block.m_scale);
        body.translate(block.m_center);
        body.getCollisionShape()->setMargin(btScalar(0.1));
        body.setTotalMass(block.m_mass);
        body.m_cfg.kKHR = 1;
        body.m_cfg.kCHR = 1;
        body.m_cfg.kDF = block.m_friction;
        body.m_cfg.collisions = block.m_collisions;
        body.m_sleepingThreshold = 0;
        btSoftBodyHelpers::generateBoundaryFaces(&body);
        m_blocks.push_back(&body);
        return body;
    }

    void addGravity(btSoftBody& body)
    {
        addForce(m_world, body, std::make_unique<btDeformableGravityForce>(bulletVector(m_gravity)));
    }

    // Parameters that three of the examples set before each step; their E is 50 Pa, up to 2000 by a slider.
    void addElasticity(btSoftBody& body, double young)
    {
        auto force = std::make_unique<btDeformableLinearElasticityForce>(100, 100, btScalar(0.01));
        force->setPoissonRatio(btScalar(0.3));
        force->setYoungsModulus(btScalar(young));
        force->setDamping(btScalar(0.1), btScalar(0.01));
        addForce(m_world, body, std::move(force));
    }

    btFemSoftBodySolver& fem() { return m_solver.fem(); }
    double supportOn(const btSoftBody& body, const btCollisionObject& other)
    {
        return fem().contactForce(&body, &other).y();
    }

    // Makes steps of `step` [s]; checks after each that all numbers are finite.
    void run(EnergyBook& book, int steps, double step, const std::function<void(int)>& before = {})
    {
        for (int k = 0; k < steps; ++k)
        {
            if (before) before(k);
            m_world.step(1, btScalar(step));
            book.noteStep(step);
            for (const btSoftBody* block : m_blocks)
            {
                ASSERT_TRUE(allFinite(*block)) << "step " << k;
                m_flattest = std::min(m_flattest, smallestVolumeRatio(*block));
            }
            if (k % 4 == 3) book.audit();
        }
    }

    // Coulomb's law at each contact point.
    void expectWithinTheCone(const btSoftBody& body, double friction)
    {
        const btAlignedObjectArray<btFemContact>& contacts = fem().contacts(&body);
        for (int k = 0; k < contacts.size(); ++k)
            EXPECT_LE(contacts[k].m_frictionImpulse.length(), 1.001 * friction * contacts[k].m_normalImpulse + 1e-7);
    }

    Vec3 m_gravity;
    std::vector<btSoftBody*> m_blocks;
    double m_flattest = 1;  // minimum over run()'s steps of an element's volume over its rest volume [-]
};

}  // namespace bullet_fem
