// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>
#include <cmath>
#include <random>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/btFemVectors.h"

namespace bullet_fem
{

constexpr int kRays = 10000;       ///< number of rays for each body
constexpr double kRayEdge = 0.02;  ///< barycentric: closer to an edge Bullet may report the neighbour

/// The first face hit by a ray, by intersection with each triangle.
struct RayReference
{
    int m_face = -1;  ///< none
    double m_fraction = 2;
    double m_smallest = 0;  ///< barycentric coordinate
    double m_cosine = 1;    ///< between ray and normal
    double m_nearMiss = 2;  ///< smallest fraction of a triangle that the ray just misses

    /// Resolution of the fraction in single precision.
    double tolerance(const Vec3& from, const Vec3& to) const
    {
        return 1e-6 * (1 + norm(from) / norm(to - from)) / m_cosine;
    }
    bool isClear() const { return m_face >= 0 && m_smallest > kRayEdge && m_nearMiss > m_fraction; }
};

/// Tests all faces of a body, in double precision.
inline RayReference bruteForce(const btSoftBody& body, const Vec3& from, const Vec3& to)
{
    RayReference best;
    double nearMiss = 2;
    for (int f = 0; f < body.m_faces.size(); ++f)
    {
        Vec3 x[3];
        for (int a = 0; a < 3; ++a) x[a] = vec3(body.m_faces[f].m_n[a]->m_x);
        const Vec3 n = cross(x[1] - x[0], x[2] - x[0]);
        const double slope = dot(to - from, n);
        if (slope == 0) continue;
        const double t = dot(x[0] - from, n) / slope;
        const Vec3 p = from + t * (to - from);
        double smallest = 1;
        for (int a = 0; a < 3; ++a)
        {
            const Vec3 &b = x[(a + 1) % 3], &c = x[(a + 2) % 3];
            smallest = std::min(smallest, dot(cross(b - p, c - p), n) / dot(n, n));
        }
        const double cosine = std::fabs(slope) / (norm(n) * norm(to - from));
        // In single precision, triangles parallel to the ray may be hit anywhere along it.
        if (smallest < 0 && smallest > -kRayEdge / cosine) nearMiss = std::min(nearMiss, t - 1e-4 / cosine);
        if (smallest >= 0 && t >= 0 && t <= 1 && t < best.m_fraction) best = {f, t, smallest, cosine, 2};
    }
    best.m_nearMiss = nearMiss;
    return best;
}

/// End points of random rays near the body: from a sphere around it through a point near it, to twice the distance.
class Rays
{
public:
    explicit Rays(const btSoftBody& body)
    {
        Vec3 low = vec3(body.m_nodes[0].m_x), high = low;
        for (int i = 0; i < body.m_nodes.size(); ++i)
            for (int c = 0; c < 3; ++c)
            {
                low[c] = std::min(low[c], double(body.m_nodes[i].m_x[c]));
                high[c] = std::max(high[c], double(body.m_nodes[i].m_x[c]));
            }
        m_middle = 0.5 * (low + high);
        m_half = 0.6 * (high - low);
    }

    void next(btVector3& from, btVector3& to)
    {
        const Vec3 way = {unit(), unit(), unit()};
        const Vec3 start = m_middle + (2.5 * norm(m_half) / std::max(norm(way), 1e-3)) * way;
        Vec3 through = m_middle;
        for (int c = 0; c < 3; ++c) through[c] += unit() * m_half[c];
        from = bulletVector(start);
        to = bulletVector(start + 2.0 * (through - start));
    }

private:
    double unit() { return std::uniform_real_distribution<double>(-1, 1)(m_random); }

    std::mt19937 m_random{7};
    Vec3 m_middle, m_half;
};

}  // namespace bullet_fem
