// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "benchmarks/contact/contact_world.h"

namespace bullet_fem
{

/// Results of one scene in one engine: one row of the table. Times cover the steps with contact.
struct ContactFigures
{
    std::string m_scene, m_method;
    std::string m_variant;  ///< distinguishes scenes of equal name
    int m_tets = 0, m_nodes = 0;
    int m_contacts = 0;                                        ///< maximum over the steps
    int m_touchingSteps = 0;                                   ///< steps with contact
    int m_steps = 0;                                           ///< of the run
    double m_medianMilliseconds = 0, m_worstMilliseconds = 0;  ///< per step [ms]
    double m_cpuMilliseconds = 0;                              ///< median processor time per step [ms]
    double m_freeMilliseconds = 0;                             ///< median time of the elastic solve [ms]
    double m_contactMilliseconds = 0;                          ///< median time of contact [ms]
    double m_sweeps = 0;                                       ///< mean per step
    double m_correctiveIterations = 0;                         ///< mean per step
    double m_closingSpeed = 0;                                 ///< contact residual, maximum [m/s]
    double m_deepest = 0;                                      ///< overlap of the surfaces, maximum over the steps [m]
    double m_deepestAtEnd = 0;           ///< overlap beyond the engine's own rest distance after the last step [m]
    double m_size = 1;                   ///< of the soft body [m]
    double m_creep = 0;                  ///< mean speed of the fastest centre over the last 20 steps [m/s]
    bool m_free = false;                 ///< momentum should be conserved; the next two values are defined
    double m_linearError = 0;            ///< maximum |sum p - p0| / sum |p_i| [-]
    double m_angularError = 0;           ///< maximum |sum L - L0| / (sum |p_i| size) [-]
    int m_failedStep = 0;                ///< step, from 1, at which the run failed and stopped; 0 without failure
    int m_flags = 0;                     ///< btFemFlags of all steps, combined
    double m_timesFasterThanBullet = 0;  ///< ratio of Bullet's median time [-]; 0 if it was not run or failed

    /// True if contact held to the end: no NaN, no penetration above half a cell.
    bool holds() const { return m_failedStep == 0; }
};

/// Runs the scene in `world` to its end or to the first failure.
ContactFigures runContact(const ContactScene& scene, ContactWorld& world);

}  // namespace bullet_fem
