// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/cage.h"

#include <algorithm>

#include "fem/cage/cage_fill.h"
#include "fem/cage/cage_lattice.h"
#include "fem/cage/surface_inspection.h"
#include "fem/message.h"

namespace bullet_fem
{
namespace
{

constexpr double kOnTet = -1e-9;    // least barycentric weight of a vertex that lies in or on an element
constexpr double kThinnest = 1e-7;  // volume over area times length below which nothing is enclosed

/// A tet of the lattice, in the order of the cage's elements.
int latticeTet(int cube, int tet)
{
    return 5 * cube + tet;
}

/// Barycentric weights of p in a tet, sum exactly 1 but for rounding.
std::array<double, 4> barycentric(const std::array<Vec3, 4>& x, const Vec3& p)
{
    const Vec3 a = x[1] - x[0], b = x[2] - x[0], c = x[3] - x[0], d = p - x[0];
    const double volume = dot(cross(a, b), c);
    const double w1 = dot(cross(d, b), c) / volume, w2 = dot(cross(a, d), c) / volume,
                 w3 = dot(cross(a, b), d) / volume;
    return {1 - w1 - w2 - w3, w1, w2, w3};
}

/// The lattice tet that holds p best, and its least weight there: kept ones before others.
struct Holder
{
    int m_cube = 0, m_tet = 0;
    double m_leastWeight = -1e300;
    bool m_kept = false;
};

Holder findHolder(const CageLattice& lattice, const std::vector<std::uint8_t>& kept, const Vec3& p)
{
    std::array<int, 3> low, high;  // one cube, or all those that share the face, edge or corner p lies on
    for (int a = 0; a < 3; ++a)
    {
        low[a] = std::clamp(static_cast<int>(std::floor(p[a] - 1e-6)), 0, lattice.cubes()[a] - 1);
        high[a] = std::clamp(static_cast<int>(std::floor(p[a] + 1e-6)), 0, lattice.cubes()[a] - 1);
    }
    Holder best;
    for (int k = low[2]; k <= high[2]; ++k)
        for (int j = low[1]; j <= high[1]; ++j)
            for (int i = low[0]; i <= high[0]; ++i)
                for (int tet = 0; tet < 5; ++tet)
                {
                    const int cube = lattice.cube({i, j, k});
                    const std::array<double, 4> w = barycentric(lattice.corners(cube, tet), p);
                    const double least = *std::min_element(w.begin(), w.end());
                    const bool isKept = (kept[cube] >> tet & 1) && least >= kOnTet;
                    if (isKept != best.m_kept ? isKept : least > best.m_leastWeight) best = {cube, tet, least, isKept};
                }
    return best;
}

/// Makes sure that every used vertex lies in a kept tet, and returns its lattice tet (-1 for unused vertices).
std::vector<int> holdVertices(const CageLattice& lattice, const std::vector<Vec3>& vertices,
                              const std::vector<char>& used, CageFill& fill)
{
    std::vector<int> held(vertices.size(), -1);
    for (std::size_t i = 0; i < vertices.size(); ++i)
        if (used[i])
        {
            const Holder holder = findHolder(lattice, fill.m_kept, vertices[i]);
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
    return held;
}

TetMesh meshOf(const CageLattice& lattice, const std::vector<FilledTet>& filled)
{
    std::vector<int> number(lattice.nodeCount(), -1);
    for (const FilledTet& f : filled)
        for (int a = 0; a < 4; ++a) number[lattice.node(f.m_cube, f.m_tet, a)] = 0;
    std::vector<Vec3> X;
    for (int n = 0; n < lattice.nodeCount(); ++n)
        if (number[n] == 0)
        {
            number[n] = static_cast<int>(X.size());
            X.push_back(lattice.toWorld(lattice.nodePlace(n)));
        }
    std::vector<Tet> tets;
    for (const FilledTet& f : filled)
    {
        tets.emplace_back();
        for (int a = 0; a < 4; ++a) tets.back()[a] = number[lattice.node(f.m_cube, f.m_tet, a)];
    }
    return TetMesh(std::move(X), std::move(tets));
}

/// Weights with the final nodes, so that they give the vertex back. A vertex in no triangle hangs on element 0.
std::vector<Embedding> embed(const std::vector<Vec3>& vertices, const std::vector<int>& held,
                             const std::vector<FilledTet>& filled, const TetMesh& mesh)
{
    std::vector<Embedding> result(vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i)
    {
        if (held[i] >= 0)
            result[i].m_tet = static_cast<int>(std::lower_bound(filled.begin(), filled.end(), held[i],
                                                                [](const FilledTet& f, int id)
                                                                { return latticeTet(f.m_cube, f.m_tet) < id; }) -
                                               filled.begin());
        const Tet& tet = mesh.tets()[result[i].m_tet];
        const std::vector<Vec3>& X = mesh.restPositions();
        result[i].m_weights = barycentric({X[tet[0]], X[tet[1]], X[tet[2]], X[tet[3]]}, vertices[i]);
    }
    return result;
}

/// The enclosed volume [m3]: exact where the divergence theorem counts every point once, else what the samples say.
double enclosedVolume(const SurfaceMesh& surface, const SurfaceInspection& inspection, const CageFill& fill,
                      double cellSize)
{
    const double exact = std::abs(signedVolume(surface));
    const bool clean = inspection.m_openEdges == 0 && !fill.m_selfIntersecting;
    const double volume = clean ? exact : fill.m_insideVolume * cellSize * cellSize * cellSize;
    const double size = norm(inspection.m_high - inspection.m_low);
    if (!(volume > kThinnest * inspection.m_area * size))
        reject("the surface has no inside: its volume is ", volume, " m3, less than ", kThinnest,
               " of area times length, with ", inspection.m_openEdges, " open edges and ", fill.m_sampleCount,
               " points looked at; close the surface, or use a cell size below ", cellSize, " m if it is only thin");
    return volume;
}

}  // namespace

Cage makeCage(const SurfaceMesh& surface, const CageSettings& settings)
{
    const SurfaceInspection inspection = inspectSurface(surface);
    CageLattice lattice(inspection, settings);

    std::vector<Vec3> vertices;  // in lattice units from here on
    vertices.reserve(surface.m_vertices.size());
    for (const Vec3& x : surface.m_vertices) vertices.push_back(lattice.toLattice(x));
    lattice.markSurface(vertices, surface.m_triangles);
    CageFill fill =
        fillCage(lattice, WindingNumber(vertices, surface.m_triangles), inspection.m_openEdges == 0, settings);

    Cage cage;
    cage.m_surfaceVolume = enclosedVolume(surface, inspection, fill, lattice.cellSize());
    cage.m_openEdges = inspection.m_openEdges;
    cage.m_insideOut = fill.m_insideOut;
    cage.m_selfIntersecting = fill.m_selfIntersecting;

    const std::vector<int> held = holdVertices(lattice, vertices, inspection.m_used, fill);
    cage.m_mesh = meshOf(lattice, fill.m_tets);
    cage.m_embedding = embed(surface.m_vertices, held, fill.m_tets, cage.m_mesh);
    double filledVolume = 0;
    for (int e = 0; e < cage.m_mesh.tetCount(); ++e)
    {
        cage.m_filled.push_back(std::max(settings.m_fillFloor, fill.m_tets[e].m_fraction));
        filledVolume += cage.m_filled[e] * cage.m_mesh.tetVolume(e);
    }
    cage.m_massScale = cage.m_surfaceVolume / filledVolume;
    return cage;
}

}  // namespace bullet_fem
