// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/common/vec3.h"
#include "demos/drop_scene.h"

namespace bullet_fem
{

/// Mean and largest of a figure that every step has.
struct Statistic
{
    double m_sum = 0, m_largest = 0;
    int m_count = 0;

    void add(double value);
    double mean() const { return m_count > 0 ? m_sum / m_count : 0; }
};

/// What is measured while the scene runs.
class DropFigures
{
public:
    /// Takes momentum, energy and volumes at the start.
    explicit DropFigures(const DropScene& scene);

    /// After every step; it took `milliseconds` of wall time.
    void record(double milliseconds);

    Statistic m_stepMs, m_freeMotionMs, m_contactMs;  ///< wall times: of a step, of its parts [ms]
    Statistic m_freeIterations, m_contactIterations;  ///< conjugate gradients
    Statistic m_contacts;                             ///< contact points
    int m_flags = 0;                                  ///< btFemFlags of any step
    int m_stepsNotConverged = 0;                      ///< BT_FEM_NOT_CONVERGED
    double m_penetrationStatic = 0;   ///< deepest of soft body and plane or tilted box at the start of a step [m]
    double m_penetrationFalling = 0;  ///< deepest of soft body and falling boxes [m]
    double m_worstStepBalance = 0;    ///< |dp - sum J - m g h| / (m |g| h) of the worst step [-]
    double m_startEnergy = 0, m_endEnergy = 0,
           m_largestEnergy = 0;              ///< kinetic + gravity's, plane at 0, all bodies [J]
    double m_softSpeed = 0, m_boxSpeed = 0;  ///< now: of the mass centre, and of the fastest falling box [m/s]
    double m_lowestHeight = 0;               ///< of a node over the plane, ever; 0 if none went below it [m]
    double m_smallestVolumeRatio = 1;        ///< of an element to its own at rest, ever; < 0: inverted [-]

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
    Vec3 m_startMomentum, m_momentum, m_impulse;  // [kg m/s]; impulses of contact, summed
    std::vector<double> m_restVolumes;            // 6 V_e [m3]
};

/// Entries of the lower triangle of A0, of which the factor has more by its fill.
long matrixEntries(const btSoftBody& body);

}  // namespace bullet_fem
