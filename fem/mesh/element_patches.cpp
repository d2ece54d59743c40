// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/mesh/element_patches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <numeric>
#include <utility>

#include "bullet_fem/fem/mesh/element_materials.h"
#include "fem/mesh/element_faces.h"

namespace bullet_fem
{
namespace
{

constexpr int kMinWanted = 4;    // minimum patch size; smaller ones are merged into a neighbour with room
constexpr double kAlike = 1e-3;  // relative tolerance of equal compactness
constexpr int kNone = -1;
// A parallelepiped of five elements: its volume over the square root of the determinant of its nodes' second moments,
// which no linear map changes. Other patches of five elements and eight nodes have 6.0 at most in regular meshes; the
// tolerance admits cells that are slightly curved.
constexpr std::size_t kCellElements = 5;
constexpr std::ptrdiff_t kCellNodes = 8;
constexpr double kCellVolume = 8, kCellTolerance = 0.03;

/// The groups of elements that may share a patch.
struct PatchGroups
{
    const std::vector<int>& m_group;  // per element; empty: all are in one

    bool joins(int e, int f) const
    {
        return e == f || m_group.empty() || (m_group[e] == m_group[f] && m_group[e] != ElementMaterials::kAlone);
    }
};

/// Neighbours across the faces of every element; kNone on the boundary and at another group.
std::vector<std::array<int, 4>> neighboursOf(const std::vector<Tet>& tets, const PatchGroups& groups)
{
    std::vector<std::array<int, 4>> neighbours = elementsBehindFaces(tets);
    for (std::size_t e = 0; e < tets.size(); ++e)
        for (int& f : neighbours[e])
            if (f != kNone && !groups.joins(static_cast<int>(e), f)) f = kNone;
    return neighbours;
}

/// Candidate patches: the elements around an edge, and an element with all its neighbours.
struct Candidates
{
    Candidates(const TetMesh& mesh, const PatchGroups& groups, const std::vector<std::array<int, 4>>& neighbours)
        : m_of(mesh.tets().size())
    {
        addStars(mesh, groups);
        for (int e = 0; e < mesh.tetCount(); ++e)
        {
            std::vector<int> elements = {e};
            for (const int f : neighbours[e])
                if (f != kNone) elements.push_back(f);
            add(mesh, std::move(elements));
        }
    }

    std::vector<std::vector<int>> m_elements;
    std::vector<double> m_score;         ///< see compactness()
    std::vector<std::vector<int>> m_of;  ///< candidates that contain each element

private:
    void addStars(const TetMesh& mesh, const PatchGroups& groups)
    {
        struct End
        {
            int m_low, m_high, m_tet;
        };
        std::vector<End> ends;
        ends.reserve(6 * mesh.tets().size());
        for (int e = 0; e < mesh.tetCount(); ++e)
            for (const auto& pair : kElementEdges)
            {
                const auto [low, high] = std::minmax(mesh.tets()[e][pair[0]], mesh.tets()[e][pair[1]]);
                ends.push_back({low, high, e});
            }
        std::sort(ends.begin(), ends.end(),
                  [](const End& a, const End& b)
                  {
                      if (a.m_low != b.m_low) return a.m_low < b.m_low;
                      return a.m_high != b.m_high ? a.m_high < b.m_high : a.m_tet < b.m_tet;
                  });
        for (std::size_t k = 0; k < ends.size();)
        {
            std::vector<int> elements;
            const End first = ends[k];
            for (; k < ends.size() && ends[k].m_low == first.m_low && ends[k].m_high == first.m_high; ++k)
                elements.push_back(ends[k].m_tet);
            const auto joins = [&](int e) { return groups.joins(elements.front(), e); };
            if (std::all_of(elements.begin(), elements.end(), joins)) add(mesh, std::move(elements));
        }
    }

    void add(const TetMesh& mesh, std::vector<int> elements)
    {
        const int size = static_cast<int>(elements.size());
        if (size < kMinWanted || size > ElementPatches::kMax) return;
        for (const int e : elements) m_of[e].push_back(static_cast<int>(m_elements.size()));
        m_score.push_back(compactness(mesh, elements));
        m_elements.push_back(std::move(elements));
    }

