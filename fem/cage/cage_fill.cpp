// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/cage/cage_fill.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fem/cage/cage_stages.h"
#include "fem/common/message.h"

namespace bullet_fem
{

std::vector<std::array<double, 4>> spreadSamples(int count)
{
    constexpr double g = 1.2207440846057596;
    std::vector<std::array<double, 4>> samples;
    for (int n = 1; n <= count; ++n)
    {
        const double s = std::cbrt(std::fmod(0.5 + n / g, 1)), t = std::sqrt(std::fmod(0.5 + n / (g * g), 1)),
                     u = std::fmod(0.5 + n / (g * g * g), 1);
        samples.push_back({1 - s, s * (1 - t), s * t * u, s * t * (1 - u)});
    }
    return samples;
}

void report(const FillTally& tally, CageFill& fill)
{
    fill.m_insideVolume = tally.m_outward + tally.m_inward;
    fill.m_insideOut = tally.m_inward > tally.m_outward;
    fill.m_selfIntersecting = tally.m_overlapping || (tally.m_inward > 0 && tally.m_outward > 0);
}

namespace
{

using Weights = std::array<double, 4>;

class Filler
{
public:
    Filler(const CageLattice& lattice, const SurfaceWinding& winding, bool closed, const CageSettings& settings)
        : m_lattice(lattice),
          m_winding(winding, 2 * lattice.cellSize()),
          m_closed(closed),
          m_settings(settings),
          m_samples(spreadSamples(settings.m_fillSamples)),
          m_whole(lattice.cubeCount(), 0)
    {
    }

    CageFill run()
    {
        const double atLeast = findWholeTets(m_settings.m_maxTets);
        if (atLeast > m_settings.m_maxTets) rejectTooMany(atLeast);
        m_fill.m_kept.assign(m_lattice.cubeCount(), 0);
        for (int cube = 0; cube < m_lattice.cubeCount(); ++cube)
        {
            tellLoop(m_settings.m_progress, cube, m_lattice.cubeCount(), kWholeFound, 1);
            for (int tet = 0; tet < 5; ++tet)
            {
                const double fraction = fractionOf(cube, tet);
                if (fraction > 0 || m_lattice.entered(cube) >> tet & 1) keep({cube, tet, fraction});
            }
        }
        report(m_tally, m_fill);
        return std::move(m_fill);
    }

    /// Finds the untouched tets that are entirely inside: cheap, so that too many are refused before any is sampled.
    /// Returns the number of these plus the entered ones; stops beyond `most`.
    double findWholeTets(double most)
    {
        double atLeast = 0;
        for (int cube = 0, previous = -1; cube < m_lattice.cubeCount(); previous = cube++)
        {
            tellLoop(m_settings.m_progress, cube, m_lattice.cubeCount(), 0, kWholeFound);
            const bool sameAsPrevious = m_closed && cube % m_lattice.cubes()[0] != 0 && m_lattice.touched(cube) == 0 &&
                                        m_lattice.touched(previous) == 0;
            if (sameAsPrevious)
            {
                m_whole[cube] = m_whole[previous];
                if (m_whole[cube]) m_tally.add(m_lastWinding, 1);
            }
            else
                findWholeTetsOf(cube);
            atLeast += bits(m_whole[cube] | m_lattice.entered(cube));
            if (atLeast > most) break;
        }
        return atLeast;
    }

    /// Number of further tets likely to be kept: those near winding number 1/2 whose centre is inside.
    double likely() const { return m_likely; }

private:
    static constexpr std::uint8_t kAll = 31;    // the five tets of a cube
    static constexpr double kWholeFound = 0.2;  // share of the work

    void findWholeTetsOf(int cube)
    {
        if (m_lattice.touched(cube) == 0)
        {
            const std::array<Vec3, 4> x = m_lattice.corners(cube, 4);  // the middle tet: its centre is the cube's
            m_lastWinding = windingAt((x[0] + x[1] + x[2] + x[3]) * 0.25);
            // Around an open surface the winding number varies smoothly: a value near 1/2 needs samples.
            if (m_closed || std::abs(std::abs(m_lastWinding) - 0.5) > 0.25)
            {
                m_whole[cube] = isInside(m_lastWinding) ? kAll : 0;
                if (m_whole[cube]) m_tally.add(m_lastWinding, 1);
                return;
            }
        }
        for (int tet = 0; tet < 5; ++tet)
        {
            if (isCut(cube, tet)) continue;
            const std::array<Vec3, 4> x = m_lattice.corners(cube, tet);
            const double w = windingAt((x[0] + x[1] + x[2] + x[3]) * 0.25);
            if (!m_closed && std::abs(std::abs(w) - 0.5) < 0.25)
            {
                m_unsure.push_back(5LL * cube + tet);
                m_likely += isInside(w);
            }
            else if (isInside(w))
            {
                m_whole[cube] |= static_cast<std::uint8_t>(1 << tet);
                m_tally.add(w, CageLattice::tetVolume(tet));
            }
        }
    }

