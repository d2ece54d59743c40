// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <vector>

#include "fem/contact/contact_rows.h"
#include "fem/contact/envelope_factor.h"

namespace bullet_fem
{

/// Joints that hold many nodes of one body to what does not move. Between nodes i and j, W_ij = s R_i (A0^-1)_ij R_j^T:
/// but for the rotations R and the scale s that is a constant of the model, and so is its factor, which therefore is
/// made once for a set of nodes and not in every step (NodeSetFactors). Grows, never shrinks.
class RotatedAnchorFactor
{
public:
    /// The rows must outlive it.
    explicit RotatedAnchorFactor(ContactRows& rows) : m_rows(rows) {}

    /// Looks for them among the joints, the rows from `first` on, when the rows are assembled anew; isHeld has three
    /// flags a joint, of which none may be set. A body's are found where all its joints are such, one after another.
    void find(int first, const std::vector<unsigned char>& isHeld);

    /// True of a joint that was found.
    bool has(int joint) const { return m_runOf[joint] >= 0; }

    /// True if W of its body is still of the form that the factor is for.
    bool isStillOne(int joint) const;

    bool hasAny() const { return m_left > 0; }
    bool hasAll() const { return m_left == static_cast<int>(m_runOf.size()); }

    /// Forgets the joints of the body that this one holds, or all.
    void drop(int joint);
    void dropAll();

    /// x = W^-1 x for the unknowns of the joints found, along the joints' axes, three a joint; leaves the others.
    void solve(std::vector<double>& x) const;

private:
    struct Run  // of joints, all of one body
    {
        Range m_joints = {0, 0};
        int m_body = 0;
        std::shared_ptr<const EnvelopeFactor> m_factor;
    };

    int nodeOf(int joint, const std::vector<unsigned char>& isHeld) const;
    bool standsStill(const ConstraintSide& end) const;
    void addRun(Range joints);
    const ContactRow& row(int joint) const { return m_rows.rows()[m_first + joint]; }

    ContactRows& m_rows;
    int m_first = 0, m_left = 0;
    std::vector<int> m_jointsOf;  // per body
    std::vector<int> m_nodeOf;    // per joint: the node that it holds, or -1
    std::vector<int> m_runOf;     // per joint, or -1
    std::vector<Mat3> m_turn;     // per joint: R of that node
    std::vector<Run> m_runs;
    std::vector<int> m_nodes;  // of one run
};

}  // namespace bullet_fem
