// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bullet_fem/fem/common/export.h"
#include "bullet_fem/fem/common/quaternion.h"
#include "bullet_fem/fem/common/symmetric.h"
#include "bullet_fem/fem/factor/body_model.h"

namespace bullet_fem
{

/// The variable part of a body: positions, velocities, and the rotations and history variables that the next step
/// starts from. Arrays have one entry per node, or one per element.
struct BULLETFEM_API BodyState
{
    /// At rest in the model's rest shape, with its masses and fixed nodes. Allocates.
    explicit BodyState(const BodyModel& model);

    /// Sizes the history variables for a model's material laws. Keeps existing plastic strain; resets relaxed strain if
    /// the number of terms changes. Allocates.
    void resizeHistoryVariables(const BodyModel& model);
    [[deprecated("resizeHistoryVariables")]] void readyForLaws(const BodyModel& model)
    {
        resizeHistoryVariables(model);
    }

    std::vector<Vec3> m_x;               ///< positions [m]
    std::vector<Vec3> m_v;               ///< velocities [m/s]
    std::vector<double> m_mass;          ///< [kg], > 0; a difference from the factor's costs iterations
    std::vector<unsigned char> m_fixed;  ///< 1: prescribed velocity; a difference from the factor's costs iterations
    /// Velocity increments of the free motion in the last two steps [m/s], the newer first: warm start of the next
    /// solve. Any finite values are valid, at the price of iterations.
    std::array<std::vector<Vec3>, 2> m_lastIncrement;
    /// R_e of the last step, initial guess of the next. Padded after the last element to a full block of kernel lanes.
    std::vector<Quaternion> m_elementRotation;
    Mat3 m_bodyRotation = Mat3::identity();  ///< Q of Warp::global, from the last step that used it
    /// Initial stress set by setInitialStress(), per element in the mesh's order [Pa]; empty: none.
    std::vector<SymmetricTensor> m_initialStress;
    std::uint64_t m_initialStressChanges = 0;  ///< number of changes of m_initialStress
    /// Plastic strain eps_p per element in the mesh's order, deviatoric, in the frame that rotates with the element
    /// [-]; empty for bodies that never had a material with a yield stress.
    std::vector<SymmetricTensor> m_plasticStrain;
    /// Equivalent plastic strain alpha [-], >= 0; empty as m_plasticStrain.
    std::vector<double> m_equivalentPlasticStrain;
    /// alpha_i of every element's relaxation terms, element by element, in the frame that rotates with the element [-];
    /// empty without terms.
    std::vector<SymmetricTensor> m_relaxedStrain;
    std::vector<double> m_lawHistory;  ///< history variables of the laws, element by element; empty without
    double m_leastStep = 0;            ///< minimum of the recent steps [s], >= 0; 0 before the first
    double m_mostStep = 0;             ///< maximum of the recent steps [s], >= 0; 0 before the first
};

/// The loads of a body during one step.
struct StepLoads
{
    /// Zero loads on `nodeCount` nodes, >= 0. Allocates.
    explicit StepLoads(int nodeCount) : StepLoads(static_cast<std::size_t>(nodeCount)) {}
    /// Zero loads on `nodeCount` nodes. Allocates.
    explicit StepLoads(std::size_t nodeCount)
        : m_force(nodeCount), m_targetVelocity(nodeCount), m_frameVelocity(nodeCount)
    {
        m_priorVelocity.reserve(nodeCount);
    }

    std::vector<Vec3> m_force;           ///< external force on every node [N]
    std::vector<Vec3> m_targetVelocity;  ///< velocity of fixed nodes during the step [m/s]; ignored at free nodes
    double m_massDamping = 0;            ///< added to the material's alpha [1/s], >= 0
    /// Rate at which velocities relax to m_frameVelocity [1/s], >= 0: forces m rate (v_frame - v), implicitly. The
    /// frame is a rigid motion that follows the body, so contact impulses change the body's momentum undamped; for a
    /// body fixed at one point or one line of nodes, the momentum about these.
    double m_frameDamping = 0;
    /// Frame velocity at the end of the step [m/s]; ignored if m_frameDamping is 0.
    std::vector<Vec3> m_frameVelocity;
    /// Node velocities before an external change of BodyState::m_v since the last step [m/s], so that the change acts
    /// as impulses. Empty: no change, or the change acts within one step together with the forces.
    std::vector<Vec3> m_priorVelocity;
    /// In contact or held: unless the body turns far, its nodes move along chords, as contacts and joints expect,
    /// instead of turning exactly with it (docs/theory.md, Chords).
    bool m_isHeld = false;
    /// In contact, and m_isHeld: the length that chords add in a step with numerical damping counts as strain
    /// (docs/theory.md, Chords).
    bool m_isInContact = false;
    double m_leastDamping = 0;  ///< lower bound of StepSettings::m_numericalDamping for the body [-], in [0, 1]
};

}  // namespace bullet_fem
