// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/body/body.h"
#include "bullet_fem/fem/body/step_types.h"
#include "fem/common/aligned_array.h"

namespace bullet_fem
{

/// The clamped beam after half a second under its own weight at E = 1e6 Pa, in the state at the start of a step: x is
/// updated, the rotations are those of the previous step. Holds the input and output of the kernels.
class BentBeam
{
public:
    /// `tets` is 24 n^3. Throws std::invalid_argument.
    explicit BentBeam(int tets);

    const BodyModel& model() const { return *m_body.m_model; }
    int tetCount() const { return model().mesh().tetCount(); }
    Body& body() { return m_body; }

    /// Deformation gradient, rotation, force and contribution to A of all elements, without sums over nodes.
    void passOverElements();
    /// passOverElements(), the sums over nodes and the nodes' rotations: the whole preparation of a step.
    void prepareSystem();
    /// Resets the rotations to those of the last step.
    void forgetRotations() { m_body.m_state.m_elementRotation = m_lastRotation; }
    /// Restores the input of passOverElements(): products overwrite the positions with their own vector.
    void restoreInput();

    void multiply();      ///< A p, with A as last prepared
    void precondition();  ///< P r
    void solve();         ///< A0^-1 y in place, one right-hand side
    void solveLanes();    ///< 16 right-hand sides
    void resetVector();   ///< restores y to its value before the first solve
    void resetLanes();

private:
    Body m_body;
    StepSettings m_settings;
    std::vector<Quaternion> m_lastRotation;
    std::vector<Vec3> m_in, m_out;
    AlignedFloats m_vector, m_scratch, m_lanes, m_lanesScratch;
};

}  // namespace bullet_fem