    // Volume over the cube of the mean distance of the nodes from their centroid: 1.54 for a cube, 1.24 for the
    // octahedron of a lattice. Five elements that fill a parallelepiped count as a cube, so that flat cells of boxes
    // are patches, too.
    static double compactness(const TetMesh& mesh, const std::vector<int>& elements)
    {
        std::array<int, 4 * ElementPatches::kMax> nodes;
        auto end = nodes.begin();
        double volume = 0;
        for (const int e : elements)
        {
            volume += mesh.tetVolume(e);
            end = std::copy(mesh.tets()[e].begin(), mesh.tets()[e].end(), end);
        }
        std::sort(nodes.begin(), end);
        end = std::unique(nodes.begin(), end);
        const double share = 1.0 / static_cast<double>(end - nodes.begin());
        Vec3 middle;
        for (auto node = nodes.begin(); node != end; ++node) middle += share * mesh.restPositions()[*node];
        double square = 0;
        Mat3 moments;
        for (auto node = nodes.begin(); node != end; ++node)
        {
            const Vec3 r = mesh.restPositions()[*node] - middle;
            square += share * dot(r, r);
            moments += share * outer(r, r);
        }
        const bool isCell = elements.size() == kCellElements && end - nodes.begin() == kCellNodes &&
                            std::fabs(volume / std::sqrt(determinant(moments)) / kCellVolume - 1) < kCellTolerance;
        return isCell ? kCellVolume / std::sqrt(27.0) : volume / (square * std::sqrt(square));
    }
};

class PatchMaker
{
public:
    PatchMaker(const TetMesh& mesh, const std::vector<int>& group)
        : m_mesh(mesh),
          m_groups{group},
          m_neighbours(neighboursOf(mesh.tets(), m_groups)),
          m_patch(mesh.tets().size(), kNone)
    {
    }

    std::vector<int> make()
    {
        takeCandidates();
        takeRest();
        giveAwaySmallOnes();
        return std::move(m_patch);
    }

private:
    bool isFree(int e) const { return m_patch[e] == kNone; }
    bool areFree(const std::vector<int>& elements) const
    {
        return std::all_of(elements.begin(), elements.end(), [this](int e) { return isFree(e); });
    }

    void take(const std::vector<int>& elements)
    {
        for (const int e : elements) m_patch[e] = static_cast<int>(m_members.size());
        m_members.push_back(elements);
    }

    // Takes candidates in order of compactness; equally compact ones together.
    void takeCandidates()
    {
        const Candidates all(m_mesh, m_groups, m_neighbours);
        std::vector<int> order(all.m_elements.size());
        std::iota(order.begin(), order.end(), 0);
        std::sort(order.begin(), order.end(),
                  [&all](int a, int b)
                  { return all.m_score[a] != all.m_score[b] ? all.m_score[a] > all.m_score[b] : a < b; });
        std::vector<char> isAlike(order.size(), 0);
        for (std::size_t k = 0; k < order.size();)
        {
            const double least = (1 - kAlike) * all.m_score[order[k]];
            std::vector<int> alike;
            for (; k < order.size() && all.m_score[order[k]] >= least; ++k)
                if (areFree(all.m_elements[order[k]])) alike.push_back(order[k]);
            for (const int c : alike) isAlike[c] = 1;
            takeEqual(all, isAlike, alike);
            for (const int c : alike) isAlike[c] = 0;
        }
    }

