// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/geometry/surface/surface_curvature.h"

#include "bullet_bridge/geometry/surface/triangle_proximity.h"

namespace bullet_fem
{
namespace
{

constexpr double kCreaseCosine = 0.64;  // cosine of 50 degrees: a larger dihedral angle is a crease
constexpr double kRoundShare = 0.1;     // smallest share of a vertex's curvature without creases that makes it round
constexpr double kFewFacets = 0.65;     // change of the normal along an edge with about ten facets around [-]

}  // namespace

SurfaceCurvature::SurfaceCurvature(const SurfaceTopology& topology, const std::vector<Vec3>& x)
    : m_largest(x.size(), 0), m_hasFewFacets(x.size(), 0)
{
    std::vector<Vec3> area, facing, normal(x.size());  // area vectors of triangles, their unit normals, vertex normals
    for (const Triangle& t : topology.triangles())
    {
        area.push_back(cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]]));
        facing.push_back(unit(area.back()));
        for (int corner : t) normal[corner] += area.back();
    }
    for (Vec3& n : normal) n = unit(n);
    // Normal from the triangles at a vertex that no crease separates from the given triangle.
    const auto smoothNormal = [&](int vertex, int triangle)
    {
        Vec3 sum;
        for (int k : topology.trianglesAt(vertex))
            if (dot(facing[k], facing[triangle]) >= kCreaseCosine) sum += area[k];
        return unit(sum);
    };
    std::vector<double> smooth(x.size(), 0);
    for (int k = 0; k < topology.triangleCount(); ++k)
        for (int i = 0; i < 3; ++i)
        {
            const int a = topology.triangles()[k][i], b = topology.triangles()[k][(i + 1) % 3];
            const Vec3 edge = x[b] - x[a];
            const double square = dot(edge, edge);
            if (!(square > 0)) continue;
            const double whole = dot(normal[b] - normal[a], edge) / square;
            const double part = dot(smoothNormal(b, k) - smoothNormal(a, k), edge) / square;
            for (int end : {a, b})
            {
                m_largest[end] = std::max(m_largest[end], whole);
                smooth[end] = std::max(smooth[end], part);
                if (whole * norm(edge) > kFewFacets) m_hasFewFacets[end] = 1;
            }
        }
    for (std::size_t i = 0; i < x.size(); ++i)
    {
        const bool round = smooth[i] > kRoundShare * m_largest[i];
        if (round) m_largest[i] = smooth[i];
        m_hasFewFacets[i] = m_hasFewFacets[i] && round;
    }
}

}  // namespace bullet_fem
