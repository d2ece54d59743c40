// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/body/body.h"

namespace bullet_fem
{

/// The momentum that external impulses prescribe for every connected component of a body that can move as one: about
/// its centre of mass if it has no fixed nodes, about these if they lie in one place or on one line. The warped
/// stiffness has no torque balance about the deformed positions and conjugate gradients stop early; both leak momentum,
/// and a rigid motion of up to six unknowns a component puts it back.
class RigidMomentum
{
public:
    explicit RigidMomentum(const TetMesh& mesh) : m_components(mesh.componentCount()) {}

    /// Sets the prescription to that of the loads: (1 + h alpha)(p' - p) = h (F - alpha p), and the same for angular
    /// momentum about the centre at the positions y; what hangs on fixed nodes has that of its velocities less
    /// theirs. alpha includes the loads' extra damping; what draws
    /// it to the loads' frame is added likewise.
    void prescribe(const Body& body, double step);

    /// Adds node impulses J [N s] to the prescription; the frame, which moves along, does not damp them.
    void addImpulses(const Body& body, const std::vector<Vec3>& impulses, double step);

    /// Adds an angular impulse [N m s] to the prescription of the component that a node belongs to.
    void addAngularImpulse(const Body& body, int node, const Vec3& impulse, double step);

    /// Adds to `velocity` the rigid motion that gives every movable component its prescribed momentum.
    void restore(const Body& body, std::vector<Vec3>& velocity);

    /// Adds h w x (w x r) to the nodes of movable components: how their velocities turn in a step, with the angular
    /// velocity w that the prescription makes; of what hangs on fixed nodes, and so gets faster and slower by its
    /// weight, with that of the middle of the step.
    void addTurning(const Body& body, double step, std::vector<Vec3>& change) const;

    /// What a unit impulse along every axis of an end makes of the momentum of the component that it is on.
    struct Share
    {
        int m_component = -1;
        Mat3 m_linear, m_angular;  ///< [-], about the centre [m]
    };

    /// Of an end that is nodes, whose velocity is the sum of blocks times theirs.
    Share shareOf(const Body& body, const int* nodes, const Mat3* blocks, int count) const;

    /// What impulses on `to` do to the velocity of `of`, as far as the component that was prescribed moves as one
    /// [1/kg].
    Mat3 answer(const Share& of, const Share& to) const;

    /// The work of node impulses J [N s] on the rigid velocities that they make [J].
    double rigidWork(const Body& body, const std::vector<Vec3>& impulses);

    /// Takes the rigid motion out of a change of velocities, so that no movable component gets momentum by it at the
    /// positions x. Leaves no prescription.
    void removeMomentum(const Body& body, double step, const std::vector<Vec3>& x, std::vector<Vec3>& change);

    /// A free component, as the prescription has it.
    struct FreeComponent
    {
        double m_mass = 0;         ///< [kg]
        Vec3 m_center;             ///< [m]
        Vec3 m_linear, m_angular;  ///< prescribed [kg m/s], about the centre [kg m2/s]
        Mat3 m_inverseInertia;     ///< [1/(kg m2)]
    };

    /// Of a body of one component that hangs on nothing: what it has been prescribed; for who sums up for several
    /// bodies at once.
    FreeComponent onlyComponent() const;
    void setOnlyComponent(const FreeComponent& component);

    /// The inverse of a component's inertia about its centre [kg m2].
    static Mat3 inverseInertia(const Mat3& inertia, double mass, const Vec3& center);

    /// alpha of a body's own and of its loads [1/s].
    static double damping(const Body& body);

private:
    struct Component
    {
        bool m_isMovable = true;
        int m_pivot = -1;  // its first fixed node; then it is infinitely heavy, its centre there
        double m_mass = 0;
        Vec3 m_center;             // [m]
        Vec3 m_axis;               // to the farthest fixed node [m]
        Vec3 m_carried;            // velocity of the fixed nodes, which its momenta are relative to [m/s]
        Vec3 m_linear, m_angular;  // prescribed [kg m/s], [kg m2/s]
        Vec3 m_angularBefore;      // before the loads, of what hangs on fixed nodes
        Mat3 m_inverseInertia;     // [1/(kg m2)]; zero where the component has collapsed to a point
        Vec3 m_linearVelocity, m_angularVelocity;
    };
    void findCenters(const Body& body, const std::vector<Vec3>& x);
    void findMovable(const Body& body, double step, const std::vector<Vec3>& x);
    void addRigid(const Body& body, const std::vector<Vec3>& x, std::vector<Vec3>& velocity);

    std::vector<Component> m_components;
    bool m_anyMovable = false;  // of the last prescription; all is skipped where there is none
};

}  // namespace bullet_fem
