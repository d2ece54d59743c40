// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/contact_solver.h"
#include "fem/contact/dense_compliance.h"

namespace bullet_fem
{

/// Forms the dense compliance between points of a body's surface: W = S^T N S, with the blocks
/// N_ij = s R_i (A0^-1)_ij R_j^T between the nodes that they are on, the points' weights S and a scale s. Of nodes that
/// are in no factor N has the inverse diagonal alone, of fixed ones nothing. Symmetric. Grows, never shrinks.
class PointCompliance
{
public:
    /// Forgets all points. The body has so many nodes.
    void clear(std::size_t nodes);

    /// The next point.
    void add(const SurfacePoint& point);

    /// The next one has no nodes: its rows and columns are zero.
    void addEmpty() { m_firstWeight.push_back(static_cast<int>(m_weight.size())); }

    /// Asks the body's cache for the columns of all nodes, and writes W.
    void form(const ContactBody& body, double scale, DenseCompliance& W);

private:
    struct Columns  // of values in single precision, one behind another
    {
        std::size_t m_rows = 0;
        std::vector<float> m_values;

        void resize(std::size_t rows, std::size_t columns);
        float* column(std::size_t j) { return &m_values[j * m_rows]; }
    };

    int points() const { return static_cast<int>(m_firstWeight.size()) - 1; }
    void listNodes();
    void turnNodes(const ContactBody& body);
    void formNodeColumns(const ContactBody& body, double scale);
    void mirrorNodeColumns();
    void sumOverNodes(Columns& of, int point, int axis, float* sum);

    std::vector<int> m_firstWeight;  // per point, and the end
    std::vector<float> m_weight;
    std::vector<int> m_node;            // per weight, of the body; then its place in m_nodes
    std::vector<int> m_nodes;           // of all points, ascending
    std::vector<int> m_placeOfNode;     // of the body
    std::vector<int> m_offsets;         // of m_nodes in the cache's columns, padded
    std::vector<float> m_rotations;     // nine arrays, padded
    Columns m_N;                        // of the nodes
    Columns m_half, m_transposedHalf;   // N S: a column an axis of a point; and a column an axis of a node
    std::vector<const float*> m_terms;  // of one sum
};

}  // namespace bullet_fem
