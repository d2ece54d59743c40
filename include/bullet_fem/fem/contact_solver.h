// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "bullet_fem/fem/body.h"

namespace bullet_fem
{

class ComplianceCache;

/// Cache of the surface compliance of a model, for ContactSolver::solve; bodies of one model may share it on one
/// thread.
std::shared_ptr<ComplianceCache> makeComplianceCache(std::shared_ptr<const BodyModel> model);

/// A rigid body as the contact solver sees it.
struct Obstacle
{
    Vec3 m_inverseMass;      ///< along the world axes [1/kg]; 0 for static and kinematic ones
    Mat3 m_inverseInertia;   ///< world axes [1/(kg m2)]
    Vec3 m_center;           ///< centre of mass [m]
    Vec3 m_linearVelocity;   ///< [m/s]; solve() adds what the contacts do
    Vec3 m_angularVelocity;  ///< [rad/s]; likewise
    Vec3 m_pushLinear;       ///< written by solve(): velocity of position correction alone, never kept as motion [m/s]
    Vec3 m_pushAngular;      ///< likewise [rad/s]
    Vec3 m_angularImpulse;   ///< written by solve(): pays back the angular momentum that corrections made [N m s]

    Vec3 velocityAt(const Vec3& point) const { return m_linearVelocity + cross(m_angularVelocity, point - m_center); }
};

/// A point of a soft surface that touches an obstacle, or may do so within the step.
struct ContactPoint
{
    int m_body = 0;                               ///< index into the bodies of the solve; contacts are sorted by it
    int m_obstacle = 0;                           ///< index into the obstacles of the solve
    std::array<int, 3> m_nodes = {0, 0, 0};       ///< surface nodes of the body; unused ones repeat the first
    std::array<double, 3> m_weights = {1, 0, 0};  ///< barycentric [-], sum 1
    Vec3 m_point;                                 ///< where both sides feel the impulse: the soft point [m]
    Vec3 m_normal;                                ///< unit, from the obstacle to the soft surface
    double m_gap = 0;                             ///< signed distance at the start [m]; negative inside
    double m_slop = 0;                            ///< penetration that is left alone [m], >= 0
    double m_friction = 0;                        ///< Coulomb's coefficient [-], >= 0
    Vec3 m_impulse;                               ///< on the soft body [N s]: a guess before, the answer after
};

/// A body with its compliance cache.
struct ContactBody
{
    Body* m_body = nullptr;
    ComplianceCache* m_compliance = nullptr;
};

struct ContactSettings
{
    StepSettings m_step;   ///< of the corrective solves
    int m_rounds = 2;      ///< corrective solves at least, in [1, 100]
    int m_maxRounds = 10;  ///< and at most, while a round still changes impulses by more than m_roundTolerance
    double m_roundTolerance = 5e-3;  ///< of the largest impulse [-], > 0
    int m_sweeps = 50;               ///< Gauss-Seidel sweeps a round at most, in [1, 1000]
    double m_sweepTolerance =
        1e-9;  ///< stop sweeping when the largest change of an impulse is this share of the largest [-]
    double m_pushFraction = 0.2;   ///< share of a penetration that is taken back a step [-], in [0, 1]
    double m_maxPushVelocity = 1;  ///< [m/s], >= 0
};

struct ContactReport
{
    int m_contacts = 0;       ///< points given
    int m_rounds = 0;         ///< corrective solves made, each of all bodies
    int m_sweeps = 0;         ///< in all rounds
    int m_iterations = 0;     ///< conjugate gradient iterations of all corrective solves of all bodies
    double m_violation = 0;   ///< largest speed at which a contact still closes faster than its gap allows [m/s], >= 0
    bool m_converged = true;  ///< all corrective solves met their tolerance
};

/// Frictional contact in compliance space. After solveFreeMotion of every body, finds impulses with
///     normal: lambda_n >= 0, n . v + max(gap, 0) / h >= 0, complementary
///     friction: |lambda_t| <= mu lambda_n, opposite to the sliding velocity where it slides (Coulomb's disc)
/// for relative velocities v of soft against rigid. Their response is approximated by W = J P J^T with the warped rest
/// factor P for the sweeps, and solved for with the true system between rounds; where W turns out too stiff (a stale
/// factor), it is scaled up, and where it is too soft, more rounds follow. The same impulses act on both sides, so
/// momentum is conserved however good W is. Penetration is taken back as a displacement.
/// The scratch grows with the number of contacts and never shrinks.
class ContactSolver
{
public:
    ContactSolver();
    ~ContactSolver();

    /// Bodies must have had solveFreeMotion with settings.m_step. Adds the contacts' response to their velocities, and
    /// to the obstacles'. Deterministic: the order of contacts decides.
    ContactReport solve(const std::vector<ContactBody>& bodies, std::vector<Obstacle>& obstacles,
                        std::vector<ContactPoint>& contacts, const ContactSettings& settings);

private:
    struct Scratch;
    std::unique_ptr<Scratch> m_scratch;
};

}  // namespace bullet_fem
