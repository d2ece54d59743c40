// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "LinearMath/btTransform.h"
#include "bullet_fem/btFemMaterial.h"
#include "bullet_fem/btFemSolverInfo.h"
#include "bullet_fem/fem/common/vec3.h"

class btCollisionObject;
class btFemSoftBodySolver;
class btRigidBody;
class btSoftBody;

namespace bullet_fem
{

/// Settings of a scene with an EnergyBook: an elastic rebound returns energy that an earlier step lost, which the book
/// would count as made.
inline btFemSolverInfo withoutRebounds()
{
    btFemSolverInfo info;
    info.m_elasticRebound = false;
    return info;
}

/// The energy of a scene: kinetic, elastic and potential. It may grow only by the work of external forces.
class EnergyBook
{
public:
    /// gravity [m/s2] acts on all bodies.
    EnergyBook(const btFemSoftBodySolver& fem, const Vec3& gravity);

    /// Adds a soft body with E [Pa] and nu [-].
    void addSoft(const btSoftBody& body, double young, double poisson, btFemElasticLaw law = btFemElasticLaw::hooke);
    void addRigid(const btRigidBody& body);
    /// Adds an object moved by the user or a motor: its work is that of its impulses on soft bodies along its motion.
    void addLed(const btCollisionObject& object);

    double kinetic() const;    ///< [J]
    double potential() const;  ///< of gravity [J]
    double elastic() const;    ///< [J]

    /// Call after all bodies are added, before the first step.
    void open();
    /// Call after each step of `step` [s].
    void noteStep(double step);
    /// Adds external work computed by the caller [J].
    void addWork(double work) { m_work += work; }

    /// Compares the energy with the work; call after steps.
    void audit();

    double work() const { return m_work; }  ///< since open() [J]
    /// Present energy minus initial energy and external work [J]; at most zero unless energy is created numerically.
    double surplus() const;
    /// Largest growth of surplus() from one audit to a later one [J]; only numerical errors make it grow.
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
