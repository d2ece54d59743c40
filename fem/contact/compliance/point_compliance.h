// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/contact/contact_problem.h"
#include "fem/contact/compliance/response_kernel.h"
#include "fem/contact/compliance/rigid_side.h"

namespace bullet_fem
{

/// Compliance between points of a body's surface: the rigid response at the present positions, six numbers per point
/// and axis in double precision, plus an elastic one, S^T N S, with the points' weights S and the blocks N_ij between
/// nodes, a scale s times R_i B_ij R_j^T, B = A0^-1 without rest modes. Nodes outside the factor have only the inverse
/// diagonal in B, fixed ones zero in N. N is dense over the slots: the nodes of all points, then one slot of its own
/// for each side that is no weighted mean of nodes, whose part of N is set from outside. Symmetric. Grows, never
/// shrinks.
class PointCompliance
{
public:
    /// Removes all points, for a body of this many nodes.
    void clear(std::size_t nodes);

    /// Appends a point.
    void add(const SurfacePoint& point);

    /// Appends a point with a slot of its own.
    void addOwn();

    /// Call when all points are added: assigns slots to their nodes.
    void numberSlots();

    /// Requests the columns of all nodes with slots from the body's cache: call form() before the cache drops them.
    /// Bodies of one cache must not request concurrently.
    void request(const ContactBody& body, const Threads* threads = nullptr);

    /// Forms N for scale s and the slots' shares in rigid motion; N is zero for points with slots of their own.
    void form(const ContactBody& body, double scale, const std::vector<RigidMomentum::Share>& shares);

    /// Multiplies N by a factor.
    void scaleElastic(double factor);

    int points() const { return static_cast<int>(m_first.size()) - 1; }

    /// The nodes, ascending, and the number of slots: those of the nodes, then those of points with slots of their own,
    /// in their order.
    const std::vector<int>& nodes() const { return m_nodes; }
    int slots() const { return static_cast<int>(m_nodes.size()) + m_own; }

    /// The slot of a point with its own slot.
    int slot(int point) const { return m_slot[m_first[point]]; }

    /// Calls visit(slot, weight) for the slots of a point; number of such calls for all points.
    template <class Visit>
    void forEachSlot(int point, const Visit& visit) const
    {
        for (int k = m_first[point]; k < m_first[point + 1]; ++k) visit(m_slot[k], m_weight[k]);
    }
    std::size_t terms() const { return m_slot.size(); }

    /// Length of a vector over the slots, three components each, padded for kernels.
    std::size_t order() const { return padded(3 * static_cast<std::size_t>(slots()), kResponsePadding); }

    /// Sets entries of N in place of those of form(): set(i, j) sets (j, i) as well; indices are three times a slot
    /// plus an axis. setResponse(slot, j) sets those of a slot, but no entry of its own column twice.
    void set(std::size_t i, std::size_t j, double value);
    void setResponse(std::size_t slot, std::size_t j, const Vec3& velocity);

    /// The rigid part of a point, and of a slot.
    const RigidSide& rigid(int point) const { return m_rigid[point]; }
    const RigidSide& rigidOfSlot(int slot) const { return m_rigidOfSlot[slot]; }

    /// Adds rigid motions of the components to slot values.
    void addRigid(const std::vector<RigidMotion>& motions, std::vector<double>& slotValues) const;

    /// Interpolation of slot values at a point.
    Vec3 read(int point, const std::vector<double>& slotValues) const;

    /// Elastic response of the slots to an impulse on one, order() values.
    Response response(int slot, const Vec3& impulse) const
    {
        return {column(3 * static_cast<std::size_t>(slot)), m_rows, impulse};
    }

    /// W_ef, the velocity of e for an impulse on f, and its elastic part.
    Mat3 block(int e, int f) const { return m_rigid[e].block(m_rigid[f]) + elasticBlock(e, f); }
    Mat3 elasticBlock(int e, int f) const;

private:
    const float* column(std::size_t j) const { return m_N.data() + j * m_rows; }
    float* column(std::size_t j) { return m_N.data() + j * m_rows; }
    void turnNodes(const ContactBody& body);
    void formNodeColumns(const ContactBody& body, double scale);
    void addRestModes(const ContactBody& body, double scale, std::size_t slot);
    void setRigid(const ContactBody& body, const std::vector<RigidMomentum::Share>& shares);
    void mirrorNodeColumns();

    std::vector<int> m_first;  // per point: start in the weights, then the end
    std::vector<double> m_weight;
    std::vector<int> m_slot;  // per weight: slot; until numberSlots() the node, or -1 for a point with its own slot
    int m_own = 0;            // number of points with their own slots
    std::vector<int> m_nodes;
    std::vector<int> m_slotOfNode;         // slot of each node of the body
    std::vector<int> m_offsets;            // offset of each of m_nodes in the cache's columns
    std::vector<float> m_rotations;        // rotation of each of m_nodes, in the layout of RestColumn
    std::size_t m_rows = 0;                // rows of N, padded
    std::vector<float> m_N;                // column by column
    std::vector<RigidSide> m_rigidOfSlot;  // rigid parts of the slots
    std::vector<RigidSide> m_rigid;        // and of the points
};

}  // namespace bullet_fem
