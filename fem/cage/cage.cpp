// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/cage.h"

#include <algorithm>

#include "fem/cage/cage_fill.h"
#include "fem/cage/cage_size.h"
#include "fem/message.h"

namespace bullet_fem
{
namespace
{

constexpr double kOnTet = -1e-9;    // least barycentric weight of a vertex that lies in or on an element
constexpr double kThinnest = 1e-7;  // volume over area times length below which nothing is enclosed

/// Mean ratio of the tets that cut off a cube's corners, less rounding: 12 (1/2)^(2/3) / 9; the middle one is regular.
constexpr double kLatticeQuality = 0.8399;

/// The winding number with its origin at the centre of the bounding box, for digits.
WindingNumber windingAboutCentre(const SurfaceInspection& surface)
{
    const Vec3 centre = 0.5 * (surface.m_low + surface.m_high);
    std::vector<Vec3> x;
    x.reserve(surface.m_repaired.m_surface.m_vertices.size());
    for (const Vec3& vertex : surface.m_repaired.m_surface.m_vertices) x.push_back(vertex - centre);
    return WindingNumber(x, surface.m_repaired.m_surface.m_triangles);
}

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
double enclosedVolume(const SurfaceInspection& surface, const CageFill& fill, double cellSize, bool exact)
{
    const double volume = exact ? std::abs(signedVolume(surface.m_repaired.m_surface))
                                : fill.m_insideVolume * cellSize * cellSize * cellSize;
    const double size = norm(surface.m_high - surface.m_low);
    if (!(volume > kThinnest * surface.m_area * size))
        reject("the surface has no inside: its volume is ", volume, " m3, less than ", kThinnest,
               " of area times length, with ", surface.m_openEdges, " open edges and ", fill.m_sampleCount,
               " points looked at; close the surface, or use a cell size below ", cellSize, " m if it is only thin");
    return volume;
}

CageReport reportOn(const SurfaceInspection& surface, const CageFill& fill, double cellSize)
{
    CageReport report;
    report.m_cellSize = cellSize;
    report.m_volumeIsExact = surface.m_openEdges == 0 && !fill.m_selfIntersecting;
    report.m_surfaceVolume = enclosedVolume(surface, fill, cellSize, report.m_volumeIsExact);
    report.m_pieces = surface.m_pieces;
    report.m_insideOut = fill.m_insideOut;
    report.m_selfIntersecting = fill.m_selfIntersecting;
    report.m_openEdges = surface.m_openEdges;
    report.m_openShare = static_cast<double>(surface.m_openEdges) / surface.m_edges;
    report.m_duplicates = surface.m_repaired.m_duplicates;
    report.m_degenerate = surface.m_repaired.m_degenerate;
    report.m_turned = surface.m_repaired.m_turned;
    return report;
}

void reportElements(const TetMesh& mesh, CageReport& report)
{
    report.m_tets = mesh.tetCount();
    report.m_nodes = mesh.nodeCount();
    report.m_volumeRatio = mesh.volume() / report.m_surfaceVolume;
    report.m_qualityBound = kLatticeQuality;
    report.m_leastQuality = 1;
    const std::vector<Vec3>& X = mesh.restPositions();
    for (const Tet& t : mesh.tets())
    {
        const double quality = meanRatio({X[t[0]], X[t[1]], X[t[2]], X[t[3]]});
        report.m_leastQuality = std::min(report.m_leastQuality, quality);
        ++report.m_qualityHistogram[std::clamp(static_cast<int>(10 * quality), 0, 9)];
    }
}

}  // namespace

Cage makeCage(const SurfaceMesh& surface, const CageSettings& givenSettings)
{
    checkSettings(givenSettings);
    const SurfaceInspection inspection = inspectSurface(surface);
    const WindingNumber winding = windingAboutCentre(inspection);
    CageSettings settings = givenSettings;
    if (settings.m_targetTets > 0) settings.m_cellSize = findCellSize(inspection, winding, settings);

    CageLattice lattice(inspection, settings);
    lattice.markSurface(surface);
    CageFill fill = fillCage(lattice, winding, inspection.m_openEdges == 0, settings);

    Cage cage;
    cage.m_report = reportOn(inspection, fill, lattice.cellSize());
    const std::vector<int> held = holdVertices(lattice, surface.m_vertices, inspection.m_used, fill);
    cage.m_mesh = meshOf(lattice, fill.m_tets);
    cage.m_embedding = embed(surface.m_vertices, held, fill.m_tets, cage.m_mesh);
    double filledVolume = 0;
    for (int e = 0; e < cage.m_mesh.tetCount(); ++e)
    {
        cage.m_filled.push_back(std::max(settings.m_fillFloor, fill.m_tets[e].m_fraction));
        filledVolume += cage.m_filled[e] * cage.m_mesh.tetVolume(e);
    }
    cage.m_massScale = cage.m_report.m_surfaceVolume / filledVolume;
    reportElements(cage.m_mesh, cage.m_report);
    return cage;
}

}  // namespace bullet_fem
