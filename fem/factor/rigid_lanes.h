// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <vector>

#include "bullet_fem/fem/factor/body_model.h"
#include "fem/factor/panel_kernels.h"

namespace bullet_fem
{

/// The rigid motions in A0^-1 in closed form, for kPanelLanes vectors over the factor's rows at a time. K vanishes on
/// the rigid motions R of a connected component that its fixed nodes permit: all, or rotations about them if these are
/// at one point or on one line. So A0 R = (1 + h alpha) M R, with unscaled masses, and the rigid part of the solution
/// for a right-hand side b is R (R^T M R)^-1 R^T b / (1 + h alpha). In a stiff, light body it exceeds the elastic part
/// so much that single-precision iterations resolve neither, and rounding errors are amplified by rigid motions.
/// Allocates in the constructor only.
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

    /// Adds a share of the stored rigid motions to velocities.
    void add(float* velocities, double share = 1) const;

private:
    struct Component
    {
        int m_fixed = 0;           // number of fixed nodes
        double m_inverseMass = 0;  // [1/kg]; 0 with fixed nodes
        Vec3 m_center;             // centre of mass or fixed point [m]
        Mat3 m_inverseInertia;     // about m_center [1/(kg m2)]; 0 along axes it cannot rotate about
    };
    // Per component and lane: linear velocity, then angular velocity about the centre.
    using Motions = std::array<std::array<double, kPanelLanes>, 6>;

    bool moves(const Component& rigid) const { return squaredNorm(rigid.m_inverseInertia) > 0; }
    void findCenters();
    void findAxes();
    template <class Visit>
    void forEachRow(const Visit& visit) const;
    void sum(const float* values, bool ofVelocities, std::vector<Motions>& motions) const;
    void addMotions(const std::vector<Motions>& motions, double factor, bool asImpulses, float* values) const;

    const BodyModel& m_model;
    double m_damped;  // 1 + h alpha
    std::vector<Component> m_components;
    std::vector<Motions> m_taken;          // per component
    mutable std::vector<Motions> m_found;  // per component
};

}  // namespace bullet_fem
