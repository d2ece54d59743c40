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

/// What a step changes of one body: positions, velocities, and the rotations that the next step starts from. The arrays
/// have one entry a node, or one an element.
struct BULLETFEM_API BodyState
{
    /// The model's rest shape at rest, with its masses and fixed nodes.
    explicit BodyState(const BodyModel& model);

    /// Makes room for the plastic strain of a model whose material yields, unless there is some, and for what relaxes;
    /// that starts anew where the number of terms is another.
    void readyForLaws(const BodyModel& model);

    std::vector<Vec3> m_x;               ///< positions [m]
    std::vector<Vec3> m_v;               ///< velocities [m/s]
    std::vector<double> m_mass;          ///< [kg], > 0; may differ from the factor's, at the price of iterations
    std::vector<unsigned char> m_fixed;  ///< 1: the velocity is prescribed; may differ from the factor's likewise
    /// What the free motion of the last two steps added to the velocities [m/s], the newer first: the next solve starts
    /// from there. Anything finite will do, at the price of iterations.
    std::array<std::vector<Vec3>, 2> m_lastIncrement;
    /// R_e as the last step found it, where the next one starts to look. The last element is followed by others that
    /// fill its block of kernel lanes up.
    std::vector<Quaternion> m_elementRotation;
    Mat3 m_bodyRotation = Mat3::identity();  ///< Q of Warp::global; of the last step that used it
    /// As setInitialStress() has checked it, of every element in the mesh's order [Pa]; empty for none.
    std::vector<SymmetricTensor> m_initialStress;
    std::uint64_t m_initialStressChanges = 0;  ///< times that it was set to something else
    /// eps_p of every element in the mesh's order, in the frame that turns with it, without trace [-]; empty, as the
    /// next, for bodies that never had a material that yields.
    std::vector<SymmetricTensor> m_plasticStrain;
    std::vector<double> m_equivalentPlasticStrain;  ///< alpha, all that has flown [-], >= 0
    /// alpha_i of every element's relaxation terms, one element's after another's, likewise; empty without terms.
    std::vector<SymmetricTensor> m_relaxedStrain;
    double m_leastStep = 0;  ///< of the recent steps [s], >= 0; 0 before the first
    double m_mostStep = 0;   ///< likewise
};

/// What acts on a body during one step.
struct StepLoads
{
    /// None, for so many nodes, >= 0. Allocates.
    explicit StepLoads(int nodeCount) : StepLoads(static_cast<std::size_t>(nodeCount)) {}
    /// Likewise.
    explicit StepLoads(std::size_t nodeCount)
        : m_force(nodeCount), m_targetVelocity(nodeCount), m_frameVelocity(nodeCount)
    {
        m_priorVelocity.reserve(nodeCount);
    }

    std::vector<Vec3> m_force;           ///< external force on every node [N]
    std::vector<Vec3> m_targetVelocity;  ///< velocity of fixed nodes during the step [m/s]; not read elsewhere
    double m_massDamping = 0;            ///< added to the material's alpha [1/s], >= 0
    /// Rate at which velocities are drawn to m_frameVelocity [1/s], >= 0: forces m rate (v_frame - v), implicitly. The
    /// frame is a rigid one that moves with the body, so impulses of contact change its momentum undamped; that about
    /// fixed nodes, if it hangs on a point or a line of them.
    double m_frameDamping = 0;
    std::vector<Vec3> m_frameVelocity;  ///< at the end of the step [m/s]; not read if m_frameDamping is 0
    /// Velocities of the nodes before BodyState::m_v was changed from outside since the last step [m/s], so that the
    /// change acts as impulses; empty, if it was not changed, or in one step with the forces.
    std::vector<Vec3> m_priorVelocity;
    double m_leastDamping = 0;  ///< StepSettings::m_numericalDamping is at least this for the body [-], in [0, 1]
};

}  // namespace bullet_fem
