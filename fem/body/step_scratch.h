// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/body/body.h"
#include "fem/body/actuation.h"
#include "fem/body/conjugate_gradients.h"
#include "fem/body/rigid_momentum.h"
#include "fem/common/aligned_array.h"
#include "fem/elements/element_scratch.h"

namespace bullet_fem
{

/// What a solve with the factor writes.
struct FactorWork
{
    AlignedFloats m_vector, m_scratch;
};

/// The vectors of QuasiNewton; empty where all elements have Hooke's law.
struct QuasiNewtonScratch
{
    explicit QuasiNewtonScratch(std::size_t n)
        : m_loads(n), m_turning(n), m_position(n), m_viscous(n), m_residual(n), m_direction(n)
    {
    }

    bool isUsed() const { return !m_loads.empty(); }

    std::vector<Vec3> m_loads;      ///< b_0, written by the free motion [kg m/s]
    std::vector<Vec3> m_turning;    ///< h w x (w x r) [m/s]
    std::vector<Vec3> m_position;   ///< z [m]
    std::vector<Vec3> m_viscous;    ///< what K' acts on besides [m]
    std::vector<Vec3> m_residual;   ///< r [kg m/s]
    std::vector<Vec3> m_direction;  ///< d [m/s]
};

/// Everything that a step writes besides the state.
struct StepScratch
{
    explicit StepScratch(const BodyModel& model);

    std::vector<Vec3> m_velocity;  ///< velocities during the step [m/s]
    /// Where the forces of the step act: x + (1 - theta) h v, of fixed nodes with the target velocity [m].
    std::vector<Vec3> m_kickPosition;
    std::vector<Vec3> m_drift;  ///< the nodes move with theta times m_velocity and this [m/s]; see meanVelocity()
    std::vector<Vec3> m_meanVelocity;  ///< with which they move in the free motion [m/s]
    std::vector<Vec3> m_push;          ///< velocities of position correction: moved by, never kept [m/s]
    std::vector<Vec3> m_strained;      ///< velocities changed from outside, less their rigid motion [m/s]
    bool m_isStrained = false;         ///< false: m_strained is not read
    bool m_isPushed = false;           ///< false: m_push is zero
    std::vector<Vec3> m_rightSide;     ///< b [kg m/s]
    std::vector<Vec3> m_increment;     ///< dv [m/s]
    std::vector<Vec3> m_residual;      ///< what the responses of this step have left of the impulses [kg m/s]
    bool m_hasResidual = false;        ///< false: that is nothing, whatever is in there
    RigidMomentum m_momentum;          ///< what the impulses prescribe for every connected piece
    Actuation m_actuation;             ///< what the body's actuators do in this step
    double m_complianceScale =
        1;  ///< what contact has learnt: A^-1 is about this times the warped A0^-1 at the surface
    ConjugateGradientScratch m_solver;
    /// 1 in a step that would carry elements too far before their forces are known, else 0: as of the loads [-].
    double m_leastDamping = 0;
    double m_stepVariation = 0;  ///< r, of the recent steps: 1 - (the shortest / the longest)^2, in [0, 1)
    QuasiNewtonScratch m_newton;
    mutable ElementWork m_elements;
    mutable FactorWork m_factor;
};

}  // namespace bullet_fem
