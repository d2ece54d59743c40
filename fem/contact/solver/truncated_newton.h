// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "fem/contact/solver/joint_system.h"

namespace bullet_fem
{

/// Truncated nonsmooth Newton steps between sweeps of projected Gauss-Seidel [Graeser & Kornhuber 2009]: conjugate
/// gradients over the rows that the last sweep left sticking, and the normals of those that slide; then projection to
/// the friction cones and an exact line search, which stays in the cones because they are convex. Solves the rows at
/// once where sweeps pass impulses on slowly: stiff bodies between jaws, heavy bodies on light ones, towers. Joints
/// that are solved exactly follow every change, so that the steps solve for contacts and joints together. Steps that do
/// not pay become rare. Grows with the rows, never shrinks.
class TruncatedNewton
{
public:
    /// Both must outlive it.
    TruncatedNewton(ContactRows& rows, JointSystem& joints) : m_rows(rows), m_joints(joints) {}

    /// Call when the rows are assembled anew.
    void begin();

    /// Call if rows of others, or corrective solves, have changed velocities: the changes of earlier sweeps tell
    /// nothing about those to come.
    void restart() { m_waited = 0; }

    /// Call after every sweep over these rows with its change and the one at which sweeps end [-]. True if a step was
    /// due, and changed impulses and velocities.
    bool step(const std::vector<int>& working, double change, double tolerance);

private:
    struct Row  // in the row's axes
    {
        bool m_moves = false;                  // its impulse may change
        int m_free = 0;                        // 0: held, 1: the normal is free, 2: all axes are
        Vec3 m_start, m_velocity, m_residual;  // impulse, velocity and residual before the step
        Vec3 m_x, m_r, m_z, m_d;               // solution, residual, preconditioned residual, direction
        double m_elastic = 0;                  // elastic compliance of its sides alone [1/kg]
        Vec3 m_Wx, m_Wd;                       // products with compliance and yield
    };

    bool isDue(double change, double tolerance);
    void findFree(const std::vector<int>& working);
    void solve(const std::vector<int>& working);
    double precondition(const std::vector<int>& working);
    void multiply(const std::vector<int>& working);
    bool project(const std::vector<int>& working);
    void measure(const std::vector<int>& working);
    void search(const std::vector<int>& working);
    void move(const std::vector<int>& working, double ofX, double ofD);
    Vec3 velocity(const ContactRow& row) const;

    // Calls visit(of, row) for the rows whose impulses may change.
    template <class Visit>
    void forEachMoving(const std::vector<int>& working, const Visit& visit)
    {
        for (std::size_t k = 0; k < working.size(); ++k)
            if (m_of[k].m_moves) visit(m_of[k], m_rows.rows()[working[k]]);
    }

    ContactRows& m_rows;
    JointSystem& m_joints;
    std::vector<Row> m_of;     // per working row
    int m_waited = 0;          // sweeps since the last step
    int m_interval = 0;        // sweeps from one step to the next
    int m_budget = 0;          // iterations of a step
    int m_left = 0;            // of this step
    double m_changeFirst = 0;  // change by the first sweep of the interval
    double m_changeThen = 0;   // change before the last step, which the next sweep judges; 0: judged
};

}  // namespace bullet_fem
