// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "LinearMath/btTransform.h"
#include "bullet_fem/btFemMaterial.h"
#include "bullet_fem/fem/common/vec3.h"

class btCollisionObject;
class btFemSoftBodySolver;
class btRigidBody;
class btSoftBody;

namespace bullet_fem
{

/// The energy of a scene: kinetic, elastic and that of gravity. It may grow by what is worked from outside alone.
class EnergyBook
{
public:
    /// gravity [m/s2] is that of all bodies.
    EnergyBook(const btFemSoftBodySolver& fem, const Vec3& gravity);

    /// With E [Pa] and nu [-].
    void addSoft(const btSoftBody& body, double young, double poisson, btFemElasticLaw law = btFemElasticLaw::hooke);
    void addRigid(const btRigidBody& body);
    /// What is led by the user or a motor: it works by the impulses that it gives to soft bodies along its way.
    void addLed(const btCollisionObject& object);

    double kinetic() const;    ///< [J]
    double potential() const;  ///< of gravity [J]
    double elastic() const;    ///< [J]

    /// Once all are known, before the first step.
    void open();
    /// After every step of `step` [s].
    void noteStep(double step);
    /// Work from outside that is known otherwise [J].
    void addWork(double work) { m_work += work; }

    /// After steps, to see what energy came from nowhere.
    void audit();

    double work() const { return m_work; }  ///< since open() [J]
    /// Energy now minus that in the beginning and the work since; at most zero where none is made up [J].
    double surplus() const;
    /// Largest growth of surplus() from one audit to a later one [J]; nothing makes it grow but errors.
    double made() const { return m_made; }

private:
    struct Soft
    {
        const btSoftBody* m_body;
        double m_young, m_poisson;
        btFemElasticLaw m_law;
    };
    struct Led
    {
        const btCollisionObject* m_object;
        btTransform m_before;
    };

    const btFemSoftBodySolver* m_fem;
    Vec3 m_gravity;
    std::vector<Soft> m_soft;
    std::vector<const btRigidBody*> m_rigid;
    std::vector<Led> m_led;
    double m_start = 0, m_work = 0, m_min = 0, m_made = 0;
};

}  // namespace bullet_fem
