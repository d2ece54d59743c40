// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/geometry/surface/rest_neighbours.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace bullet_fem
{
namespace
{

constexpr double kCloseInSpace = 2;     // largest distance in space, in mean edges
constexpr double kCloseInMaterial = 3;  // largest distance along edges of the tetrahedra, in mean edges

std::vector<std::vector<int>> edgesAround(const TetMesh& mesh)
{
    std::vector<std::vector<int>> around(mesh.nodeCount());
    for (const Tet& t : mesh.tets())
        for (int a : t)
            for (int b : t)
                if (a != b) around[a].push_back(b);
    for (std::vector<int>& nodes : around)
    {
        std::sort(nodes.begin(), nodes.end());
        nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    }
    return around;
}

}  // namespace

// Shortest paths along edges of the tetrahedra from each of the nodes (Dijkstra's algorithm), up to kCloseInMaterial.
RestNeighbours::RestNeighbours(const TetMesh& mesh, const std::vector<int>& nodes) : m_first(mesh.nodeCount() + 1)
{
    const std::vector<std::vector<int>> around = edgesAround(mesh);
    const std::vector<Vec3>& X = mesh.restPositions();
    const double h = mesh.meanEdgeLength();
    std::vector<unsigned char> asked(mesh.nodeCount(), 0);
    for (int i : nodes) asked[i] = 1;
    std::vector<double> way(mesh.nodeCount(), std::numeric_limits<double>::infinity());
    std::vector<int> reached;
    using Step = std::pair<double, int>;
    std::priority_queue<Step, std::vector<Step>, std::greater<Step>> front;
    for (int i = 0; i < mesh.nodeCount(); ++i)
    {
        if (asked[i]) front.push({0, i});
        while (!front.empty())
        {
            const auto [length, at] = front.top();
            front.pop();
            if (way[at] <= length) continue;
            way[at] = length;
            reached.push_back(at);
            for (int next : around[at])
            {
                const double farther = length + norm(X[next] - X[at]);
                if (farther < way[next] && (at == i || farther <= kCloseInMaterial * h)) front.push({farther, next});
            }
        }
        for (int j : reached)
        {
            const bool neighbour = std::binary_search(around[i].begin(), around[i].end(), j);
            if (asked[j] && (neighbour || norm(X[j] - X[i]) <= kCloseInSpace * h)) m_close.push_back(j);
            way[j] = std::numeric_limits<double>::infinity();
        }
        reached.clear();
        std::sort(m_close.begin() + m_first[i], m_close.end());
        m_first[i + 1] = static_cast<int>(m_close.size());
    }
}

bool RestNeighbours::areClose(int nodeA, int nodeB) const
{
    return std::binary_search(m_close.begin() + m_first[nodeA], m_close.begin() + m_first[nodeA + 1], nodeB);
}

}  // namespace bullet_fem
