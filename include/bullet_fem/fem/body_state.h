// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/body_model.h"

namespace bullet_fem
{

/// What a step changes of one body: positions, velocities, and the rotations that the next step starts from. The arrays
/// have one entry a node, or one an element.
struct BodyState
{
    /// The model's rest shape at rest, with its masses and fixed nodes.
    explicit BodyState(const BodyModel& model);

    std::vector<Vec3> m_x;               ///< positions [m]
    std::vector<Vec3> m_v;               ///< velocities [m/s]
    std::vector<double> m_mass;          ///< [kg], > 0; may differ from the factor's, at the price of iterations
    std::vector<unsigned char> m_fixed;  ///< 1: the velocity is prescribed; may differ from the factor's likewise
    std::vector<Mat3> m_elementRotation;
    std::vector<Mat3> m_nodeRotation;
    Mat3 m_bodyRotation = Mat3::identity();
};

/// What acts on a body during one step.
struct StepLoads
{
    explicit StepLoads(int nodeCount) : m_force(nodeCount), m_targetVelocity(nodeCount) {}

    std::vector<Vec3> m_force;           ///< external force on every node [N]
    std::vector<Vec3> m_targetVelocity;  ///< velocity of fixed nodes during the step [m/s]; not read elsewhere
    double m_massDamping = 0;            ///< added to the material's alpha [1/s], >= 0
};

}  // namespace bullet_fem