    // Takes equally compact candidates from neighbour to neighbour, so that they fit together in a lattice: every
    // element is in an octahedron around an axis between cube centres and in one around a cube edge. Candidates with an
    // element that is in few others come first, because it leaves no choice.
    void takeEqual(const Candidates& all, const std::vector<char>& isAlike, std::vector<int>& alike)
    {
        const auto choices = [&](int c)
        {
            std::ptrdiff_t fewest = ElementPatches::kMax * ElementPatches::kMax;
            for (const int e : all.m_elements[c])
                fewest = std::min(fewest, std::count_if(all.m_of[e].begin(), all.m_of[e].end(),
                                                        [&](int other) { return isAlike[other] != 0; }));
            return fewest;
        };
        std::vector<std::pair<std::ptrdiff_t, int>> seeds;
        for (const int c : alike) seeds.emplace_back(choices(c), c);
        std::sort(seeds.begin(), seeds.end());
        for (const auto& [fewest, seed] : seeds)
        {
            if (!areFree(all.m_elements[seed])) continue;
            std::deque<int> front = {seed};
            while (!front.empty())
            {
                const std::vector<int>& elements = all.m_elements[front.front()];
                front.pop_front();
                if (!areFree(elements)) continue;
                take(elements);
                for (const int e : elements)
                    for (const int f : m_neighbours[e])
                        if (f != kNone && isFree(f))
                            for (const int c : all.m_of[f])
                                if (isAlike[c]) front.push_back(c);
            }
        }
    }

    // Groups the remaining elements with their free neighbours, up to the maximum patch size.
    void takeRest()
    {
        for (int seed = 0; seed < m_mesh.tetCount(); ++seed)
        {
            if (!isFree(seed)) continue;
            std::vector<int> elements = {seed};
            for (std::size_t k = 0; k < elements.size(); ++k)
                for (const int f : m_neighbours[elements[k]])
                    if (f != kNone && isFree(f) && static_cast<int>(elements.size()) < ElementPatches::kMax &&
                        std::find(elements.begin(), elements.end(), f) == elements.end())
                        elements.push_back(f);
            take(elements);
        }
    }

    // Merges small patches into the neighbour with the most shared faces; among equals, the smallest.
    void giveAwaySmallOnes()
    {
        for (std::size_t p = 0; p < m_members.size(); ++p)
        {
            const int size = static_cast<int>(m_members[p].size());
            if (size == 0 || size >= kMinWanted) continue;
            std::vector<int> around;  // neighbouring patches, once per shared face
            for (const int e : m_members[p])
                for (const int f : m_neighbours[e])
                    if (f != kNone && m_patch[f] != static_cast<int>(p)) around.push_back(m_patch[f]);
            std::sort(around.begin(), around.end());
            int best = kNone;
            std::ptrdiff_t maxFaces = 0;
            for (const int q : around)
            {
                const std::ptrdiff_t faces = std::count(around.begin(), around.end(), q);
                if (static_cast<int>(m_members[q].size()) + size > ElementPatches::kMax || q == best) continue;
                if (faces < maxFaces) continue;
                if (faces == maxFaces && m_members[q].size() >= m_members[best].size()) continue;
                best = q, maxFaces = faces;
            }
            if (best == kNone) continue;
            for (const int e : m_members[p])
            {
                m_patch[e] = best;
                m_members[best].push_back(e);
            }
            m_members[p].clear();
        }
    }

    const TetMesh& m_mesh;
    PatchGroups m_groups;
    std::vector<std::array<int, 4>> m_neighbours;
    std::vector<int> m_patch;
    std::vector<std::vector<int>> m_members;
};

}  // namespace

ElementPatches::ElementPatches(const TetMesh& mesh, const std::vector<int>& group)
    : m_patch(PatchMaker(mesh, group).make())
{
    // Numbers the patches by their first elements.
    std::vector<int> number(m_patch.size(), kNone), size;
    for (int& p : m_patch)
    {
        if (number[p] == kNone)
        {
            number[p] = static_cast<int>(size.size());
            size.push_back(0);
        }
        p = number[p];
        ++size[p];
    }
    for (const int s : size) m_start.push_back(m_start.back() + s);
    m_element.resize(m_patch.size());
    std::vector<int> next(m_start.begin(), m_start.end() - 1);
    for (std::size_t e = 0; e < m_patch.size(); ++e) m_element[next[m_patch[e]]++] = static_cast<int>(e);
}

int ElementPatches::size(int patch) const
{
    return m_start[patch + 1] - m_start[patch];
}

}  // namespace bullet_fem
