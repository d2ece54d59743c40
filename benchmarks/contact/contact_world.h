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

/// Results of one step of a scene in one engine.
struct ContactStep
{
    double m_milliseconds = 0;      ///< wall time of the whole step [ms]
    double m_cpuMilliseconds = 0;   ///< processor time of the whole step [ms]
    double m_freeMilliseconds = 0;  ///< time of the elastic solve alone [ms]
    double m_contactMilliseconds =
        0;  ///< contact time [ms]: search, sweeps and corrections in BulletFEM; all but the elastic solve in Bullet
    int m_contacts = 0;              ///< contact points
    int m_sweeps = 0;                ///< over the contacts; 0 if not known
    int m_correctiveIterations = 0;  ///< conjugate gradient iterations after contact; 0 if there are none
    double m_closingSpeed = 0;       ///< largest speed at which a contact point closes beyond what its gap allows [m/s]
    int m_flags = 0;                 ///< btFemFlags of all bodies, combined
};

/// A scene in one engine. It owns the bodies; the derived class owns the world and clears it in its destructor.
class ContactWorld
{
public:
    virtual ~ContactWorld() = default;

    /// Makes one step of the scene's h.
    virtual ContactStep step() = 0;

    /// The method's name in the table.
    virtual std::string name() const = 0;

    /// Distance at which soft surfaces rest on other surfaces in this engine [m], >= 0.
    virtual double restDistance() const { return 0; }

    const std::vector<std::unique_ptr<btSoftBody>>& softBodies() const { return m_soft; }
    const std::vector<std::unique_ptr<btRigidBody>>& rigidBodies() const { return m_rigid; }

protected:
    /// Makes the bodies of the scene; soft ones with node masses, pins, velocity and friction. Boxes have friction 1,
    /// so that Bullet's product of both equals the scene's friction.
    void makeBodies(const ContactScene& scene, btSoftBodyWorldInfo& info);

    std::vector<std::unique_ptr<btCollisionShape>> m_shapes;
    std::vector<std::unique_ptr<btRigidBody>> m_rigid;
    std::vector<std::unique_ptr<btSoftBody>> m_soft;
};

}  // namespace bullet_fem
