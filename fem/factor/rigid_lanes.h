// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <vector>

#include "bullet_fem/fem/factor/body_model.h"
#include "fem/factor/panel_kernels.h"

namespace bullet_fem
{

/// The rigid motions in A0^-1 in closed form, for kPanelLanes vectors over the factor's rows at a time. K does not see
/// the rigid motions R of a connected piece that its fixed nodes allow: all, or where these are in one point or on one
/// line, turns about that. So A0 R = (1 + h alpha) M R, its masses not scaled, and a right-hand side b makes
/// R (R^T M R)^-1 R^T b / (1 + h alpha) of them. Beside the little that a stiff, light body yields that is so much that
/// an iteration in single precision finds neither; and whatever it rounds off, a rigid motion makes much of. Allocates
/// when it is made, never else.
class RigidLanes
{
public:
    /// The model must outlive it.
    explicit RigidLanes(const BodyModel& model);

    /// Takes the impulses that make rigid motions off right-hand sides, and remembers these.
    void takeOff(float* rightSides);

    /// Takes the rigid motions out of velocities.
    void takeOut(float* velocities) const;

    /// Remembers them alone.
    void remember(const float* rightSides) { sum(rightSides, false, m_taken); }

    /// Adds a share of those that are remembered to velocities that lack it.
    void add(float* velocities, double share = 1) const;

private:
    struct Piece
    {
        int m_fixed = 0;           // nodes
        double m_inverseMass = 0;  // [1/kg]; 0 if it is held
        Vec3 m_center;             // or what it turns about [m]
        Mat3 m_inverseInertia;     // about that [1/(kg m2)]; 0 along axes that it cannot turn about
    };
    // Of a piece, in every lane: linear velocities, then angular ones about the centre.
    using Motions = std::array<std::array<double, kPanelLanes>, 6>;

    bool moves(const Piece& piece) const { return squaredNorm(piece.m_inverseInertia) > 0; }
    void findCenters();
    void findAxes();
    template <class Visit>
    void forEachRow(const Visit& visit) const;
    void sum(const float* values, bool ofVelocities, std::vector<Motions>& motions) const;
    void addMotions(const std::vector<Motions>& motions, double factor, bool asImpulses, float* values) const;

    const BodyModel& m_model;
    double m_damped;  // 1 + h alpha
    std::vector<Piece> m_pieces;
    std::vector<Motions> m_taken;          // of every piece
    mutable std::vector<Motions> m_found;  // likewise
};

}  // namespace bullet_fem
