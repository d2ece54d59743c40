// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/cage/cage_embedding.h"

#include <algorithm>
#include <cmath>

namespace bullet_fem
{

std::array<double, 4> barycentric(const std::array<Vec3, 4>& x, const Vec3& p)
{
    const Vec3 a = x[1] - x[0], b = x[2] - x[0], c = x[3] - x[0], d = p - x[0];
    const double volume = dot(cross(a, b), c);
    const double w1 = dot(cross(d, b), c) / volume, w2 = dot(cross(a, d), c) / volume,
                 w3 = dot(cross(a, b), d) / volume;
    return {1 - w1 - w2 - w3, w1, w2, w3};
}

namespace
{

constexpr double kOnTetWeight = -1e-9;  // minimum barycentric weight of a vertex in or on an element

/// Index of a lattice tet, in the order of the cage's elements.
int latticeTet(int cube, int tet)
{
    return 5 * cube + tet;
}

/// The best lattice tet for p and its minimum weight there; kept tets take precedence.
struct Holder
{
    int m_cube = 0, m_tet = 0;
    double m_minWeight = -1e300;
    bool m_kept = false;
};

Holder findHolder(const CageLattice& lattice, const std::vector<std::uint8_t>& kept, const Vec3& p)
{
    // In cells: finds one cube, or all those that share the face, edge or corner p lies on.
    constexpr double kSharedCubeTolerance = 1e-6;
    Holder best;
    for (const int cube : lattice.cubesAround(p, kSharedCubeTolerance))
        for (int tet = 0; tet < 5; ++tet)
        {
            const std::array<double, 4> w = barycentric(lattice.corners(cube, tet), p);
            const double least = *std::min_element(w.begin(), w.end());
            const bool isKept = (kept[cube] >> tet & 1) && least >= kOnTetWeight;
            if (isKept != best.m_kept ? isKept : least > best.m_minWeight) best = {cube, tet, least, isKept};
        }
    return best;
}

/// Index of a lattice tet among the kept ones; 0 for -1.
int elementOf(int id, const std::vector<FilledTet>& kept)
{
    if (id < 0) return 0;
    const auto at =
        std::lower_bound(kept.begin(), kept.end(), id,
                         [](const FilledTet& f, int other) { return latticeTet(f.m_cube, f.m_tet) < other; });
    return static_cast<int>(at - kept.begin());
}

std::array<double, 4> weightsIn(const TetMesh& mesh, int e, const Vec3& p)
{
    const std::vector<Vec3>& X = mesh.restPositions();
    const Tet& tet = mesh.tets()[e];
    return barycentric({X[tet[0]], X[tet[1]], X[tet[2]], X[tet[3]]}, p);
}

double least(const std::array<double, 4>& weights)
{
    return *std::min_element(weights.begin(), weights.end());
}

void takeIfBetter(const TetMesh& mesh, int e, const Vec3& p, Embedding& best)
{
    const std::array<double, 4> weights = weightsIn(mesh, e, p);
    if (least(weights) > least(best.m_weights)) best = {e, weights};
}

}  // namespace

std::vector<int> holdVertices(const CageLattice& lattice, const std::vector<Vec3>& vertices,
                              const std::vector<char>& used, CageFill& fill)
{
    std::vector<int> held(vertices.size(), -1);
    for (std::size_t i = 0; i < vertices.size(); ++i)
        if (used[i])
        {
            const Holder holder = findHolder(lattice, fill.m_kept, lattice.toLattice(vertices[i]));
            if (!holder.m_kept)
            {
                fill.m_kept[holder.m_cube] |= static_cast<std::uint8_t>(1 << holder.m_tet);
                fill.m_tets.push_back({holder.m_cube, holder.m_tet, 0});
            }
            held[i] = latticeTet(holder.m_cube, holder.m_tet);
        }
    std::sort(fill.m_tets.begin(), fill.m_tets.end(),
              [](const FilledTet& a, const FilledTet& b)
              { return latticeTet(a.m_cube, a.m_tet) < latticeTet(b.m_cube, b.m_tet); });
    for (int& element : held) element = elementOf(element, fill.m_tets);
    return held;
}

std::vector<Embedding> embed(const std::vector<Vec3>& vertices, const std::vector<int>& held, const TetMesh& mesh)
{
    std::vector<Embedding> result(vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) result[i] = {held[i], weightsIn(mesh, held[i], vertices[i])};
    return result;
}

void embedAnew(const TetMesh& mesh, const std::vector<Vec3>& vertices, const std::vector<char>& used,
               std::vector<Embedding>& embedding)
{
    std::vector<std::vector<int>> tetsOf(mesh.nodeCount());
    for (int e = 0; e < mesh.tetCount(); ++e)
        for (const int node : mesh.tets()[e]) tetsOf[node].push_back(e);
    for (std::size_t i = 0; i < vertices.size(); ++i)
    {
        const int old = embedding[i].m_tet;
        Embedding& best = embedding[i];
        best.m_weights = weightsIn(mesh, old, vertices[i]);
        if (!used[i]) continue;
        for (int a = 0; a < 4 && least(best.m_weights) < kOnTetWeight; ++a)
            for (const int e : tetsOf[mesh.tets()[old][a]]) takeIfBetter(mesh, e, vertices[i], best);
        for (int e = 0; e < mesh.tetCount() && least(best.m_weights) < kOnTetWeight; ++e)
            takeIfBetter(mesh, e, vertices[i], best);
    }
}

}  // namespace bullet_fem
