// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/cage/cage.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bullet_fem/fem/cage/painted_regions.h"
#include "fem/cage/cage_embedding.h"
#include "fem/cage/cage_fill.h"
#include "fem/cage/cage_stages.h"
#include "fem/cage/graded_lattice.h"
#include "fem/common/message.h"

namespace bullet_fem
{
namespace
{

constexpr double kMinThickness = 1e-7;  // volume over area times length, below which nothing is enclosed

/// Mean ratio of the tets at a cube's corners, less rounding: 12 (1/2)^(2/3) / 9; the middle one is regular.
constexpr double kLatticeQuality = 0.8399;

/// Mean ratio of a sixth of a cube, less rounding: 12 (1/2)^(2/3) / 10. Its bisections have higher ones.
constexpr double kGradedQuality = 0.7559;

/// Completed shares of the work at the ends of stages; approximate, for a scan of 69,000 triangles and 4000 elements.
constexpr double kInspected = 0.15, kWound = 0.2, kSizeFound = 0.4, kMarked = 0.45, kFilled = 0.8, kSnapped = 0.9;

Vec3 centreOf(const SurfaceInspection& surface)
{
    return 0.5 * (surface.m_low + surface.m_high);
}

/// The winding number with its origin at the centre of the bounding box, for accuracy.
SurfaceWinding windingAboutCentre(const SurfaceInspection& surface)
{
    const Vec3 centre = centreOf(surface);
    std::vector<Vec3> x;
    x.reserve(surface.m_repaired.m_surface.m_vertices.size());
    for (const Vec3& vertex : surface.m_repaired.m_surface.m_vertices) x.push_back(vertex - centre);
    return {x, surface.m_repaired.m_surface.m_triangles, surface.m_openEdges == 0};
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

/// The enclosed volume [m3]: exact where the divergence theorem counts every point once, else from samples.
double enclosedVolume(const SurfaceInspection& surface, const CageFill& fill, double cellSize, bool exact)
{
    const double volume = exact ? std::abs(signedVolume(surface.m_repaired.m_surface))
                                : fill.m_insideVolume * cellSize * cellSize * cellSize;
    const double size = norm(surface.m_high - surface.m_low);
    if (!(volume > kMinThickness * surface.m_area * size))
        reject("the surface has no inside: its volume is ", volume, " m3, less than ", kMinThickness,
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

/// Inputs of filling a lattice.
struct FillInput
{
    const SurfaceInspection& m_surface;
    const SurfaceWinding& m_winding;
    const CageLattice& m_lattice;
    const CageSettings& m_settings;
    const Grading m_grading;

    bool isClosed() const { return m_surface.m_openEdges == 0; }
    const std::vector<Vec3>& vertices() const { return m_surface.m_repaired.m_surface.m_vertices; }
};

/// Makes mesh and report of a uniform cage. Returns every vertex's element.
std::vector<int> fillEqual(const FillInput& input, CageFill& fill, Cage& cage)
{
    const CageLattice& lattice = input.m_lattice;
    fill = fillCage(lattice, input.m_winding, input.isClosed(), input.m_settings);
    cage.m_report = reportOn(input.m_surface, fill, lattice.cellSize());
    std::vector<int> held = holdVertices(lattice, input.vertices(), input.m_surface.m_used, fill);
    cage.m_mesh = meshOf(lattice, fill.m_tets);
    cage.m_report.m_smallestCell = cage.m_report.m_largestCell = lattice.cellSize();
    cage.m_report.m_levelTets[0] = cage.m_mesh.tetCount();
    return held;
}

/// Makes mesh and report of a graded cage. Returns every vertex's element.
std::vector<int> fillGraded(const FillInput& input, CageFill& fill, Cage& cage)
{
    const CageLattice& lattice = input.m_lattice;
    const GradedSurface surface(input.m_surface, input.m_winding, input.m_settings, lattice.cellSize());
    GradedLattice graded({lattice, input.m_winding, surface, input.isClosed(), input.m_settings, input.m_grading},
                         input.m_settings.m_maxTets);
    fill = graded.fill();
    cage.m_report = reportOn(input.m_surface, fill, lattice.cellSize());
    std::vector<int> held = graded.holdVertices(input.vertices(), input.m_surface.m_used, fill);
    cage.m_mesh = graded.mesh(fill.m_tets);
    graded.report(fill.m_tets, cage.m_report);
    cage.m_report.m_cellsAcross = input.m_grading.m_cellsAcross;
    return held;
}

void reportElements(const TetMesh& mesh, const CageSettings& settings, CageReport& report)
{
    report.m_tets = mesh.tetCount();
    report.m_nodes = mesh.nodeCount();
    report.m_volumeRatio = mesh.volume() / report.m_surfaceVolume;
    report.m_qualityBound = settings.m_snap > 0          ? kSnappedQuality
                            : settings.m_cellsAcross > 0 ? kGradedQuality
                                                         : kLatticeQuality;
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
    const CageProgress& progress = givenSettings.m_progress;
    tell(progress, 0);
    const SurfaceInspection inspection = inspectSurface(surface);
    tell(progress, kInspected);
    const SurfaceWinding winding = windingAboutCentre(inspection);
    CageSettings settings = givenSettings;
    settings.m_progress = stageOf(progress, kWound, kSizeFound);
    Grading grading = Grading::of(settings);
    if (settings.m_targetTets > 0)
    {
        const CageSize size = findCageSize(inspection, winding, settings);
        settings.m_cellSize = size.m_cellSize;
        grading = size.m_grading;
    }

    CageLattice lattice(inspection, settings);
    lattice.markSurface(surface);
    settings.m_progress = stageOf(progress, kMarked, kFilled);
    const FillInput input{inspection, winding, lattice, settings, grading};
    Cage cage;
    cage.m_surfaceCollides = settings.m_surfaceCollides;
    CageFill fill;
    const std::vector<int> held =
        settings.m_cellsAcross > 0 ? fillGraded(input, fill, cage) : fillEqual(input, fill, cage);
    cage.m_report.m_latticeVolumeRatio = cage.m_mesh.volume() / cage.m_report.m_surfaceVolume;
    cage.m_embedding = embed(surface.m_vertices, held, cage.m_mesh);
    tell(progress, kFilled);
    if (settings.m_snap > 0)
    {
        const TetMesh mesh = snapped(cage.m_mesh, {inspection, winding, settings.m_snap, cage.m_report.m_smallestCell});
        settings.m_progress = stageOf(progress, kSnapped, 1);
        refill(MovedTets{cage.m_mesh, mesh, centreOf(inspection)}, winding, settings, fill);
        embedAnew(mesh, surface.m_vertices, inspection.m_used, cage.m_embedding);
        cage.m_mesh = mesh;
    }
    double filledVolume = 0;
    for (int e = 0; e < cage.m_mesh.tetCount(); ++e)
    {
        cage.m_filled.push_back(std::max(settings.m_fillFloor, fill.m_tets[e].m_fraction));
        filledVolume += cage.m_filled[e] * cage.m_mesh.tetVolume(e);
    }
    cage.m_massScale = cage.m_report.m_surfaceVolume / filledVolume;
    reportElements(cage.m_mesh, settings, cage.m_report);
    cage.m_report.m_regions = paintedRegions(cage.m_mesh, surface, cage.m_embedding);
    tell(progress, 1);
    return cage;
}

}  // namespace bullet_fem
