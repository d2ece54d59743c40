// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/contact/contact_problem.h"
#include "fem/contact/response_kernel.h"

namespace bullet_fem
{

/// What impulses on points of a body's surface do to the velocities of the nodes that they are on, and so to each
/// other: W = S^T N S, with the blocks N_ij = s R_i (A0^-1)_ij R_j^T between the nodes, the points' weights S and a
/// scale s. Of nodes that are in no factor N has the inverse diagonal alone, of fixed ones nothing. Points outnumber
/// the nodes, and few of them ever feel an impulse: W is never formed as a whole, but the columns N S of those that do.
/// What does not move as nodes by weights is a slot of its own behind the nodes, whose part of N is set from outside.
/// Symmetric. Grows, never shrinks.
class PointCompliance
{
public:
    /// Forgets all points. The body has so many nodes.
    void clear(std::size_t nodes);

    /// The next point.
    void add(const SurfacePoint& point);

    /// The next one is a slot of its own.
    void addOwn();

    /// When all points are added: gives their nodes slots.
    void numberSlots();

    /// Asks the body's cache for the columns of all nodes that have slots: form() is to be called before the cache has
    /// forgotten them. Bodies of one cache cannot ask at the same time.
    void request(const ContactBody& body, const Threads* threads = nullptr);

    /// Forms N for scale s; zero for slots of points of their own.
    void form(const ContactBody& body, double scale);

    /// Scales N.
    void scale(double factor);

    int points() const { return static_cast<int>(m_first.size()) - 1; }

    /// The nodes, ascending, and how many slots there are: these, then the points of their own in their order.
    const std::vector<int>& nodes() const { return m_nodes; }
    int slots() const { return static_cast<int>(m_nodes.size()) + m_own; }

    /// The slot of a point of its own.
    int slot(int point) const { return m_slot[m_first[point]]; }

    /// Components of a vector over the slots, three each, padded as kernels want it.
    std::size_t order() const { return padded(3 * static_cast<std::size_t>(slots()), kResponsePadding); }

    /// N, for what form() leaves out: set(i, j) sets (j, i) as well; i and j are three times a slot plus an axis.
    void set(std::size_t i, std::size_t j, double value);

    /// Adds to N likewise. After the last call forgetColumns() is due, for columns of points were formed from N before.
    void add(std::size_t i, std::size_t j, double value);
    void forgetColumns();

    /// What slots have, at a point.
    Vec3 read(int point, const std::vector<double>& slotValues) const;

    /// What an impulse on a point does to the slots, order() of them; its columns are formed when first asked for.
    Response response(int point, const Vec3& impulse) { return {columns(point), m_rows, impulse}; }

    /// W_ef, the velocity of e for an impulse on f; between two of which f is asked for often, by its columns.
    Mat3 block(int e, int f) const;
    Mat3 blockByColumns(int e, int f) { return readColumns(e, columns(f)); }

private:
    const float* columns(int point);
    Mat3 readColumns(int point, const float* columns) const;
    const float* column(std::size_t j) const { return m_N.data() + j * m_rows; }
    float* column(std::size_t j) { return m_N.data() + j * m_rows; }
    void turnNodes(const ContactBody& body);
    void formNodeColumns(const ContactBody& body, double scale);
    void mirrorNodeColumns();

    std::vector<int> m_first;  // weight of every point, and the end
    std::vector<double> m_weight;
    std::vector<float> m_floatWeight;  // the same
    std::vector<int> m_slot;           // per weight; until numberSlots() the node, or -1 of a point of its own
    int m_own = 0;                     // points that are slots
    std::vector<int> m_nodes;
    std::vector<int> m_slotOfNode;   // of the body
    std::vector<int> m_offsets;      // of m_nodes in the cache's columns
    std::vector<float> m_rotations;  // of m_nodes, as RestColumn wants them
    std::size_t m_rows = 0;          // of N, padded
    std::vector<float> m_N;          // column by column
    std::vector<int> m_columnsOf;    // per point: which of m_columns, or -1
    std::vector<float> m_columns;    // of N S, room for all points
    int m_columnsFormed = 0;
    std::vector<const float*> m_terms;  // of one sum
};

}  // namespace bullet_fem
