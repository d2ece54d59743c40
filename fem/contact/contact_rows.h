// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/contact_solver.h"
#include "fem/contact/compliance_cache.h"

namespace bullet_fem
{

/// The rows of all contacts of a step: their compliance W, their relative velocities, and Gauss-Seidel sweeps over
/// both. Grows with the number of contacts, never shrinks.
class ContactRows
{
public:
    /// W_kl = sum w_a w_b R_a (A0^-1)_ab R_b^T for contacts k, l of one body, and the frame of every contact.
    void assemble(const std::vector<ContactBody>& bodies, const std::vector<Obstacle>& obstacles,
                  const std::vector<ContactPoint>& contacts, const StepSettings& step);

    /// Gives the obstacles the reactions of the impulses that the contacts start with.
    void warmStart(const std::vector<ContactPoint>& contacts, std::vector<Obstacle>& obstacles) const;

    /// Relative velocities from the bodies' true ones, which hold the `applied` impulses, plus W times the rest.
    void measureVelocities(const std::vector<ContactBody>& bodies, const std::vector<ContactPoint>& contacts,
                           const std::vector<Vec3>& applied);

    /// Compares the velocities that the rows predicted for the impulses beyond `applied` with the bodies' true ones,
    /// and scales W of a body up where it was too stiff: then the next sweeps overshoot no more. To be called after the
    /// corrective solve, before measureVelocities.
    void learnCompliance(const std::vector<ContactBody>& bodies, const std::vector<Obstacle>& obstacles,
                         const std::vector<ContactPoint>& contacts, const std::vector<Vec3>& applied);

    /// The largest speed [m/s] at which a contact closes faster than its gap allows, from the bodies' true velocities.
    double worstViolation(const std::vector<ContactBody>& bodies, const std::vector<Obstacle>& obstacles,
                          const std::vector<ContactPoint>& contacts) const;

    /// Projected Gauss-Seidel on normal and friction impulses; the obstacles' velocities follow. Returns the sweeps
    /// made.
    int sweep(std::vector<Obstacle>& obstacles, std::vector<ContactPoint>& contacts, const ContactSettings& settings);

    /// True if a penetration exceeds the slop.
    static bool needPush(const std::vector<ContactPoint>& contacts);

    /// The same on normals alone, for the velocities that take penetration back; `push` receives the impulses that
    /// would make them. Returns the sweeps made.
    int sweepPush(std::vector<Obstacle>& obstacles, const std::vector<ContactPoint>& contacts,
                  const ContactSettings& settings, std::vector<Vec3>& push);

private:
    struct Row
    {
        Vec3 m_velocity;  // of the soft side, as predicted [m/s]
        Vec3 m_before;    // the same before the impulses of this round
        Vec3 m_arm;       // from the obstacle's centre to the point [m]
        Mat3 m_diagonal;  // own compliance, obstacle included [1/kg]
        Vec3 m_tangent[2];
        double m_normalCompliance, m_tangentCompliance;  // the largest in the tangent plane [1/kg]
    };

    void assembleBody(const ContactBody& body, int bodyIndex, const std::vector<ContactPoint>& contacts, Warp warp);
    void prepareRows(const std::vector<Obstacle>& obstacles, const std::vector<ContactPoint>& contacts);
    void prepareRow(const Obstacle& obstacle, const ContactPoint& contact, Row& row) const;
    void addResponse(int contact, const Vec3& impulse);
    const Mat3& W(int k, int l) const;

    std::vector<Row> m_rows;
    std::vector<Mat3> m_W;                  // for every body its block, row-major over its contacts
    std::vector<int> m_bodyFirst;           // first contact of every body, and one past the last
    std::vector<std::size_t> m_blockStart;  // of every body's block in m_W
    std::vector<int> m_bodyOfContact;
    std::vector<int> m_touched;  // nodes of one body
    double m_step = 0;
};

}  // namespace bullet_fem