    double fractionOf(int cube, int tet)
    {
        if (m_whole[cube] >> tet & 1) return 1;
        const bool unsure = m_nextUnsure < m_unsure.size() && m_unsure[m_nextUnsure] == 5LL * cube + tet;
        if (unsure) ++m_nextUnsure;
        if (!unsure && !isCut(cube, tet)) return 0;
        const std::array<Vec3, 4> x = m_lattice.corners(cube, tet);
        int hits = 0;
        for (const Weights& w : m_samples)
        {
            const double winding = windingAt(x[0] * w[0] + x[1] * w[1] + x[2] * w[2] + x[3] * w[3]);
            if (!isInside(winding)) continue;
            ++hits;
            m_tally.add(winding, CageLattice::tetVolume(tet) / m_settings.m_fillSamples);
        }
        return static_cast<double>(hits) / m_settings.m_fillSamples;
    }

    /// True if the tet must be sampled. Contact alone does not cut it by a closed surface: it is inside or outside
    /// entirely.
    bool isCut(int cube, int tet) const
    {
        return (m_closed ? m_lattice.entered(cube) : m_lattice.touched(cube)) >> tet & 1;
    }

    void keep(const FilledTet& tet)
    {
        if (m_fill.m_tets.size() == static_cast<std::size_t>(m_settings.m_maxTets))
            rejectTooMany(m_settings.m_maxTets + 1.0);
        m_fill.m_tets.push_back(tet);
        m_fill.m_kept[tet.m_cube] |= static_cast<std::uint8_t>(1 << tet.m_tet);
    }

    double windingAt(const Vec3& p)
    {
        ++m_fill.m_sampleCount;
        return m_winding.at(m_lattice.toCentred(p));
    }

    static int bits(unsigned mask)
    {
        return (mask & 1) + (mask >> 1 & 1) + (mask >> 2 & 1) + (mask >> 3 & 1) + (mask >> 4 & 1);
    }

    [[noreturn]] void rejectTooMany(double atLeast) const
    {
        reject("the cage's cell size of ", m_lattice.cellSize(), " m gives at least ", atLeast,
               " elements, outside [1, ", m_settings.m_maxTets, "]; use larger cells (", m_lattice.safeCellSize(),
               " m is sure to fit) or raise m_maxTets");
    }

    const CageLattice& m_lattice;
    WindingNear m_winding;
    const bool m_closed;
    const CageSettings& m_settings;
    const std::vector<Weights> m_samples;
    std::vector<std::uint8_t> m_whole;  // per cube: a bit for each tet that is entirely inside
    std::vector<long long> m_unsure;    // 5 cube + tet, ascending: untouched, but near winding number 1/2
    std::size_t m_nextUnsure = 0;
    double m_likely = 0;
    double m_lastWinding = 0;
    FillTally m_tally;  // in lattice units
    CageFill m_fill;
};

}  // namespace

CageFill fillCage(const CageLattice& lattice, const SurfaceWinding& winding, bool closed, const CageSettings& settings)
{
    return Filler(lattice, winding, closed, settings).run();
}

void refill(const MovedTets& tets, const SurfaceWinding& winding, const CageSettings& settings, CageFill& fill)
{
    const std::vector<Weights> samples = spreadSamples(settings.m_fillSamples);
    WindingNear near(winding, 2 * settings.m_cellSize);
    const std::vector<Vec3>&X = tets.m_after.restPositions(), &before = tets.m_before.restPositions();
    for (int e = 0; e < tets.m_after.tetCount(); ++e)
    {
        tellLoop(settings.m_progress, e, tets.m_after.tetCount(), 0, 1);
        const Tet& t = tets.m_after.tets()[e];
        if (std::all_of(t.begin(), t.end(), [&](int i) { return norm(X[i] - before[i]) == 0; })) continue;
        int hits = 0;
        for (const Weights& w : samples)
            hits +=
                isInside(near.at(X[t[0]] * w[0] + X[t[1]] * w[1] + X[t[2]] * w[2] + X[t[3]] * w[3] - tets.m_centre));
        fill.m_tets[e].m_fraction = static_cast<double>(hits) / settings.m_fillSamples;
    }
}

double countTets(const CageLattice& lattice, const SurfaceWinding& winding, bool closed, const CageSettings& settings)
{
    Filler filler(lattice, winding, closed, settings);
    const double whole = filler.findWholeTets(2.0 * settings.m_targetTets);
    return whole + filler.likely();
}

}  // namespace bullet_fem
