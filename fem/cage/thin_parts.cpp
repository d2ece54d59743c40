// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/cage/thin_parts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "fem/cage/fill_samples.h"

namespace bullet_fem
{
namespace
{

constexpr double kOwnComponentReach = 1e-6;  // share of the reach: nearer hits are the fragment itself
constexpr double kProbeBeyond = 1e-3;        // share of the width: distance of the probes behind the sides
// Minimum cosine between the fragment's normal and the line of the opposite normal.
constexpr double kOpposingCosine = 0.5;

/// The vectors across solid and gap from a point, zero where nothing is near.
struct Widths
{
    Vec3 m_solid, m_gap;

    double least(double otherwise) const
    {
        for (const Vec3& way : {m_solid, m_gap})
            if (norm(way) > 0) otherwise = std::min(otherwise, norm(way));
        return otherwise;
    }
};

double longestEdge(const TriangleCorners& t)
{
    return std::max({norm(t[1] - t[0]), norm(t[2] - t[1]), norm(t[0] - t[2])});
}

/// Both halves, the longest edge bisected.
std::array<TriangleCorners, 2> halves(TriangleCorners t)
{
    while (norm(t[1] - t[0]) < longestEdge(t)) std::rotate(t.begin(), t.begin() + 1, t.end());
    const Vec3 middle = 0.5 * (t[0] + t[1]);
    return {TriangleCorners{t[0], middle, t[2]}, TriangleCorners{middle, t[1], t[2]}};
}

class Finder
{
public:
    explicit Finder(const ThinSearch& search) : m_search(search), m_winding(search.m_winding, 2 * search.m_reach) {}

    void look(const TriangleCorners& t)
    {
        const Vec3 area = cross(t[1] - t[0], t[2] - t[0]);
        if (!(norm(area) > 0)) return;
        m_normal = area * (1 / norm(area));
        lookAt(t);
    }

    std::vector<ThinPart> parts() { return std::move(m_parts); }

private:
    void lookAt(const TriangleCorners& t)
    {
        const double edge = longestEdge(t);
        if (edge > m_search.m_coarsest) return lookAtHalves(t);
        const Widths widths = edge > m_search.m_finest ? measure(middleOf(t)) : widthsOfBlock(middleOf(t));
        const double wanted = widths.least(m_search.m_coarsest / m_search.m_edgePerWidth) * m_search.m_edgePerWidth;
        if (edge > std::max(wanted, m_search.m_finest)) return lookAtHalves(t);
        if (norm(widths.m_solid) > 0) m_parts.push_back({t, widths.m_solid, false});
        if (norm(widths.m_gap) > 0) m_parts.push_back({t, widths.m_gap, true});
    }

    void lookAtHalves(const TriangleCorners& t)
    {
        for (const TriangleCorners& half : halves(t)) lookAt(half);
    }

    static Vec3 middleOf(const TriangleCorners& t) { return (t[0] + t[1] + t[2]) * (1.0 / 3); }

    const Widths& widthsOfBlock(const Vec3& p)
    {
        std::array<long long, 4> key;
        for (int a = 0; a < 3; ++a) key[a] = std::llround(std::floor(p[a] / m_search.m_finest));
        key[3] = 0;
        for (int a = 0; a < 3; ++a) key[3] = 3 * key[3] + std::lround(1.5 * m_normal[a]);
        const auto [at, isNew] = m_blocks.try_emplace(key);
        if (isNew) at->second = measure(p);
        return at->second;
    }

    Widths measure(const Vec3& p)
    {
        Widths widths;
        for (const double side : {-1.0, 1.0})
        {
            const Ray ray{p, m_normal * (side * m_search.m_reach), kOwnComponentReach, 1};
            const RayHit hit = m_search.m_tree.firstAlong(ray);
            if (hit.m_along < 0 || std::abs(dot(m_normal, hit.m_normal)) < kOpposingCosine * norm(hit.m_normal))
                continue;
            const Vec3 across = ray.m_way * hit.m_along;
            const bool between = insideAt(p + 0.5 * across), before = insideAt(p - kProbeBeyond * across),
                       after = insideAt(p + (1 + kProbeBeyond) * across);
            if (between != before && between != after) (between ? widths.m_solid : widths.m_gap) = across;
        }
        return widths;
    }

    bool insideAt(const Vec3& p) { return isInside(m_winding.at(p)); }

    const ThinSearch& m_search;
    WindingNear m_winding;
    Vec3 m_normal;  // normal of the current triangle
    std::map<std::array<long long, 4>, Widths> m_blocks;
    std::vector<ThinPart> m_parts;
};

}  // namespace

std::vector<ThinPart> findThinParts(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                                    const ThinSearch& search)
{
    Finder finder(search);
    for (const Triangle& t : triangles) finder.look({vertices[t[0]], vertices[t[1]], vertices[t[2]]});
    return finder.parts();
}

}  // namespace bullet_fem
