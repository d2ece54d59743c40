// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <BulletSoftBody/btSoftBody.h>
#include <btBulletDynamicsCommon.h>

#include <memory>
#include <string>
#include <vector>

#include "benchmarks/contact/contact_scene.h"

namespace bullet_fem
{

/// What an engine says about a step of a scene.
struct ContactStep
{
    double m_milliseconds = 0;      ///< wall time of the whole step [ms]
    double m_cpuMilliseconds = 0;   ///< processor time of it [ms]
    double m_freeMilliseconds = 0;  ///< of the elastic solve alone [ms]
    double m_contactMilliseconds =
        0;                           ///< of contact: ours of search, sweeps and corrections; Bullet's of the rest [ms]
    int m_contacts = 0;              ///< contact points
    int m_sweeps = 0;                ///< over the contacts; 0 where it is not known
    int m_correctiveIterations = 0;  ///< conjugate gradient iterations after contact; 0 where there are none
    double m_closingSpeed = 0;       ///< largest at which a contact point still closes faster than its gap allows [m/s]
    int m_flags = 0;                 ///< btFemFlags of all bodies
};

/// A scene in an engine. Owns the bodies; the derived class owns the world, and clears it before it goes.
class ContactWorld
{
public:
    virtual ~ContactWorld() = default;

    /// One step of the scene's h.
    virtual ContactStep step() = 0;

    /// The method's name in the table.
    virtual std::string name() const = 0;

    /// Distance at which the engine means soft surfaces to rest on others [m], >= 0.
    virtual double restDistance() const { return 0; }

    const std::vector<std::unique_ptr<btSoftBody>>& softBodies() const { return m_soft; }
    const std::vector<std::unique_ptr<btRigidBody>>& rigidBodies() const { return m_rigid; }

protected:
    /// Makes the bodies of the scene: soft ones with their node masses, pins, velocity and friction. A box's friction
    /// is 1, so that Bullet's product gives the scene's.
    void makeBodies(const ContactScene& scene, btSoftBodyWorldInfo& info);

    std::vector<std::unique_ptr<btCollisionShape>> m_shapes;
    std::vector<std::unique_ptr<btRigidBody>> m_rigid;
    std::vector<std::unique_ptr<btSoftBody>> m_soft;
};

}  // namespace bullet_fem
