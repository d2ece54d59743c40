// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

/// Indices of triangles, for range-based loops.
struct TriangleRange
{
    const int *m_begin, *m_end;
    const int* begin() const { return m_begin; }
    const int* end() const { return m_end; }
    std::size_t size() const { return static_cast<std::size_t>(m_end - m_begin); }
};

/// The unique edges of a surface, the edges of its triangles, and the triangles at its vertices and edges. Constant.
class SurfaceTopology
{
public:
    /// Vertices of the triangles are in [0, vertexCount).
    SurfaceTopology(const std::vector<Triangle>& triangles, int vertexCount);

    int vertexCount() const { return static_cast<int>(m_firstAround.size()) - 1; }
    int edgeCount() const { return static_cast<int>(m_edges.size()); }
    int triangleCount() const { return static_cast<int>(m_triangles.size()); }
    const std::vector<Triangle>& triangles() const { return m_triangles; }
    const std::vector<int>& vertices() const { return m_vertices; }           ///< of the triangles, ascending
    const std::vector<std::array<int, 2>>& edges() const { return m_edges; }  ///< vertices, the smaller one first
    /// Edges of a triangle; edge k is from corner k to corner (k + 1) % 3.
    const std::array<int, 3>& edgesOf(int triangle) const { return m_triangleEdges[triangle]; }

    /// The triangles at a vertex, ascending.
    TriangleRange trianglesAt(int vertex) const
    {
        return {m_around.data() + m_firstAround[vertex], m_around.data() + m_firstAround[vertex + 1]};
    }

    /// First and last triangle of an edge; one at the boundary repeats its triangle.
    const std::array<int, 2>& trianglesOf(int edge) const { return m_edgeTriangles[edge]; }
    /// True if the edge has exactly two triangles.
    bool isManifold(int edge) const { return m_isManifold[edge] != 0; }
    /// True if every edge has two triangles.
    bool isClosed() const { return m_isClosed; }

    /// Calls visit(triangle) for all triangles of an edge, in ascending order.
    template <class Visit>
    void visitTrianglesOf(int edge, Visit visit) const
    {
        for (int t : trianglesAt(m_edges[edge][0]))
            if (std::find(m_triangleEdges[t].begin(), m_triangleEdges[t].end(), edge) != m_triangleEdges[t].end())
                visit(t);
    }

private:
    void listEdges();
    void listEdgeTriangles();

    std::vector<Triangle> m_triangles;
    std::vector<int> m_vertices;
    std::vector<std::array<int, 2>> m_edges;
    std::vector<std::array<int, 3>> m_triangleEdges;
    std::vector<int> m_firstAround, m_around;  // triangles at vertex i: from m_firstAround[i] to m_firstAround[i + 1]
    std::vector<std::array<int, 2>> m_edgeTriangles;
    std::vector<unsigned char> m_isManifold;  // per edge
    bool m_isClosed;
};

}  // namespace bullet_fem
