// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/cage/painted_regions.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <queue>
#include <tuple>
#include <utility>

#include "fem/common/message.h"
#include "fem/mesh/element_faces.h"

namespace bullet_fem
{
namespace
{

constexpr double kFarAway = std::numeric_limits<double>::infinity();

/// Front of Dijkstra's search: distance, painted source element, and the element itself.
using Front = std::tuple<double, int, int>;

int maxOf(const std::map<int, int>& votes)
{
    const auto fewer = [](const auto& a, const auto& b) { return a.second < b.second; };
    return std::max_element(votes.begin(), votes.end(), fewer)->first;  // the lowest label in a tie
}

Vec3 middleOfTet(const TetMesh& mesh, int e)
{
    Vec3 sum;
    for (const int node : mesh.tets()[e]) sum += 0.25 * mesh.restPositions()[node];
    return sum;
}

}  // namespace

std::vector<int> paintedRegions(const TetMesh& mesh, const SurfaceMesh& surface,
                                const std::vector<Embedding>& embedding)
{
    if (surface.m_labels.empty()) return {};
    if (surface.m_labels.size() != surface.m_vertices.size() || embedding.size() != surface.m_vertices.size())
        reject("painted regions: there are ", surface.m_labels.size(), " labels and ", embedding.size(),
               " embedded vertices, and the surface has ", surface.m_vertices.size(), "; give one each, or no labels");
    std::vector<std::map<int, int>> votes(mesh.tets().size());
    for (std::size_t v = 0; v < embedding.size(); ++v) ++votes[embedding[v].m_tet][surface.m_labels[v]];

    std::vector<int> label(mesh.tets().size(), surface.m_labels.front());
    std::vector<double> way(label.size(), kFarAway);
    std::priority_queue<Front, std::vector<Front>, std::greater<>> front;
    for (int e = 0; e < mesh.tetCount(); ++e)
    {
        if (votes[e].empty()) continue;
        label[e] = maxOf(votes[e]);
        way[e] = 0;
        front.push({0, e, e});
    }
    const std::vector<std::array<int, 4>> behind = elementsBehindFaces(mesh.tets());
    std::vector<char> isDone(label.size(), 0);
    while (!front.empty())
    {
        const auto [distance, from, at] = front.top();
        front.pop();
        if (isDone[at]) continue;
        isDone[at] = 1;
        label[at] = label[from];
        for (const int next : behind[at])
        {
            if (next < 0) continue;
            const double farther = distance + norm(middleOfTet(mesh, next) - middleOfTet(mesh, at));
            if (farther > way[next]) continue;
            way[next] = farther;
            front.push({farther, from, next});
        }
    }
    return label;
}

}  // namespace bullet_fem
