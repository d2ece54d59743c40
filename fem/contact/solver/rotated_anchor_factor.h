// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <vector>

#include "fem/contact/compliance/envelope_factor.h"
#include "fem/contact/constraints/contact_rows.h"

namespace bullet_fem
{

/// Joints that hold many nodes of one body to immovable objects. Between nodes i and j, W_ij = s R_i (A0^-1)_ij R_j^T:
/// except for the rotations R and the scale s this is a constant of the model, and so is its factor, which is therefore
/// computed once per set of nodes instead of in every step (NodeSetFactors). Grows, never shrinks.
class RotatedAnchorFactor
{
public:
    /// The rows must outlive it.
    explicit RotatedAnchorFactor(ContactRows& rows) : m_rows(rows) {}

    /// Finds such joints among the rows from `first` on; call when the rows are assembled anew. isHeld has three flags
    /// per joint, none of which may be set. A body qualifies if all its joints are such, and consecutive.
    void find(int first, const std::vector<unsigned char>& isHeld);

    /// True for a joint that was found.
    bool has(int joint) const { return m_runOf[joint] >= 0; }

    /// True if W of its body still has the form of the factor.
    bool isStillOne(int joint) const;

    bool hasAny() const { return m_left > 0; }
    bool hasAll() const { return m_left == static_cast<int>(m_runOf.size()); }

    /// Drops the joints of the body that this one holds, or all.
    void drop(int joint);
    void dropAll();

    /// x = W^-1 x for the unknowns of the joints found, along the joints' axes, three per joint; leaves the others
    /// unchanged.
    void solve(std::vector<double>& x) const;

private:
    struct Run  // consecutive joints of one body
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
    std::vector<int> m_jointsOf;  // number of joints per body
    std::vector<int> m_nodeOf;    // per joint: the node that it holds, or -1
    std::vector<int> m_runOf;     // run of each joint, or -1
    std::vector<Mat3> m_turn;     // per joint: R of that node
    std::vector<Run> m_runs;
    std::vector<int> m_nodes;  // nodes of one run
};

}  // namespace bullet_fem
