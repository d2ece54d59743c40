// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "bullet_fem/fem/body/body.h"
#include "bullet_fem/fem/common/export.h"

namespace bullet_fem
{

class ComplianceCache;

/// Creates a cache of the compliance between a model's surface nodes, for ContactSolver::solve. Bodies of one model may
/// share it on one thread. `model` must not be null. Allocates.
BULLETFEM_API std::shared_ptr<ComplianceCache> makeComplianceCache(std::shared_ptr<const BodyModel> model);

/// Creates a cache of the compliance between the given nodes of a model, not null, for contact points on other nodes
/// than those of the mesh's surface. `nodes`: distinct indices in [0, n). Allocates.
BULLETFEM_API std::shared_ptr<ComplianceCache> makeComplianceCache(std::shared_ptr<const BodyModel> model,
                                                                   std::vector<int> nodes);

/// A rigid body in the contact solver.
struct RigidProxy
{
    /// Largest rotation of an immovable proxy within a step that contacts follow [rad]: up to it they hold at the end
    /// of the step, with the arcs of its points; normals are then those of the end.
    static constexpr double kMaxTurn = 0.5;

    Vec3 m_inverseMass;      ///< inverse mass along the world axes [1/kg]; 0 for static and kinematic bodies
    Mat3 m_inverseInertia;   ///< inverse inertia in world axes [1/(kg m2)]
    Vec3 m_center;           ///< centre of mass, world [m]
    Vec3 m_linearVelocity;   ///< velocity of the centre [m/s]; solve() adds the response to contacts and joints
    Vec3 m_angularVelocity;  ///< angular velocity [rad/s]; solve() adds the response to contacts and joints
    /// Written by solve(): velocity of the position correction of this step, not kept as motion [m/s].
    Vec3 m_pushLinear;
    /// Written by solve(): angular velocity of the position correction, not kept as motion [rad/s].
    Vec3 m_pushAngular;
    Vec3 m_angularImpulse;    ///< written by solve(): compensates the angular momentum of position corrections [N m s]
    int m_firstResponse = 0;  ///< its responses are m_responses[m_firstResponse ... + m_responseCount) of the problem
    /// Number of its responses. If > 0, these give the effect of impulses on it, and inverse mass and inertia only tell
    /// that it can move.
    int m_responseCount = 0;
    Vec3 m_pushImpulse;         ///< written by solve() if it has responses: impulse of the position correction [N s]
    Vec3 m_pushAngularImpulse;  ///< angular impulse about its centre [N m s]
    /// Written by the solver if it has responses: impulse of contacts and joints so far [N s].
    Vec3 m_accumulatedImpulse;
    Vec3 m_accumulatedAngularImpulse;  ///< angular impulse about its centre [N m s]

    /// True if an impulse moves or turns it.
    bool canMove() const { return dot(m_inverseMass, m_inverseMass) > 0 || squaredNorm(m_inverseInertia) > 0; }
    /// Velocity of the rigid motion at a point [m] in the world [m/s].
    Vec3 velocityAt(const Vec3& point) const { return m_linearVelocity + cross(m_angularVelocity, point - m_center); }
};

/// Response of one rigid proxy to an impulse on another or on itself: links of an articulated body, which no mass and
/// inertia describe. Impulses f and angular impulses t about the centre of the one change the velocity of the other's
/// centre by m_linear f + m_linearOfAngular t, and its angular velocity by m_angularOfLinear f + m_angular t. World
/// axes.
struct RigidResponse
{
    int m_rigidProxy = 0;    ///< index of the responding proxy
    Mat3 m_linear;           ///< [1/kg]
    Mat3 m_linearOfAngular;  ///< [1/(kg m)]
    Mat3 m_angularOfLinear;  ///< [1/(kg m)]
    Mat3 m_angular;          ///< [1/(kg m2)]
};

/// A point of a soft surface: a weighted mean of nodes of a body that its compliance cache serves. An impulse on it is
/// distributed by these weights, so its moment is that of the impulse at the point.
struct SurfacePoint
{
    static constexpr int kMaxNodes = 12;  ///< three corners of an embedded triangle, each in a tetrahedron
    [[deprecated("kMaxNodes")]] static constexpr int kMostNodes = kMaxNodes;

