// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/cage/cage_stages.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "fem/cage/cage_fill.h"
#include "fem/cage/graded_lattice.h"
#include "fem/common/message.h"

namespace bullet_fem
{
namespace
{

constexpr int kMaxLattices = 20;
constexpr double kCountTolerance = 0.03;  // relative to the wanted number

/// A lattice cube holds five tets. The cage holds the solid and a layer of cut elements, half of which is outside:
/// about half a cell thick over the whole surface (measured on a dozen meshes). The estimate decreases with the cell
/// size.
double estimateCellSize(const SurfaceInspection& surface, const CageSettings& settings, CellSizeRange range)
{
    const Vec3 extent = surface.m_high - surface.m_low;  // the box bounds the volume of self-overlapping surfaces
    const double volume =
        std::min(std::abs(signedVolume(surface.m_repaired.m_surface)), extent.x * extent.y * extent.z);
    for (int n = 0; n < 60; ++n)
    {
        const double cell = std::sqrt(range.m_min * range.m_max);
        const double tets = 5 * (volume + 0.5 * surface.m_area * cell) / (cell * cell * cell);
        (tets > settings.m_targetTets ? range.m_min : range.m_max) = cell;
    }
    return range.m_max;
}

/// Logarithms of a cell size and of the ratio of its count to the wanted one.
struct Trial
{
    double m_cell, m_excess;
};

class Search
{
public:
    Search(const SurfaceInspection& surface, const SurfaceWinding& winding, const CageSettings& settings)
        : m_surface(surface), m_winding(winding), m_settings(settings)
    {
    }

    CageSize run()
    {
        const CellSizeRange range = CageLattice::cellSizeRange(m_surface, m_settings);
        const double least = std::log(range.m_min);
        double most = std::log(range.m_max);
        double cell = std::log(estimateCellSize(m_surface, m_settings, range));
        if (m_settings.m_cellsAcross > 0)
        {
            m_longest = kMaxOverEstimate * std::exp(cell);
            m_graded.emplace(m_surface, m_winding, m_settings, m_longest);
            most = std::log(std::min(m_longest, range.m_max) * kMaxCellsFewer);
        }
        Trial finer{least, 1}, coarser{most, -1}, best{0, 1e300};  // a bracket; its ends are unknown at first
        bool knowsFiner = false, knowsCoarser = false;
        for (int n = 0; n < kMaxLattices && coarser.m_cell - finer.m_cell > 1e-6; ++n)
        {
            const Trial trial = look(cell, n);
            if (std::abs(trial.m_excess) < std::abs(best.m_excess)) best = trial;
            if (std::abs(best.m_excess) < kCountTolerance) break;
            const bool tooMany = trial.m_excess > 0;
            (tooMany ? finer : coarser) = trial;
            (tooMany ? knowsFiner : knowsCoarser) = true;
            if (!knowsFiner || !knowsCoarser)
                cell = std::clamp(cell + kMinCountExponent * trial.m_excess, least, most);
            else if (n % 2 == 0)
                cell = finer.m_cell +
                       (coarser.m_cell - finer.m_cell) * finer.m_excess / (finer.m_excess - coarser.m_excess);
            else
                cell = 0.5 * (finer.m_cell + coarser.m_cell);
            if (cell == trial.m_cell) break;  // at an end of the range
        }
        return sizeAt(best.m_cell);
    }

private:
    static constexpr double kMaxOverEstimate = 2;  // thin parts need elements, so that other cells become longer
    static constexpr double kMaxCellsFewer = 8;    // reduction of the cells across at which grading ends
    // Counts vary with the cell size to the power -2 to -3: with 1/2 no step of the logarithm is too short.
    static constexpr double kMinCountExponent = 0.5;

    /// Cells grow up to a maximum length; beyond it a graded cage has fewer cells across thin parts, and fewer levels.
    CageSize sizeAt(double cell) const
    {
        const CellSizeRange range = CageLattice::cellSizeRange(m_surface, m_settings);
        const double wanted = std::exp(cell), longest = std::min(m_longest, range.m_max);
        CageSize size{std::clamp(wanted, range.m_min, longest), Grading::of(m_settings)};
        if (wanted <= longest) return size;
        size.m_grading.m_cellsAcross *= longest / wanted;
        size.m_grading.m_maxGenerations = static_cast<int>(
            std::round(size.m_grading.m_maxGenerations * (1 - std::log(wanted / longest) / std::log(kMaxCellsFewer))));
        return size;
    }

