// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/factor/body_model.h"

namespace bullet_fem
{

/// The rigid modes of a model's rest shape that its fixed nodes permit: of every connected component all six, or the
/// rotations about its fixed nodes if these are at one point or on one line, or none. K vanishes on them, so A0 r = s M
/// r, with s of massScale(), and A0^-1 without them is A0^-1 - r r^T / s for modes of unit mass, r^T M r = 1
/// (docs/theory.md, Rigid motion). Immutable.
class RestModes
{
public:
    struct Component
    {
        int m_fixed = 0;           ///< number of fixed nodes
        double m_inverseMass = 0;  ///< [1/kg]; 0 with fixed nodes
        Vec3 m_center;             ///< centre of mass or fixed point [m]
        Mat3 m_inverseInertia;     ///< about m_center [1/(kg m2)]; 0 along axes it cannot rotate about
        double m_softness = 0;     ///< estimate of 1 / lambda_1, lambda_1 the smallest elastic eigenvalue of A0 over M

        bool moves() const { return squaredNorm(m_inverseInertia) > 0; }
    };

    /// A node of the factor.
    struct Node
    {
        Vec3 m_lever;       ///< from the centre of its component [m]
        double m_mass = 0;  ///< [kg]
        int m_component = 0;
    };

    /// Velocity of a component's rigid motion.
    struct Motion
    {
        Vec3 m_linear, m_angular;  ///< of m_center [m/s], [rad/s]
    };

    /// Modes of a model whose mesh and factor are set. Allocates.
    explicit RestModes(const BodyModel& model);

    bool any() const { return m_any; }
    const std::vector<Component>& components() const { return m_components; }

    /// The nodes of the factor, in its order.
    const std::vector<Node>& nodes() const { return m_nodes; }

    /// Removes the impulses of rigid motions from y, three values per node of the factor [N s]: y -= M r r^T y. Writes
    /// these motions to the first of `motions`, two per component.
    void removeImpulses(float* y, std::vector<Motion>& motions) const;

    /// Removes the rigid motions from velocities y [m/s], and adds m_softness times the first of `motions`, which are
    /// overwritten.
    void replaceMotions(float* y, std::vector<Motion>& motions) const;

    /// (r r^T)_ij / (1 + h alpha) between nodes of the mesh [1/kg]: the velocity of i by an impulse on j as a rigid
    /// component.
    Mat3 response(int i, int j) const;

private:
    void findCenters();
    void findAxes();
    void findNodes();
    void findSoftness();

    const BodyModel& m_model;
    bool m_any = false;
    std::vector<Component> m_components;
    std::vector<Node> m_nodes;
};

}  // namespace bullet_fem
