// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "benchmarks/contact/contact_world.h"

namespace bullet_fem
{

/// The figures of one scene in one engine: one row of the table. Times are over the steps in contact.
struct ContactFigures
{
    std::string m_scene, m_method;
    std::string m_variant;  ///< what tells this scene from others of its name
    int m_tets = 0, m_nodes = 0;
    int m_contacts = 0;                                        ///< points, most of all steps
    int m_touchingSteps = 0;                                   ///< steps with contact
    int m_steps = 0;                                           ///< of the run
    double m_medianMilliseconds = 0, m_worstMilliseconds = 0;  ///< a step [ms]
    double m_cpuMilliseconds = 0;                              ///< median of its processor time [ms]
    double m_freeMilliseconds = 0;                             ///< median of the elastic solve [ms]
    double m_contactMilliseconds = 0;                          ///< median of contact [ms]
    double m_sweeps = 0;                                       ///< mean a step
    double m_correctiveIterations = 0;                         ///< mean a step
    double m_closingSpeed = 0;                                 ///< contact residual, worst [m/s]
    double m_deepest = 0;                                      ///< overlap of the surfaces, worst of all steps [m]
    double m_deepestAtEnd = 0;  ///< how much closer than the engine's own rest distance, after the last step [m]
    double m_size = 1;          ///< of the soft body [m]
    double m_creep = 0;         ///< mean speed of the fastest centre over the last 20 steps [m/s]
    bool m_free = false;        ///< momentum should be conserved, and the next two are meant
    double m_linearError = 0;   ///< worst |sum p - p0| / sum |p_i| [-]
    double m_angularError = 0;  ///< worst |sum L - L0| / (sum |p_i| size) [-]
    int m_failedStep = 0;       ///< in which it no longer held and was stopped, from 1; 0 if it held
    int m_flags = 0;            ///< btFemFlags of all steps
    double m_timesFasterThanBullet = 0;  ///< Bullet's median over this one's [-]; 0 if it was not run, or did not hold

    /// True if contact did its work to the end: no NaN, nothing deeper than half a cell.
    bool holds() const { return m_failedStep == 0; }
};

/// Runs the scene in the world that was made for it, until it is over or no longer holds.
ContactFigures runContact(const ContactScene& scene, ContactWorld& world);

}  // namespace bullet_fem
