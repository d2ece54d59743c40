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

/// Cache of the surface compliance of a model, for ContactSolver::solve; bodies of one model may share it on one
/// thread. `model` must not be null.
BULLETFEM_API std::shared_ptr<ComplianceCache> makeComplianceCache(std::shared_ptr<const BodyModel> model);

/// The same for contact points on other nodes than those of the mesh's surface: each once, in [0, n).
BULLETFEM_API std::shared_ptr<ComplianceCache> makeComplianceCache(std::shared_ptr<const BodyModel> model,
                                                                   std::vector<int> nodes);

/// A rigid body as the contact solver sees it.
struct RigidProxy
{
    Vec3 m_inverseMass;       ///< along the world axes [1/kg]; 0 for static and kinematic ones
    Mat3 m_inverseInertia;    ///< world axes [1/(kg m2)]
    Vec3 m_center;            ///< centre of mass [m]
    Vec3 m_linearVelocity;    ///< [m/s]; solve() adds what the contacts do
    Vec3 m_angularVelocity;   ///< [rad/s]; likewise
    Vec3 m_pushLinear;        ///< written by solve(): velocity of position correction alone, never kept as motion [m/s]
    Vec3 m_pushAngular;       ///< likewise [rad/s]
    Vec3 m_angularImpulse;    ///< written by solve(): pays back the angular momentum that corrections made [N m s]
    int m_firstResponse = 0;  ///< its responses are m_responses[m_firstResponse ... + m_responseCount) of the problem
    /// > 0: they tell what impulses on it do, and inverse mass and inertia only that it moves.
    int m_responseCount = 0;
    Vec3 m_pushImpulse;         ///< written by solve() if it has responses: what makes the push [N s]
    Vec3 m_pushAngularImpulse;  ///< likewise, about its centre [N m s]
    Vec3 m_accumulatedImpulse;  ///< written by the solver if it has responses: what contacts and joints gave it so far
                                ///< [N s]
    Vec3 m_accumulatedAngularImpulse;  ///< likewise, about its centre [N m s]

    /// True if an impulse moves or turns it.
    bool canMove() const { return dot(m_inverseMass, m_inverseMass) > 0 || squaredNorm(m_inverseInertia) > 0; }
    /// Of the rigid motion at a point [m/s].
    Vec3 velocityAt(const Vec3& point) const { return m_linearVelocity + cross(m_angularVelocity, point - m_center); }
};

/// What an impulse on one rigid proxy does to another that hangs on the same joints, or to itself: links of an
/// articulated body, which no mass and inertia describe. For impulses f and angular impulses t about the one's centre,
/// the other's centre gets m_linear f + m_linearOfAngular t, its spin m_angularOfLinear f + m_angular t. World axes.
struct RigidResponse
{
    int m_rigidProxy = 0;    ///< index of the one that moves
    Mat3 m_linear;           ///< [1/kg]
    Mat3 m_linearOfAngular;  ///< [1/(kg m)]
    Mat3 m_angularOfLinear;  ///< [1/(kg m)]
    Mat3 m_angular;          ///< [1/(kg m2)]
};

/// A point of a soft surface: a weighted sum of nodes of a body, of those that its compliance cache serves. An impulse
/// on it is shared out by the same weights, and so has no other moment than that of the impulse at the point.
struct SurfacePoint
{
    static constexpr int kMaxNodes = 12;  ///< three corners of a triangle, each in a tetrahedron
    [[deprecated("kMaxNodes")]] static constexpr int kMostNodes = kMaxNodes;

    int m_body = -1;                                   ///< index into the bodies of the solve; -1: none
    std::array<int, kMaxNodes> m_nodes = {0, 0, 0};    ///< of a surface of the mesh its triangle's; may repeat
    std::array<double, kMaxNodes> m_weights = {1, 0};  ///< [-], sum 1
    int m_count = 3;                                   ///< nodes that it has, in [1, kMaxNodes]

    /// What the nodes have, at the point.
    Vec3 of(const std::vector<Vec3>& nodeValues) const
    {
        const auto part = [&](std::size_t a)
        { return m_weights[a] * nodeValues[static_cast<std::size_t>(m_nodes[a])]; };
        Vec3 sum = part(0);
        for (int a = 1; a < m_count; ++a) sum += part(static_cast<std::size_t>(a));
        return sum;
    }
};

