// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/body/body.h"

namespace bullet_fem
{

/// The rigid motion G xi of every connected component that can move rigidly, at the kick positions: about its centre of
/// mass without fixed nodes, about the fixed nodes if these are at one point or on one line. External impulses
/// prescribe its momentum, so xi is known exactly; a step solves for the elastic part of the velocities only, which has
/// no momentum, G^T M w = 0, and responds to impulses without resultant, Pi^T J with Pi = 1 - G (G^T M G)^-1 G^T M
/// (docs/theory.md, Rigid motion).
class RigidMomentum
{
public:
    explicit RigidMomentum(const TetMesh& mesh) : m_components(mesh.componentCount()), m_added(mesh.componentCount()) {}

    /// Sets the momentum prescribed by the loads: (1 + h alpha)(p' - p) = h (F - alpha p), and the corresponding
    /// angular momentum about the centre at the positions y, with the kick velocities; for components with fixed nodes
    /// that of the velocities relative to these. alpha includes the loads' mass damping; their frame damping adds its
    /// force and its rate.
    void prescribe(const Body& body, double step);

    /// Sets the momentum of velocities v [m/s] at positions x [m] without loads.
    void measure(const Body& body, double step, const std::vector<Vec3>& x, const std::vector<Vec3>& v);

    /// Positions [m], velocities of their motion and velocities at its end [m/s], before advance().
    struct Moving
    {
        const std::vector<Vec3>&m_x, &m_v, &m_vEnd;
    };

    /// Moves positions and velocities on by a time [s] without forces. Movable components go with their centres and
    /// turn as free rigid bodies with the momenta prescribed at these positions, by R of freeRotation(); others, and
    /// all elastic displacements, go along v. Elastic velocities turn by R^T: along with the body by R, and back by
    /// Coriolis' force, R^-2, so that it does no work at any spin. The angular momentum of v+ about the new centre is
    /// the old one. x+ and v+ may be the given vectors; without v+, only positions.
    void advance(const Body& body, double time, const Moving& moving, std::vector<Vec3>& xNext,
                 std::vector<Vec3>* vNext) const;

    /// Turns elastic velocities as the last advance() did.
    void turnElastic(const Body& body, std::vector<Vec3>& vectors) const;

    /// Adds node impulses J [N s] to the prescription. The frame damping, whose frame follows the body, does not reduce
    /// them.
    void addImpulses(const Body& body, const std::vector<Vec3>& impulses, double step);

    /// Adds an angular impulse [N m s] to the prescription of the component that a node belongs to.
    void addAngularImpulse(const Body& body, int node, const Vec3& impulse, double step);

    /// Forgets the angular impulses of the last step.
    void clearAngularImpulses();
    /// Adds the angular impulses since clearAngularImpulses() again, to the prescription of a second solve.
    void repeatAngularImpulses();

    /// Adds to `velocity` the rigid motion that gives every movable component its prescribed momentum.
    void restore(const Body& body, std::vector<Vec3>& velocity);

    /// J <- Pi^T J: removes the impulses that move the components rigidly [N s].
    void removeImpulses(const Body& body, std::vector<Vec3>& impulses) const;

    /// dv <- Pi dv: removes the rigid motion from a change of velocities [m/s].
    void removeMotion(const Body& body, std::vector<Vec3>& change) const;

    /// Removes the rigid motion from velocities; at components with fixed nodes relative to these [m/s].
    void removeRigidVelocity(const Body& body, std::vector<Vec3>& velocity) const;

    /// Adds the rigid response to impulses, G (G^T M G)^-1 G^T J / (1 + h alpha) [m/s].
    void addResponse(const Body& body, const std::vector<Vec3>& impulses, std::vector<Vec3>& change) const;

    /// True if the components that move are those with rest modes, which may be taken out of A0^-1.
    bool hasRestModes() const { return m_hasRestModes; }

    /// Adds factor W x (W x r) at the nodes of movable components, with the spin W of the prescription; for components
    /// that hang on fixed nodes, whose weight accelerates them, that of the middle of the step.
    void addInward(const Body& body, double factor, std::vector<Vec3>& change) const;

    /// Adds the impulses of the centrifugal force of a step, -h m W x (W x r), to b [N s].
    void addCentrifugal(const Body& body, double step, std::vector<Vec3>& b) const;

    /// Momenta of a component per unit impulse along every axis of a contact side.
    struct Share
    {
        int m_component = -1;
        Mat3 m_linear, m_angular;  ///< [-], about the centre [m]
    };

    /// Share of a contact side at nodes, whose velocity is the sum of blocks times node velocities.
    Share shareOf(const Body& body, const int* nodes, const Mat3* blocks, int count) const;

    /// Rigid response to the impulses of a share: linear [1/kg] and angular velocity [1/(kg m)]. Zero for a component
    /// that cannot move.
    Share responseTo(const Share& share) const;

    /// Largest spin of a movable component by the prescribed momentum [rad/s].
    double fastestSpin() const;

    bool isMovable(int component) const { return m_components[component].m_isMovable; }

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
    void setOnlyComponent(const FreeComponent& component, double impulseShare);

    /// Rotation of a free rigid body of this inverse inertia [1/(kg m2)] and angular momentum L [kg m2/s] in a time
    /// [s], by the midpoint rule on rotations in steps of at most kMaxTurn; the identity if L is zero or not finite.
    static Mat3 freeRotation(const Mat3& inverseInertia, const Vec3& L, double time);
    static constexpr double kMaxTurn = 0.15;  ///< [rad]: flips about the middle axis are .1 % off
    static constexpr int kMaxTurns = 64;      ///< maximum number of steps, for spins up to one and a half turns

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
        Mat3 m_rotation = Mat3::identity();  // of the last advance()
        Mat3 m_inertia;                      // at its end, in the axes of its begin
        Vec3 m_elastic;                      // angular momentum of the elastic velocities then, in these axes
        Vec3 m_end;                          // its centre then [m]
    };
    void clearMotions() const;
    void findCenters(const Body& body, const std::vector<Vec3>& x);
    void beginAdvance(double time) const;
    void endAdvance() const;
    Vec3 spin(const Component& component) const;
    Mat3 inverted(const Component& component, const Mat3& inertia) const;
    void findMovable(const Body& body, double step, const std::vector<Vec3>& x);
    void findMotions() const;
    void addRigid(const Body& body, const std::vector<Vec3>& x, bool fromCarried, std::vector<Vec3>& velocity) const;
    void sumImpulses(const Body& body, const std::vector<Vec3>& impulses) const;

    mutable std::vector<Component> m_components;
    std::vector<Vec3> m_added;    // angular momenta by the step's angular impulses, one per component [kg m2/s]
    double m_impulseShare = 1;    // 1 / (1 + h alpha) [-]
    bool m_anyMovable = false;    // for the last prescription; if false, nothing is done
    bool m_hasRestModes = false;  // see hasRestModes()
};

}  // namespace bullet_fem