    int m_body = -1;  ///< index into the bodies of the solve; -1: none
    /// Node indices; of a boundary point the nodes of its triangle; may repeat.
    std::array<int, kMaxNodes> m_nodes = {0, 0, 0};
    std::array<double, kMaxNodes> m_weights = {1, 0};  ///< weights [-], sum 1
    int m_count = 3;                                   ///< number of nodes, in [1, kMaxNodes]

    /// Interpolation of nodal values, one per node of the body.
    Vec3 of(const std::vector<Vec3>& nodeValues) const
    {
        const auto part = [&](std::size_t a)
        { return m_weights[a] * nodeValues[static_cast<std::size_t>(m_nodes[a])]; };
        Vec3 sum = part(0);
        for (int a = 1; a < m_count; ++a) sum += part(static_cast<std::size_t>(a));
        return sum;
    }
};

/// A contact of a soft surface with a rigid proxy, another soft body or itself, present or possible within the step.
struct ContactPoint
{
    SurfacePoint m_soft;  ///< side that receives m_impulse
    /// Soft other side, which receives the opposite impulse; m_body is -1 if the other side is rigid.
    SurfacePoint m_other;
    int m_rigidProxy = -1;  ///< rigid other side: index into the rigid proxies of the solve; -1 if it is soft
    /// Point at which the impulse acts on both sides: the soft point, between two soft ones their midpoint [m].
    Vec3 m_point;
    /// Added to m_point for the lever arm of a rigid proxy that is met later in the step: the approach until then [m].
    Vec3 m_approach;
    /// Added to m_point for the lever arms of both sides: the offset to the origin of a moving contact patch [m].
    Vec3 m_patch;
    /// The impulse acts at m_point + m_patch + m_approach on a movable rigid proxy and on the soft side.
    bool m_isMetLater = false;
    Vec3 m_arm;                ///< output: lever arm of the rigid proxy, from its centre [m]
    Vec3 m_normal;             ///< unit normal [-], from the other side to m_soft
    double m_gap = 0;          ///< signed distance at the start [m]; negative inside
    double m_slop = 0;         ///< penetration without position correction [m], >= 0
    double m_hardness = 1;     ///< factor on ContactSettings::m_pushFraction [-], >= 0
    double m_friction = 0;     ///< Coulomb friction coefficient [-], >= 0
    double m_restitution = 0;  ///< coefficient of restitution [-], in [0, 1]; not read by the solver
    double m_stiffness = 0;    ///< stiffness of a contact spring instead of rigid contact [N/m], >= 0; 0: rigid
    double m_damping = 0;      ///< damping of the contact spring [N s/m], >= 0
    Vec3 m_impulse;            ///< impulse on m_soft [N s]: input is the warm start, output the solution
    /// Tangential displacement of a sticking point [m], corrected within some steps: input is that of the previous
    /// step, output the new one.
    Vec3 m_slip;
};

/// A contact between a rigid proxy and another or an immovable object.
struct RigidContact
{
    int m_rigidProxy = -1;    ///< index into the rigid proxies of the solve
    int m_other = -1;         ///< index of the other rigid proxy; -1: immovable
    Vec3 m_arm;               ///< lever arm of the contact point from the proxy's centre [m]
    Vec3 m_otherArm;          ///< lever arm from the other proxy's centre [m]; not read if that is immovable
    Vec3 m_normal;            ///< unit normal [-], from the other to the rigid proxy
    double m_gap = 0;         ///< signed distance [m]; negative inside
    bool m_moves = true;      ///< the gap changes by the velocities of the solve
    double m_leastSpeed = 0;  ///< minimum separation speed along the normal [m/s]; < 0: approach is allowed
    /// Velocity at the contact point of an immovable other, or of the belt that runs on a movable one [m/s];
    /// m_leastSpeed and the sliding velocity of friction are relative to it.
    Vec3 m_otherVelocity;
    double m_compliance = 0;   ///< added compliance along the normal [1/kg], >= 0; 0: rigid
    double m_friction = 0;     ///< Coulomb friction coefficient [-], >= 0; the larger one if it is anisotropic
    double m_aspect = 1;       ///< anisotropic friction: ratio of the smaller coefficient to the larger one, in [0, 1]
    Vec3 m_slipAxis;           ///< anisotropic friction: unit tangent of the larger coefficient [-]
    int m_torsion = -1;        ///< index of the torsional friction that it presses on; -1: none
    Vec3 m_impulse;            ///< impulse on m_rigidProxy [N s]: input is the warm start, output the solution
    bool m_pushOnly = false;   ///< the row takes part in position correction only
    bool m_isSupport = false;  ///< the other never moves, whatever the impulses
};

using RigidTouch [[deprecated("RigidContact")]] = RigidContact;

/// A body with its compliance cache. Neither may be null; both must live until the solve is over.
struct ContactBody
{
    Body* m_body = nullptr;                   ///< body after solveFreeMotion
    ComplianceCache* m_compliance = nullptr;  ///< cache of the body's model
    /// FreeMotion::m_predicted [N s], one per node: the share of the initial contact impulses that is included in the
    /// body's velocities. Null: none.
    const std::vector<Vec3>* m_predicted = nullptr;
};

/// Settings of a ContactSolver.
struct ContactSettings
{
    StepSettings m_step;  ///< settings of the corrective solves
    int m_rounds = 1;     ///< minimum number of outer iterations, in [1, 100]
    /// Maximum number, >= m_rounds, while the error exceeds m_tolerance.
    int m_maxRounds = 10;
    int m_sweeps = 50;  ///< maximum number of sweeps per outer iteration, in [1, 1000]
    /// Velocity error at which outer iterations end, relative to the speed that the loads give a body in a step, or to
    /// the initial velocity change by contact if that is larger [-], > 0. Limited to the speed of 5e-4 of the shortest
    /// mean element edge per step. Joints are solved to 1e-3 of the speed that loads give, and of the impulses on their
    /// bodies.
    double m_tolerance = 3e-5;
    int m_denseLimit = 400;        ///< maximum number of points of a body for a dense compliance matrix, >= 0
    double m_pushFraction = 0.2;   ///< share of a penetration corrected per step [-], in [0, 1]
    double m_maxPushVelocity = 1;  ///< maximum speed of penetration correction [m/s], >= 0
    double m_slipFraction = 0.2;   ///< share of the slip of a sticking point corrected per step [-], in [0, 1]
};

/// Statistics of a solve.
struct ContactReport
{
    int m_contacts = 0;       ///< number of contact points
    int m_rounds = 0;         ///< outer iterations, each with a corrective solve of all bodies
    int m_sweeps = 0;         ///< number of sweeps in all outer iterations
    int m_iterations = 0;     ///< conjugate gradient iterations of all corrective solves of all bodies
    double m_violation = 0;   ///< largest speed at which a contact still closes faster than its gap allows [m/s], >= 0
    bool m_converged = true;  ///< all corrective solves met their tolerance
};

/// One side of a joint: a point or a group of nodes of a soft body, or a rigid body.
struct JointEnd
{
    int m_body = -1;  ///< soft side: index into the bodies of the solve
    int m_first = 0;  ///< soft side: its nodes are m_handleNodes[m_first ... m_first + m_count) of the problem
    int m_count = 0;  ///< number of nodes; the side's velocity is the sum of m_handleBlocks times theirs
    /// Rigid side: index into the rigid proxies. A side that is neither soft nor rigid is fixed in the world.
    int m_rigidProxy = -1;
    Vec3 m_point;            ///< rigid side: point of action [m]
    bool m_angular = false;  ///< rigid side: its velocity is the angular one, and impulses are angular
    /// Rigid side: index into the problem's Jacobians, by which its velocity is J (v, w) and impulses are J^T lambda
    /// about its centre; -1: that of a point, or the spin.
    int m_jacobian = -1;
};

/// Three rows of a constraint on the velocity v of a rigid proxy's centre and its angular velocity w.
struct RigidJacobian
{
    Mat3 m_linear;   ///< of v [-] or [1/m]
    Mat3 m_angular;  ///< of w [m] or [-]
};

/// Constrains the relative velocity of two sides, a - b, to a target along three axes: anchors, attachments, motors.
struct Joint
{
    static constexpr double kUnlimited = 1e300;  ///< as m_limit: no limit [N s] or [N m s]

