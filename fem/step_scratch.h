// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <vector>

#include "bullet_fem/fem/body.h"
#include "fem/conjugate_gradients.h"
#include "fem/rigid_momentum.h"

namespace bullet_fem
{

/// Everything that a step writes besides the state.
struct StepScratch
{
    explicit StepScratch(const BodyModel& model);

    std::vector<Vec3> m_velocity;                  ///< velocities during the step [m/s]
    std::vector<Vec3> m_push;                      ///< velocities of position correction: moved by, never kept [m/s]
    std::vector<Vec3> m_rightSide;                 ///< b [kg m/s]
    std::vector<Vec3> m_increment;                 ///< dv [m/s]
    std::vector<std::array<double, 6>> m_tension;  ///< V_e sigma_e^+ [J], see addElasticForces
    std::vector<Mat3> m_rotationSum;               ///< per node, sum of V_e R_e [m3]
    RigidMomentum m_momentum;                      ///< what the impulses prescribe for every connected piece
    double m_complianceScale =
        1;  ///< what contact has learnt: A^-1 is about this times the warped A0^-1 at the surface
    ConjugateGradientScratch m_solver;
    mutable std::vector<float> m_factorVector, m_factorScratch;  ///< of the preconditioner
};

}  // namespace bullet_fem