/// Where a soft surface touches a rigid proxy, another soft body or itself, or may do so within the step.
struct ContactPoint
{
    SurfacePoint m_soft;    ///< feels the impulse
    SurfacePoint m_other;   ///< feels the opposite, where the other side is soft; its m_body is -1 otherwise
    int m_rigidProxy = -1;  ///< index into the rigid proxies of the solve, where the other side is rigid; -1 otherwise
    Vec3 m_point;     ///< where both sides feel the impulse: the soft point, between two soft ones their middle [m]
    Vec3 m_approach;  ///< added to m_point for the arm of a rigid proxy that it meets later in the step: what they come
                      ///< closer until then [m]
    Vec3
        m_patch;  ///< added to m_point for the levers of both sides: to where the patch, as it moves, has come from [m]
    bool m_isMetLater = false;  ///< the rigid proxy's arm is to m_point + m_patch + m_approach, whatever the soft one's
    Vec3 m_arm;                 ///< of the rigid proxy, from its centre [m]: part of the answer
    Vec3 m_normal;              ///< unit [-], from the other side to m_soft
    double m_gap = 0;           ///< signed distance at the start [m]; negative inside
    double m_slop = 0;          ///< penetration that is left alone [m], >= 0
    double m_hardness = 1;      ///< factor on ContactSettings::m_pushFraction [-], >= 0
    double m_friction = 0;      ///< Coulomb's coefficient [-], >= 0
    double m_restitution = 0;   ///< share of the speed of an impact that is given back [-], in [0, 1]; not read by
                                ///< the solver
    double m_stiffness = 0;     ///< of a contact spring in place of the rigid contact [N/m], >= 0; 0: rigid
    double m_damping = 0;       ///< of that spring [N s/m], >= 0
    Vec3 m_impulse;             ///< on m_soft [N s]: a guess before, the answer after
    Vec3 m_slip;  ///< displacement of a point that sticks, in the tangent plane [m]: taken back within some steps; that
                  ///< of the last step before, the new one after
};

/// Where a rigid proxy touches another, or something immovable: a row that keeps the two apart. Its impulses are part
/// of the rigid proxies' new velocities, and told nowhere else.
struct RigidContact
{
    int m_rigidProxy = -1;    ///< index into the rigid proxies of the solve
    int m_other = -1;         ///< likewise; -1: immovable
    Vec3 m_arm;               ///< from its centre to where they touch [m]
    Vec3 m_otherArm;          ///< likewise from the other's; not read where that is immovable
    Vec3 m_normal;            ///< unit [-], from the other to the rigid proxy
    double m_gap = 0;         ///< signed distance [m]; negative inside
    bool m_moves = true;      ///< the velocities of the solve will bring them together or apart from there
    double m_leastSpeed = 0;  ///< at which they part along the normal, at least; < 0: they may close [m/s]
    Vec3 m_otherVelocity;     ///< of what is immovable, where they touch; m_leastSpeed is relative to it, and so is the
                              ///< sliding that friction acts against [m/s]
    double m_friction = 0;    ///< Coulomb's coefficient [-], >= 0
    bool m_pushOnly = false;  ///< it counts for position corrections alone
    bool m_isSupport = false;  ///< the other stands still, whatever happens
};

using RigidTouch [[deprecated("RigidContact")]] = RigidContact;

/// A body with its compliance cache. Neither may be null, and both must live until the solve is over.
struct ContactBody
{
    Body* m_body = nullptr;                   ///< has had solveFreeMotion
    ComplianceCache* m_compliance = nullptr;  ///< of the body's model
    /// FreeMotion::m_predicted, [N s], one a node: what it has in its velocities of the impulses that its contacts
    /// start with. Null: nothing.
    const std::vector<Vec3>* m_predicted = nullptr;
};

/// How a ContactProblem is solved.
struct ContactSettings
{
    StepSettings m_step;   ///< of the corrective solves
    int m_rounds = 1;      ///< corrective solves at least, in [1, 100]
    int m_maxRounds = 10;  ///< and at most, >= m_rounds, while the error exceeds m_tolerance; twice as many for joints
    int m_sweeps = 50;     ///< sweeps a round at most, in [1, 1000]
    /// Error of velocities at which contact ends, as a share of the speed that the loads give a body in a step, or of
    /// what contact changes at first if that is more [-], > 0. At most what a thousandth of
    /// an element's edge a step is, where that is finer. Joints are solved to 1e-3 of the speed that loads give, and of
    /// the impulses on their bodies.
    double m_tolerance = 3e-5;
    bool m_untilSolved = false;    ///< rounds go on to m_maxRounds even where one hardly lowers the error
    int m_denseLimit = 400;        ///< points of a body up to which its compliance is formed as a dense matrix, >= 0
    double m_pushFraction = 0.2;   ///< share of a penetration that is taken back a step [-], in [0, 1]
    double m_maxPushVelocity = 1;  ///< speed at which penetration is taken back at most [m/s], >= 0
    double m_slipFraction = 0.2;   ///< share of the slip of a sticking point that is taken back a step [-], in [0, 1]
};

