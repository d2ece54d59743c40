// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/mesh/thin_mesh.h"

#include <algorithm>
#include <vector>

namespace bullet_fem
{
namespace
{

constexpr int kThickDepth = 2;  // of the middle of four cells
constexpr int kFar = -1;        // of nodes that no edge has reached

// Replaces kFar of nodes by their numbers of edges to the nearest node of another value, up to `most`.
void spreadAlongEdges(const TetMesh& mesh, int most, std::vector<int>& distance)
{
    for (int reached = 0; reached < most; ++reached)
        for (const Tet& tet : mesh.tets())
        {
            const auto isReached = [&](int node) { return distance[node] != kFar && distance[node] <= reached; };
            if (std::none_of(tet.begin(), tet.end(), isReached)) continue;
            for (const int node : tet)
                if (distance[node] == kFar) distance[node] = reached + 1;
        }
}

// True if a node is too many edges away from all nodes of the wanted depth and more.
bool isFarFromDepth(const TetMesh& mesh, const std::vector<int>& depth, int wanted)
{
    std::vector<int> distance(mesh.nodeCount(), kFar);
    for (int i = 0; i < mesh.nodeCount(); ++i)
        if ((depth[i] == kFar || depth[i] >= wanted) && !mesh.isLoose(i)) distance[i] = 0;
    spreadAlongEdges(mesh, kThinReach * wanted, distance);
    for (int i = 0; i < mesh.nodeCount(); ++i)
        if (distance[i] == kFar && !mesh.isLoose(i)) return true;
    return false;
}

}  // namespace

bool isThinSomewhere(const TetMesh& mesh)
{
    std::vector<int> depth(mesh.nodeCount(), kFar);  // kFar: at least kThickDepth
    for (const int node : mesh.surfaceNodes()) depth[node] = 0;
    spreadAlongEdges(mesh, kThickDepth - 1, depth);
    return isFarFromDepth(mesh, depth, kThickDepth) || isFarFromDepth(mesh, depth, 1);
}

}  // namespace bullet_fem