    JointEnd m_a;  ///< first side; m_impulse acts on it
    JointEnd m_b;  ///< second side; the opposite impulse acts on it
    std::array<Vec3, 3> m_axes = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};  ///< orthonormal [-]
    Vec3 m_wanted;  ///< target of the relative velocity along the axes [m/s] or [rad/s]: error correction, motor speed
    Vec3 m_limit = {kUnlimited, kUnlimited, kUnlimited};  ///< maximum impulse along every axis, and the opposite of the
                                                          ///< minimum, [N s] or [N m s], >= 0; 0: the axis is free
    Vec3 m_lower = {-kUnlimited, -kUnlimited,
                    -kUnlimited};  ///< one-sided limits: larger minimum along every axis [N s] or [N m s], <= m_limit
    double m_maxImpulse = kUnlimited;  ///< maximum norm of the impulse [N s] or [N m s], > 0
    double m_compliance = 0;           ///< added compliance of an implicit spring [1/kg] or [1/(kg m2)], >= 0; 0: rigid
    double m_softness = 0;             ///< added compliance as a multiple of the joint's own [-], >= 0; 0: rigid
    Vec3 m_impulse;  ///< impulse on side a, world axes [N s] or [N m s]: input is the warm start, output the solution
};

/// Rolling and spinning friction of a rigid proxy's face on a patch of a soft surface or on another rigid proxy: a
/// couple between the two that opposes their relative spin, by Coulomb's law with coefficients in metres. The spin of
/// the patch is the least-squares fit to its nodes' velocities; the couple acts on the nodes through the transpose of
/// that fit, as forces without resultant.
struct TorsionalFriction
{
    int m_body = 0;  ///< soft side: index into the bodies of the solve; -1: the first side is m_firstRigidProxy
    int m_firstRigidProxy = -1;  ///< index into the rigid proxies; -1: none
    int m_first = 0;             ///< its nodes are m_handleNodes[m_first ... m_first + m_count) of the problem
    int m_count = 0;  ///< number of nodes; the patch's spin is the sum of m_handleBlocks [1/m] times their velocities
    int m_rigidProxy = 0;  ///< other side: index into the rigid proxies; -1: immovable
    std::array<Vec3, 3> m_axes = {Vec3{0, 0, 1}, Vec3{1, 0, 0}, Vec3{0, 1, 0}};  ///< normal and tangents, unit [-]
    /// Friction coefficients about the axes [m], >= 0: the maximum couple per newton of pressing force, of spinning
    /// friction about the normal and rolling friction about the tangents. The limits about the tangents form an
    /// ellipse.
    Vec3 m_friction;
    Vec3 m_spin;               ///< angular velocity of an immovable other side [rad/s]
    double m_maxLoad = 1e300;  ///< maximum pressing impulse that counts [N s], > 0
    double m_lever = 1;        ///< lever that converts spin to speed for error measures [m], > 0
    Vec3 m_impulse;            ///< output: angular impulse on the first side [N m s]
};