    /// Evaluates the n-th lattice. Their number is unknown, so each advances the progress by a share of the remainder.
    Trial look(double cell, int n) const
    {
        const CageSize size = sizeAt(cell);
        CageSettings settings = m_settings;
        settings.m_cellSize = size.m_cellSize;
        settings.m_progress = stageOf(m_settings.m_progress, n / (n + 3.0), (n + 1) / (n + 4.0));
        CageLattice lattice(m_surface, settings);
        lattice.markSurface(m_surface.m_repaired.m_surface);
        const double count = countIn(lattice, settings, size.m_grading);
        return {cell, std::log(std::max(1.0, count) / m_settings.m_targetTets)};
    }

    double countIn(const CageLattice& lattice, const CageSettings& settings, const Grading& grading) const
    {
        const bool closed = m_surface.m_openEdges == 0;
        if (!m_graded) return countTets(lattice, m_winding, closed, settings);
        GradedLattice graded({lattice, m_winding, *m_graded, closed, settings, grading}, m_settings.m_targetTets);
        return graded.count(2.0 * m_settings.m_targetTets);
    }

    const SurfaceInspection& m_surface;
    const SurfaceWinding& m_winding;
    const CageSettings& m_settings;
    std::optional<GradedSurface> m_graded;
    double m_longest = std::numeric_limits<double>::infinity();  // maximum cell size [m]
};

}  // namespace

void checkSettings(const CageSettings& settings)
{
    if (settings.m_maxTets < 5 || settings.m_maxTets > 5'000'000)
        reject("the most elements of a cage is ", settings.m_maxTets,
               ", outside [5, 5000000]; choose another m_maxTets");
    if (!(settings.m_fillFloor > 0 && settings.m_fillFloor <= 1))
        reject("the least filled fraction of a cage is ", settings.m_fillFloor,
               ", outside (0, 1]; choose another m_fillFloor, 0.25 is usual");
    if (settings.m_fillSamples < 8 || settings.m_fillSamples > 4096)
        reject("the samples for an element's filled fraction are ", settings.m_fillSamples,
               ", outside [8, 4096]; choose another m_fillSamples, 64 is usual");
    if (!(settings.m_snap >= 0 && settings.m_snap <= 1))
        reject("the share that a cage's boundary is snapped by is ", settings.m_snap,
               ", outside [0, 1]; choose another m_snap, 0 for none");
    if (settings.m_cellsAcross != 0 && !(settings.m_cellsAcross >= 0.5 && settings.m_cellsAcross <= 8))
        reject("the cells across thin parts of a graded cage are ", settings.m_cellsAcross,
               ", neither 0 nor in [0.5, 8]; choose another m_cellsAcross, 2 is usual, 0 for cells that are alike");
    if (settings.m_mostLevels < 1 || settings.m_mostLevels > 6)
        reject("the most levels of a graded cage are ", settings.m_mostLevels,
               ", outside [1, 6]; choose another m_mostLevels, 3 is usual");
    if (settings.m_targetTets != 0 && settings.m_cellSize != 0)
        reject("the cage has both a cell size (", settings.m_cellSize, " m) and a number of elements (",
               settings.m_targetTets, "); give one of m_cellSize and m_targetTets, and leave the other 0");
    if (settings.m_targetTets != 0 && (settings.m_targetTets < 5 || settings.m_targetTets > settings.m_maxTets))
        reject("the elements wanted of a cage are ", settings.m_targetTets, ", outside [5, ", settings.m_maxTets,
               "]; choose another m_targetTets or raise m_maxTets");
}

CageSize findCageSize(const SurfaceInspection& surface, const SurfaceWinding& winding, const CageSettings& settings)
{
    return Search(surface, winding, settings).run();
}

}  // namespace bullet_fem
