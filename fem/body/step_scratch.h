// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/body/body.h"
#include "fem/body/actuation.h"
#include "fem/body/conjugate_gradients.h"
#include "fem/body/led_motion.h"
#include "fem/body/rigid_momentum.h"
#include "fem/body/support_reactions.h"
#include "fem/common/aligned_array.h"
#include "fem/elements/element_scratch.h"
#include "fem/factor/rest_modes.h"

namespace bullet_fem
{

/// Work vectors of a solve with the factor.
struct FactorWork
{
    AlignedFloats m_vector, m_scratch;
    std::vector<RestModes::Motion> m_motions;  // two per component
};

/// The vectors of QuasiNewton; empty if all elements are linear.
struct QuasiNewtonScratch
{
    explicit QuasiNewtonScratch(std::size_t n)
        : m_loads(n), m_elastic(n), m_chord(n), m_position(n), m_viscous(n), m_residual(n), m_direction(n)
    {
    }

    bool isUsed() const { return !m_loads.empty(); }

    std::vector<Vec3> m_loads;      ///< b_0, written by the free motion [kg m/s]
    std::vector<Vec3> m_elastic;    ///< elastic part of the velocities [m/s]
    std::vector<Vec3> m_chord;      ///< -h W x (W x r) of bodies that move along chords [m/s]
    std::vector<Vec3> m_position;   ///< z [m]
    std::vector<Vec3> m_viscous;    ///< vector that K' acts on besides z [m]
    std::vector<Vec3> m_residual;   ///< r [kg m/s]
    std::vector<Vec3> m_direction;  ///< d [m/s]
};

/// Arrays of elasticEnergy(); empty where a body needs none.
struct ElasticEnergyScratch
{
    explicit ElasticEnergyScratch(const RestShape& shape);

    double m_stiffness = 0;                 ///< sum of (2 mu + lambda) V over the elements [J]
    std::vector<double> m_dilatation;       ///< mean dilatation of every patch [-]
    std::vector<SymmetricTensor> m_strain;  ///< strain of every element if strains are assumed [-]
};

/// All data that a step writes besides the state.
struct StepScratch
{
    explicit StepScratch(const BodyModel& model);

    std::vector<Vec3> m_velocity;  ///< velocities during the step [m/s]
    /// Kick positions, where the forces of the step act: x + (1 - theta) h v; fixed nodes on the way to their targets
    /// [m].
    std::vector<Vec3> m_kickPosition;
    std::vector<Vec3> m_kickVelocity;  ///< velocities there before the forces act, fixed nodes' at the begin [m/s]
    /// Movable components turn exactly; false for bodies in contact or held (StepLoads::m_isHeld) that do not turn far,
    /// whose nodes move along chords, as their contacts and joints expect: see chooseTurning().
    bool m_isTurned = true;
    bool m_isJoined = false;           ///< joints act on the body in this step: see findChange()
    std::vector<Vec3> m_drift;         ///< the nodes move with theta m_velocity + m_drift [m/s]; see noteMeanVelocity()
    std::vector<Vec3> m_meanVelocity;  ///< mean velocities in the free motion [m/s]
    std::vector<Vec3> m_push;          ///< velocities of the position correction: they displace but are not kept [m/s]
    std::vector<Vec3> m_strained;      ///< external velocity changes without their rigid part [m/s]
    bool m_isStrained = false;         ///< false: m_strained is unused
    bool m_isPushed = false;           ///< false: m_push is zero
    std::vector<Vec3> m_rightSide;     ///< b [kg m/s]
    std::vector<Vec3> m_increment;     ///< dv [m/s]
    std::vector<Vec3> m_impulses;      ///< of contacts, joints and changes of velocity in this step [N s]
    std::vector<Vec3> m_residual;      ///< residual of this step's impulse responses [kg m/s]
    bool m_hasResidual = false;        ///< false: m_residual is unused and counts as zero
    RigidMomentum m_momentum;          ///< momenta prescribed for every connected component
    LedMotion m_led;                   ///< rigid motion of the fixed nodes
    Actuation m_actuation;             ///< linearized actuators of this step
    /// Learnt in contact: A^-1 at the surface is about this times the warped A0^-1 [-], > 0.
    double m_complianceScale = 1;
    /// Steps in which contact still forms its compliance from the present A in place of A0, >= 0.
    int m_presentSteps = 0;
    ConjugateGradientScratch m_solver;
    /// Lower bound of the numerical damping [-]: 1 in a step that would strain elements too much before their forces
    /// are known, else 0.
    double m_leastDamping = 0;
    double m_stepVariation = 0;  ///< r of the recent steps: 1 - (shortest / longest)^2, in [0, 1)
    QuasiNewtonScratch m_newton;
    mutable ElasticEnergyScratch m_elasticEnergy;
    mutable SupportReactions m_reactions;
    mutable ElementWork m_elements;
    mutable FactorWork m_factor;
};

}  // namespace bullet_fem