/// The input of ContactSolver: bodies, contacts and joints that are solved together. Vectors keep their capacity for
/// reuse. Nothing is checked: indices must be in range, and all numbers finite.
struct BULLETFEM_API ContactProblem
{
    std::vector<ContactBody> m_bodies;          ///< each listed once
    std::vector<RigidProxy> m_rigidProxies;     ///< each listed once
    std::vector<RigidResponse> m_responses;     ///< responses of articulated rigid proxies
    std::vector<ContactPoint> m_contacts;       ///< contacts; the result depends on their order
    std::vector<Joint> m_joints;                ///< joints; the result depends on their order
    std::vector<RigidContact> m_rigidContacts;  ///< contacts between rigid proxies; the result depends on their order
    std::vector<TorsionalFriction> m_torsions;  ///< torsional frictions; the result depends on their order
    /// Per contact: index of the torsional friction that it presses on, or -1; contacts beyond the array's end have
    /// none.
    std::vector<int> m_torsionOf;
    std::vector<int> m_handleNodes;          ///< nodes of soft sides of joints and of patches, concatenated
    std::vector<Mat3> m_handleBlocks;        ///< one per entry of m_handleNodes [-]
    std::vector<RigidJacobian> m_jacobians;  ///< of rigid sides of joints

    /// Empties all vectors; keeps their memory.
    void clear();
};

}  // namespace bullet_fem
