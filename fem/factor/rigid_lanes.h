// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <vector>

#include "bullet_fem/fem/factor/body_model.h"
#include "fem/factor/panel_kernels.h"

namespace bullet_fem
{

/// The rest modes in kPanelLanes vectors over the factor's rows at a time. In a stiff, light body the rigid part of
/// A0^-1 exceeds the elastic part so much that single-precision iterations resolve neither, and rounding errors are
/// amplified by rigid motions. Allocates in the constructor only.
class RigidLanes
{
public:
    /// The model must outlive this object. Allocates.
    explicit RigidLanes(const BodyModel& model);

    /// Removes the impulses of rigid motions from right-hand sides, and stores these motions.
    void deflateRightSide(float* rightSides);

    /// Removes rigid motions from velocities.
    void deflateSolution(float* velocities) const;

    /// Stores the rigid motions of right-hand sides without removing them.
    void remember(const float* rightSides) { sum(rightSides, false, m_taken); }

    /// Removes a share of the stored rigid motions from velocities.
    void removeStored(double share, float* velocities) const { addMotions(m_taken, -share, false, velocities); }

private:
    // Per component and lane: linear velocity, then angular velocity about the centre.
    using Motions = std::array<std::array<double, kPanelLanes>, 6>;

    template <class Visit>
    void forEachRow(const Visit& visit) const;
    void sum(const float* values, bool ofVelocities, std::vector<Motions>& motions) const;
    void addMotions(const std::vector<Motions>& motions, double factor, bool asImpulses, float* values) const;

    const BodyModel& m_model;
    std::vector<Motions> m_taken;          // per component
    mutable std::vector<Motions> m_found;  // per component
};

}  // namespace bullet_fem
