// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "io/surface/triangulate.h"

namespace bullet_fem
{
namespace
{

constexpr std::size_t kMaxCornersForEars = 256;

/// Twice the polygon's area vector (Newell), relative to its first corner, to avoid cancellation far from the origin.
Vec3 areaVector(const std::vector<Vec3>& positions, const std::vector<int>& corners)
{
    Vec3 area;
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        area += cross(positions[corners[i]] - positions[corners[0]], positions[corners[i + 1]] - positions[corners[0]]);
    return area;
}

/// Whether the corner i turns left about `normal` and its triangle holds no other corner.
bool isEar(const std::vector<Vec3>& positions, const std::vector<int>& corners, std::size_t i, const Vec3& normal)
{
    const std::size_t n = corners.size();
    const Vec3 a = positions[corners[(i + n - 1) % n]], b = positions[corners[i]], c = positions[corners[(i + 1) % n]];
    const auto leftOf = [&normal](const Vec3& p, const Vec3& q, const Vec3& x)
    { return dot(cross(q - p, x - p), normal); };
    const auto equal = [](const Vec3& p, const Vec3& q) { return p.x == q.x && p.y == q.y && p.z == q.z; };
    if (!(leftOf(a, b, c) > 0)) return false;
    for (const int corner : corners)
    {
        const Vec3& x = positions[corner];
        // Corners that coincide with the ear's own do not block it: a polygon with a hole visits a bridge twice.
        if (equal(x, a) || equal(x, b) || equal(x, c)) continue;
        if (leftOf(a, b, x) >= 0 && leftOf(b, c, x) >= 0 && leftOf(c, a, x) >= 0) return false;
    }
    return true;
}

}  // namespace

void triangulatePolygon(const std::vector<Vec3>& positions, std::vector<int> corners, std::vector<Triangle>& triangles)
{
    const Vec3 normal = areaVector(positions, corners);
    for (std::size_t i = 0, tried = 0; corners.size() > 3 && corners.size() <= kMaxCornersForEars;)
    {
        const std::size_t n = corners.size();
        i %= n;
        if (!isEar(positions, corners, i, normal))
        {
            if (++tried == n) break;
            ++i;
            continue;
        }
        triangles.push_back({corners[(i + n - 1) % n], corners[i], corners[(i + 1) % n]});
        corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(i));
        tried = 0;
    }
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) triangles.push_back({corners[0], corners[i], corners[i + 1]});
}

}  // namespace bullet_fem
