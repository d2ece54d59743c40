// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/cage/graded_lattice.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fem/cage/cage_embedding.h"
#include "fem/cage/cage_stages.h"
#include "fem/common/message.h"

namespace bullet_fem
{
namespace
{

constexpr double kGradedTouchTolerance = 1e-9;  // in cells, as in the ungraded lattice
constexpr double kSplitPerKept = 12;            // bounds memory: inner generations and dropped tets
constexpr double kGraded = 0.3;                 // share of the work

double minOf(const std::array<double, 4>& weights)
{
    return *std::min_element(weights.begin(), weights.end());
}

Vec3 middleOf(const std::array<Vec3, 4>& x)
{
    return (x[0] + x[1] + x[2] + x[3]) * 0.25;
}

}  // namespace

GradedLattice::GradedLattice(const GradingInput& input, double maxTets)
    : m_input(input),
      m_winding(input.m_winding, 2 * input.m_lattice.cellSize()),
      m_tets(input.m_lattice.cubes()),
      m_samples(spreadSamples(input.m_settings.m_fillSamples))
{
    addCubes();
    const std::size_t most = m_tets.tets().size() + static_cast<std::size_t>(kSplitPerKept * maxTets);
    WantedCells wanted{static_cast<std::size_t>(maxTets), {}};  // each requires more than one tet
    m_tooLarge = !findWantedCells(input.m_lattice, input.m_surface.parts(), input.m_grading, wanted) ||
                 !grade(wanted.m_cells, most, m_tets);
    for (int tet = 0; tet < m_tets.rootCount() && !m_tooLarge; ++tet) findLeaves(tet);
    m_kept.assign(m_tets.tets().size(), 0);
}

/// Adds the cubes in contact with the surface, and those inside.
void GradedLattice::addCubes()
{
    const CageLattice& lattice = m_input.m_lattice;
    double winding = 0;
    for (int cube = 0; cube < lattice.cubeCount(); ++cube)
    {
        tellLoop(m_input.m_settings.m_progress, cube, lattice.cubeCount(), 0, kGraded);
        if (lattice.touched(cube) != 0)
        {
            m_tets.addCube(cube, false);
            continue;
        }
        const bool sameAsPrevious =
            m_input.m_closed && cube % lattice.cubes()[0] != 0 && lattice.touched(cube - 1) == 0;
        if (!sameAsPrevious) winding = windingAt(lattice.cubeMiddle(cube));
        // Around an open surface the winding number varies smoothly: a value near 1/2 needs samples.
        const bool isSure = m_input.m_closed || std::abs(std::abs(winding) - 0.5) > 0.25;
        if (isSure && !isInside(winding)) continue;
        m_tets.addCube(cube, isSure);
        if (isSure) m_tally.add(winding, 1);
    }
}

void GradedLattice::findLeaves(int tet)
{
    const int child = m_tets.tets()[tet].m_child;
    if (child == 0) return m_leaves.push_back(tet);
    findLeaves(child);
    findLeaves(child + 1);
}

double GradedLattice::count(double most)
{
    if (m_tooLarge) return 2 * most;
    double sum = 0;
    for (std::size_t n = 0; n < m_leaves.size() && sum <= most; ++n)
    {
        tellLoop(m_input.m_settings.m_progress, n, m_leaves.size(), kGraded, 1);
        const State state = look(m_leaves[n]);
        if (state == State::unsure)
            sum += isInside(windingAt(middleOf(m_tets.corners(m_leaves[n]))));
        else
            sum += state != State::outside;
    }
    return sum;
}

GradedLattice::State GradedLattice::look(int tet)
{
    if (m_tets.tets()[tet].m_whole) return State::inside;
    const CageLattice& lattice = m_input.m_lattice;
    const TriangleTree& tree = m_input.m_surface.tree();
    std::array<Vec3, 4> x = m_tets.corners(tet);
    const Vec3 middle = middleOf(x);
    for (Vec3& corner : x) corner = lattice.toCentred(corner);
    const double slack = kGradedTouchTolerance * lattice.cellSize();
    if (tree.entersTet(x, slack)) return State::entered;
    if (!m_input.m_closed && tree.entersTet(x, -slack)) return State::unsure;
    const double winding = windingAt(middle);
    if (!m_input.m_closed && std::abs(std::abs(winding) - 0.5) < 0.25) return State::unsure;
    if (!isInside(winding)) return State::outside;
    m_tally.add(winding, m_tets.volume(tet));
    return State::inside;
}

double GradedLattice::fractionOf(int tet, State state)
{
    if (state == State::inside) return 1;
    if (state == State::outside) return 0;
    const std::array<Vec3, 4> x = m_tets.corners(tet);
    const double share = 1.0 / m_input.m_settings.m_fillSamples;
    int hits = 0;
    for (const std::array<double, 4>& w : m_samples)
    {
        const double winding = windingAt(x[0] * w[0] + x[1] * w[1] + x[2] * w[2] + x[3] * w[3]);
        if (!isInside(winding)) continue;
        ++hits;
        m_tally.add(winding, m_tets.volume(tet) * share);
    }
    return hits * share;
}

CageFill GradedLattice::fill()
{
    const int most = m_input.m_settings.m_maxTets;
    if (m_tooLarge) rejectTooMany(most + 1.0);
    CageFill fill;
    for (std::size_t n = 0; n < m_leaves.size(); ++n)
    {
        tellLoop(m_input.m_settings.m_progress, n, m_leaves.size(), kGraded, 1);
        const int leaf = m_leaves[n];
        const State state = look(leaf);
        const double fraction = fractionOf(leaf, state);
        if (fraction == 0 && state != State::entered) continue;
        if (static_cast<int>(fill.m_tets.size()) == most) rejectTooMany(most + 1.0);
        fill.m_tets.push_back({0, leaf, fraction});
        m_kept[leaf] = 1;
    }
    fill.m_sampleCount = m_sampleCount;
    bullet_fem::report(m_tally, fill);
    return fill;
}

std::vector<int> GradedLattice::holdVertices(const std::vector<Vec3>& vertices, const std::vector<char>& used,
                                             CageFill& fill)
{
    constexpr double kNear = 1e-6;  // in cells: finds the cubes that share the face, edge or corner p lies on
    const CageLattice& lattice = m_input.m_lattice;
    std::vector<int> held(vertices.size(), -1);
    for (std::size_t i = 0; i < vertices.size(); ++i)
    {
        if (!used[i]) continue;
        const Vec3 p = lattice.toLattice(vertices[i]);
        Holder best;
        for (const int cube : lattice.cubesAround(p, kNear))
        {
            const int first = m_tets.firstOf(lattice.place(cube));
            for (int n = 0; n < 6 && first >= 0; ++n) findHolder(first + n, p, best);
        }
        if (!best.m_kept)
        {
            m_kept[best.m_tet] = 1;
            fill.m_tets.push_back({0, best.m_tet, 0});
        }
        held[i] = best.m_tet;
    }
    std::vector<int> element(m_tets.tets().size(), 0), place(element);
    for (std::size_t n = 0; n < m_leaves.size(); ++n) place[m_leaves[n]] = static_cast<int>(n);
    std::sort(fill.m_tets.begin(), fill.m_tets.end(),
              [&](const FilledTet& a, const FilledTet& b) { return place[a.m_tet] < place[b.m_tet]; });
    for (std::size_t e = 0; e < fill.m_tets.size(); ++e) element[fill.m_tets[e].m_tet] = static_cast<int>(e);
    for (int& tet : held) tet = tet < 0 ? 0 : element[tet];
    return held;
}

void GradedLattice::findHolder(int tet, const Vec3& p, Holder& best) const
{
    constexpr double kOnTetWeight = -1e-9;  // minimum barycentric weight of a vertex in or on an element
    constexpr double kNear = -1e-3;         // minimum weight of a vertex in or near a tet whose children are searched
    const double weight = minOf(barycentric(m_tets.corners(tet), p));
    if (weight < kNear && best.m_tet >= 0) return;
    const int child = m_tets.tets()[tet].m_child;
    if (child != 0)
    {
        findHolder(child, p, best);
        return findHolder(child + 1, p, best);
    }
    const bool kept = m_kept[tet] && weight >= kOnTetWeight;
    if (kept != best.m_kept ? kept : weight > best.m_minWeight) best = {tet, weight, kept};
}

TetMesh GradedLattice::mesh(const std::vector<FilledTet>& kept) const
{
    std::vector<int> nodes, number(m_tets.nodes().size(), -1);
    for (const FilledTet& f : kept)
        for (const int node : m_tets.tets()[f.m_tet].m_corners)
            if (number[node] < 0)
            {
                number[node] = 0;
                nodes.push_back(node);
            }
    const auto place = [&](int node)
    {
        const Vec3& u = m_tets.nodes()[node];
        return std::array<double, 3>{u.z, u.y, u.x};
    };
    std::sort(nodes.begin(), nodes.end(), [&](int a, int b) { return place(a) < place(b); });
    std::vector<Vec3> X;
    for (const int node : nodes)
    {
        number[node] = static_cast<int>(X.size());
        X.push_back(m_input.m_lattice.toWorld(m_tets.nodes()[node]));
    }
    std::vector<Tet> tets;
    for (const FilledTet& f : kept)
    {
        tets.push_back(m_tets.orientedTet(f.m_tet));
        for (int& node : tets.back()) node = number[node];
    }
    return TetMesh(std::move(X), std::move(tets));
}

void GradedLattice::report(const std::vector<FilledTet>& kept, CageReport& report) const
{
    int finest = 0, coarsest = 1 << 20;
    report.m_levelTets = {};
    for (const FilledTet& f : kept)
    {
        const int generation = m_tets.tets()[f.m_tet].m_generation;
        finest = std::max(finest, generation);
        coarsest = std::min(coarsest, generation);
        ++report.m_levelTets[(generation + 2) / 3];
    }
    report.m_levels = (finest + 2) / 3;
    report.m_smallestCell = m_input.m_lattice.cellSize() * std::exp2(-finest / 3.0);
    report.m_largestCell = m_input.m_lattice.cellSize() * std::exp2(-coarsest / 3.0);
}

double GradedLattice::windingAt(const Vec3& p)
{
    ++m_sampleCount;
    return m_winding.at(m_input.m_lattice.toCentred(p));
}

void GradedLattice::rejectTooMany(double atLeast) const
{
    const CageSettings& settings = m_input.m_settings;
    reject("the cage's cell size of ", m_input.m_lattice.cellSize(), " m gives, graded by up to ",
           settings.m_mostLevels, " levels, at least ", atLeast, " elements, outside [1, ", settings.m_maxTets,
           "]; use larger cells, fewer m_mostLevels or m_cellsAcross, or raise m_maxTets");
}

}  // namespace bullet_fem