/// What a solve took, and how good it is.
struct ContactReport
{
    int m_contacts = 0;       ///< points given
    int m_rounds = 0;         ///< corrective solves made, each of all bodies
    int m_sweeps = 0;         ///< in all rounds
    int m_iterations = 0;     ///< conjugate gradient iterations of all corrective solves of all bodies
    double m_violation = 0;   ///< largest speed at which a contact still closes faster than its gap allows [m/s], >= 0
    bool m_converged = true;  ///< all corrective solves met their tolerance
};

/// One end of a joint: a point or a group of nodes of a soft body, or a rigid body.
struct JointEnd
{
    int m_body = -1;         ///< soft end: index into the bodies of the solve
    int m_first = 0;         ///< soft end: its nodes are m_handleNodes[m_first ... m_first + m_count) of the problem
    int m_count = 0;         ///< and its velocity is the sum of m_handleBlocks times theirs
    int m_rigidProxy = -1;   ///< rigid end: index into the rigid proxies; an end of neither is fixed in the world
    Vec3 m_point;            ///< rigid end: where it is held [m]
    bool m_angular = false;  ///< rigid end: its velocity is the angular one, and impulses are angular
};

/// Holds the relative velocity of two ends, a - b, at a wanted value along three axes: anchors, attachments, motors.
struct Joint
{
    static constexpr double kUnlimited = 1e300;  ///< as m_limit: no limit [N s] or [N m s]

    JointEnd m_a;  ///< what it joins; the impulse acts on it
    JointEnd m_b;  ///< what it is joined to; the opposite impulse acts on it
    std::array<Vec3, 3> m_axes = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};  ///< orthonormal [-]
    Vec3 m_wanted;  ///< relative velocity along the axes [m/s] or [rad/s]: error correction, motor speed
    Vec3 m_limit = {kUnlimited, kUnlimited,
                    kUnlimited};       ///< largest impulse along every axis [N s] or [N m s], >= 0; 0: axis is free
    double m_maxImpulse = kUnlimited;  ///< largest impulse of all axes together [N s] or [N m s], > 0
    double m_compliance = 0;  ///< compliance added, of an implicit spring [1/kg] or [1/(kg m2)], >= 0; 0: rigid
    double m_softness = 0;    ///< compliance added, as a share of the joint's own [-], >= 0; 0: rigid
    Vec3 m_impulse;           ///< on end a, world axes [N s] or [N m s]: a guess before, the answer after
};

/// Rolling and spinning friction where a face of a rigid proxy lies on a patch of a soft surface: a couple between the
/// two against their relative spin, Coulomb's law with coefficients that are lengths. The patch spins as its nodes do
/// in the mean of least squares, and feels the couple by the transpose of that: its forces have no sum.
struct TorsionalFriction
{
    int m_body = 0;        ///< soft side: index into the bodies of the solve
    int m_first = 0;       ///< its nodes are m_handleNodes[m_first ... m_first + m_count) of the problem
    int m_count = 0;       ///< and its spin is the sum of m_handleBlocks [1/m] times their velocities
    int m_rigidProxy = 0;  ///< the other side: index into the rigid proxies
    std::array<Vec3, 3> m_axes = {Vec3{0, 0, 1}, Vec3{1, 0, 0}, Vec3{0, 1, 0}};  ///< normal and tangents, unit [-]
    /// About every axis [m], >= 0: spinning friction about the normal, rolling friction about the tangents; the largest
    /// couple per newton that presses the two together. About tangents the two make an ellipse.
    Vec3 m_friction;
    double m_lever = 1;  ///< at which a spin counts as a speed, where errors are compared [m], > 0
    Vec3 m_impulse;      ///< angular impulse on the patch [N m s]: the answer
};

/// All that is solved together: bodies, what they touch, and what holds them. Vectors are kept to be used again.
/// Nothing is checked: indices must be in range, and all numbers finite.
struct BULLETFEM_API ContactProblem
{
    std::vector<ContactBody> m_bodies;          ///< each once
    std::vector<RigidProxy> m_rigidProxies;     ///< each once
    std::vector<RigidResponse> m_responses;     ///< of the rigid proxies that have some
    std::vector<ContactPoint> m_contacts;       ///< between them; their order decides
    std::vector<Joint> m_joints;                ///< likewise
    std::vector<RigidContact> m_rigidContacts;  ///< likewise
    std::vector<TorsionalFriction> m_torsions;  ///< likewise
    std::vector<int> m_torsionOf;      ///< per contact: the one it presses on, or -1; of those beyond its end: none
    std::vector<int> m_handleNodes;    ///< nodes of soft ends of joints and patches, one end's after another
    std::vector<Mat3> m_handleBlocks;  ///< one a handle node [-]

    /// Empties all; nothing is freed.
    void clear();
};

}  // namespace bullet_fem
