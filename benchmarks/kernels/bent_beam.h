// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/body/body.h"
#include "bullet_fem/fem/body/step_types.h"
#include "fem/common/aligned_array.h"

namespace bullet_fem
{

/// The clamped beam bent by half a second of its own weight at E = 1e6, as a step finds it: x has moved on, the
/// rotations are still those of the step before. Holds what its kernels read and write.
class BentBeam
{
public:
    /// `tets` is 24 n^3. Throws std::invalid_argument.
    explicit BentBeam(int tets);

    const BodyModel& model() const { return *m_body.m_model; }
    int tetCount() const { return model().mesh().tetCount(); }
    Body& body() { return m_body; }

    /// F, rotations, forces and the part of A of all elements; nothing else.
    void passOverElements();
    /// The same with the sums over nodes and the nodes' rotations: all that a step prepares.
    void prepareSystem();
    /// Turns the rotations back to those of the last step.
    void forgetRotations() { m_body.m_state.m_elementRotation = m_lastRotation; }
    /// Brings back what passOverElements() reads: products leave their own vector where it looks for positions.
    void restoreInput();

    void multiply();      ///< A p, as last prepared
    void precondition();  ///< P r
    void solve();         ///< A0^-1 y in place, one right-hand side
    void solveLanes();    ///< 16 right-hand sides
    void resetVector();   ///< y as before the first solve
    void resetLanes();

private:
    Body m_body;
    StepSettings m_settings;
    std::vector<Quaternion> m_lastRotation;
    std::vector<Vec3> m_in, m_out;
    AlignedFloats m_vector, m_scratch, m_lanes, m_lanesScratch;
};

}  // namespace bullet_fem
