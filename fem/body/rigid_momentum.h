// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/body/body.h"

namespace bullet_fem
{

/// The momentum that external impulses prescribe for every connected component of a body that can move rigidly: about
/// its centre of mass without fixed nodes, about the fixed nodes if these are at one point or on one line. The warped
/// stiffness has no torque balance about the deformed positions and conjugate gradients stop early; both lose momentum,
/// which a rigid motion of up to six unknowns per component restores (docs/theory.md, Momentum).
class RigidMomentum
{
public:
    explicit RigidMomentum(const TetMesh& mesh) : m_components(mesh.componentCount()) {}

    /// Sets the momentum prescribed by the loads: (1 + h alpha)(p' - p) = h (F - alpha p), and the corresponding
    /// angular momentum about the centre at the positions y; for components with fixed nodes that of the velocities
    /// relative to these. alpha includes the loads' mass damping; their frame damping adds its force and its rate.
    void prescribe(const Body& body, double step);

    /// Adds node impulses J [N s] to the prescription. The frame damping, whose frame follows the body, does not reduce
    /// them.
    void addImpulses(const Body& body, const std::vector<Vec3>& impulses, double step);

    /// Adds an angular impulse [N m s] to the prescription of the component that a node belongs to.
    void addAngularImpulse(const Body& body, int node, const Vec3& impulse, double step);

    /// Adds to `velocity` the rigid motion that gives every movable component its prescribed momentum.
    void restore(const Body& body, std::vector<Vec3>& velocity);

    /// Adds h w x (w x r) at the nodes of movable components, the rotation of their velocities in a step, with the
    /// angular velocity w of the prescription; for components that hang on fixed nodes, whose weight accelerates them,
    /// that of the middle of the step.
    void addTurning(const Body& body, double step, std::vector<Vec3>& change) const;

    /// Momenta of a component per unit impulse along every axis of a contact side.
    struct Share
    {
        int m_component = -1;
        Mat3 m_linear, m_angular;  ///< [-], about the centre [m]
    };

    /// Share of a contact side at nodes, whose velocity is the sum of blocks times node velocities.
    Share shareOf(const Body& body, const int* nodes, const Mat3* blocks, int count) const;

    /// Velocity change of side `of` per impulse on side `to` by the rigid motion of their common component [1/kg].
    Mat3 answer(const Share& of, const Share& to) const;

    /// Work of node impulses J [N s] on the rigid velocities that they cause [J].
    double rigidWork(const Body& body, const std::vector<Vec3>& impulses);

    /// Removes the rigid motion from a change of velocities, so that it gives no movable component momentum at the
    /// positions x. Invalidates the prescription.
    void removeMomentum(const Body& body, double step, const std::vector<Vec3>& x, std::vector<Vec3>& change);

    /// Prescription for a free component.
    struct FreeComponent
    {
        double m_mass = 0;         ///< [kg]
        Vec3 m_center;             ///< [m]
        Vec3 m_linear, m_angular;  ///< prescribed [kg m/s], about the centre [kg m2/s]
        Mat3 m_inverseInertia;     ///< [1/(kg m2)]
    };

    /// Prescription of a body with one component and without fixed nodes, for sums over several bodies at once.
    FreeComponent onlyComponent() const;
    void setOnlyComponent(const FreeComponent& component);

    /// The inverse of a component's inertia about its centre [kg m2].
    static Mat3 inverseInertia(const Mat3& inertia, double mass, const Vec3& center);

    /// alpha of the body's material plus that of its loads, without frame damping [1/s].
    static double damping(const Body& body);

private:
    struct Component
    {
        bool m_isMovable = true;
        int m_pivot = -1;  // first fixed node, or -1; with one, m_mass is infinite and m_center is its position
        double m_mass = 0;
        Vec3 m_center;             // [m]
        Vec3 m_axis;               // from m_center to the farthest fixed node [m]
        Vec3 m_carried;            // velocity of the fixed nodes, subtracted from the momenta [m/s]
        Vec3 m_linear, m_angular;  // prescribed [kg m/s], [kg m2/s]
        Vec3 m_angularBefore;      // angular momentum before the loads, for components with fixed nodes
        Mat3 m_inverseInertia;     // [1/(kg m2)]; zero if the component has collapsed to a point
        Vec3 m_linearVelocity, m_angularVelocity;
    };
    void findCenters(const Body& body, const std::vector<Vec3>& x);
    void findMovable(const Body& body, double step, const std::vector<Vec3>& x);
    void addRigid(const Body& body, const std::vector<Vec3>& x, std::vector<Vec3>& velocity);

    std::vector<Component> m_components;
    bool m_anyMovable = false;  // for the last prescription; if false, nothing is done
};

}  // namespace bullet_fem
