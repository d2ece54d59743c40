// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/common/vec3.h"
#include "demos/drop_scene.h"

namespace bullet_fem
{

/// Mean and maximum of a quantity over the steps.
struct Statistic
{
    double m_sum = 0, m_largest = 0;
    int m_count = 0;

    void add(double value);
    double mean() const { return m_count > 0 ? m_sum / m_count : 0; }
};

/// Measurements during the simulation.
class DropFigures
{
public:
    /// Stores momentum, energy and volumes at the start.
    explicit DropFigures(const DropScene& scene);

    /// Call after each step, with its wall time in `milliseconds`.
    void record(double milliseconds);

    Statistic m_stepMs, m_freeMotionMs, m_contactMs;  ///< wall times of a step and its parts [ms]
    Statistic m_freeIterations, m_contactIterations;  ///< conjugate gradient iterations
    Statistic m_contacts;                             ///< contact points
    int m_flags = 0;                                  ///< btFemFlags of all steps, combined
    int m_stepsNotConverged = 0;                      ///< BT_FEM_NOT_CONVERGED
    /// Maximum penetration between soft body and plane or tilted box at the start of a step [m].
    double m_penetrationStatic = 0;
    double m_penetrationFalling = 0;  ///< maximum penetration between soft body and falling boxes [m]
    double m_worstStepBalance = 0;    ///< maximum over the steps of |dp - sum J - m g h| / (m |g| h) [-]
    double m_startEnergy = 0, m_endEnergy = 0,
           m_largestEnergy = 0;  ///< kinetic energy and gravity potential (0 on the plane) of all bodies [J]
    double m_softSpeed = 0, m_boxSpeed = 0;  ///< present speed of the mass centre, and of the fastest falling box [m/s]
    double m_lowestHeight = 0;  ///< minimum height of a node over the plane in the run; 0 if none was below it [m]
    /// Minimum over elements and steps of volume over rest volume [-]; < 0: inverted.
    double m_smallestVolumeRatio = 1;

    int stepCount() const { return m_stepMs.m_count; }
    double mass() const { return m_mass; }  ///< of the soft body [kg]
    /// |change of the soft body's momentum - sum of contact impulses - m g t| / (m |g| t) over the run [-].
    double momentumBalance() const;

private:
    void recordReport();
    void recordPenetrations();
    void recordMomentum();
    void recordEnergy();
    void recordHeight();
    void recordVolumes();

    const DropScene& m_scene;
    double m_mass = 0;
    Vec3 m_startMomentum, m_momentum, m_impulse;  // [kg m/s]; sum of contact impulses
    std::vector<double> m_restVolumes;            // 6 V_e [m3]
};

/// Entries of the lower triangle of A0; the factor's entries over these are its fill.
long matrixEntries(const btSoftBody& body);

}  // namespace bullet_fem
