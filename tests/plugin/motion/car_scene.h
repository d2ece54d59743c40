// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "plugin/scenes/scene_measures.h"
#include "plugin/scenes/soft_world.h"

namespace bullet_fem
{

/// A car with four soft tyres on hubs with Bullet's hinges. It drives along x.
class Car
{
public:
    static constexpr double kTyre = 0.4, kHub = 0.15, kWidth = 0.2;  ///< radii and width of a wheel [m]
    static constexpr double kChassisMass = 200, kHubMass = 30;       ///< [kg]
    static constexpr double kTyreDensity = 500;                      ///< [kg/m3]; a tyre of 49 kg
    static constexpr double kTyreDamping = 0.005;                    ///< of the tyre's material [s]

    /// Adds the car on the ground z = 0.
    Car(FemWorld& world, double youngModulus, double hubMass = kHubMass) : m_world(world), m_chassis(addChassis(world))
    {
        for (const double x : {-0.8, 0.8})
            for (const double y : {-0.7, 0.7})
            {
                const btVector3 center{btScalar(x), btScalar(y), btScalar(kTyre)};
                m_hubs.push_back(&addHub(center, hubMass));
                m_tyres.push_back(&addTyre(center, *m_hubs.back(), youngModulus));
            }
    }

    ~Car()
    {
        for (const auto& hinge : m_hinges) m_world.bullet().removeConstraint(hinge.get());
    }

    Car(const Car&) = delete;
    Car& operator=(const Car&) = delete;

    /// Makes a step with this torque from the chassis on each wheel [N m].
    void step(double torque, double h)
    {
        const btVector3 wheel(0, btScalar(torque), 0);
        for (btRigidBody* hub : m_hubs)
        {
            hub->applyTorque(wheel);
            m_chassis.applyTorque(-wheel);
        }
        m_world.step(1, btScalar(h));
    }

    double speed() const { return m_chassis.getLinearVelocity().x(); }  ///< [m/s]
    const btRigidBody& chassis() const { return m_chassis; }
    const std::vector<btRigidBody*>& hubs() const { return m_hubs; }
    const std::vector<btSoftBody*>& tyres() const { return m_tyres; }

private:
    static btRigidBody& addChassis(FemWorld& world)
    {
        return awake(world.addRigid(new btBoxShape(btVector3(1, btScalar(0.5), btScalar(0.15))),
                                    {btScalar(kChassisMass), at(0, 0, btScalar(kTyre + 0.1))}));
    }

    static btRigidBody& awake(btRigidBody& body)
    {
        body.setActivationState(DISABLE_DEACTIVATION);
        return body;
    }

    btRigidBody& addHub(const btVector3& center, double mass)
    {
        const btVector3 halves(btScalar(kHub), btScalar(kWidth / 2), btScalar(kHub));
        btRigidBody& hub = awake(
            m_world.addRigid(new btCylinderShape(halves), {btScalar(mass), at(center.x(), center.y(), center.z())}));
        const btVector3 axis(0, 1, 0), from = center - m_chassis.getCenterOfMassPosition();
        m_hinges.push_back(std::make_unique<btHingeConstraint>(m_chassis, hub, from, btVector3(0, 0, 0), axis, axis));
        m_world.bullet().addConstraint(m_hinges.back().get(), true);
        return hub;
    }

    btSoftBody& addTyre(const btVector3& center, btRigidBody& hub, double youngModulus)
    {
        btSoftBody* tyre = btFemHelpers::createFromTetMesh(m_world.info(), makeCylinder(kTyre, kWidth, 6, 2));
        tyre->rotate(btQuaternion(btVector3(1, 0, 0), SIMD_HALF_PI));
        tyre->translate(center);
        tyre->m_cfg.kDF = 1;
        btFemMaterial material;
        material.m_youngModulus = btScalar(youngModulus);
        material.m_density = btScalar(kTyreDensity);
        material.m_stiffnessDamping = btScalar(kTyreDamping);
        m_world.fem().setMaterial(tyre, material);
        m_world.addSoft(tyre);
        for (int i = 0; i < tyre->m_nodes.size(); ++i)
        {
            const btVector3 r = tyre->m_nodes[i].m_x - center;
            if (std::hypot(r.x(), r.z()) < kHub) tyre->appendAnchor(i, &hub, true);
        }
        return *tyre;
    }

    FemWorld& m_world;
    btRigidBody& m_chassis;
    std::vector<btRigidBody*> m_hubs;
    std::vector<btSoftBody*> m_tyres;
    std::vector<std::unique_ptr<btHingeConstraint>> m_hinges;
};

}  // namespace bullet_fem
