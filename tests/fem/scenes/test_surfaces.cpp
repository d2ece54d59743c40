// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/scenes/test_surfaces.h"

#include <algorithm>
#include <map>

#include "fem/cage/triangle_tree.h"

namespace bullet_fem
{

SurfaceMesh boxSurface(const Vec3& low, const Vec3& high)
{
    SurfaceMesh box;
    for (int c = 0; c < 8; ++c)
        box.m_vertices.push_back({c & 1 ? high.x : low.x, c & 2 ? high.y : low.y, c & 4 ? high.z : low.z});
    box.m_triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                       {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return box;
}

SurfaceMesh sphereSurface(double radius, const Vec3& centre, int levels)
{
    const double g = (1 + std::sqrt(5.0)) / 2;
    SurfaceMesh ball;
    ball.m_vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                       {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    ball.m_triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                        {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                        {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    for (; levels > 0; --levels)
    {
        std::map<std::array<int, 2>, int> middles;
        const auto middle = [&](int i, int j)
        {
            const auto [at, isNew] =
                middles.insert({{std::min(i, j), std::max(i, j)}, static_cast<int>(ball.m_vertices.size())});
            if (isNew) ball.m_vertices.push_back((ball.m_vertices[i] + ball.m_vertices[j]) * 0.5);
            return at->second;
        };
        std::vector<Triangle> finer;
        for (const auto& [a, b, c] : ball.m_triangles)
        {
            const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
        }
        ball.m_triangles = finer;
        for (Vec3& x : ball.m_vertices) x *= 1 / norm(x);
    }
    for (Vec3& x : ball.m_vertices) x = centre + x * (radius / norm(x));
    return ball;
}

SurfaceMesh torusSurface(double major, double minor, int around)
{
    const int across = around / 2;
    const double turn = 2 * 3.14159265358979323846;
    SurfaceMesh torus;
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j)
        {
            const double u = turn * i / around, v = turn * j / across, r = major + minor * std::cos(v);
            torus.m_vertices.push_back({r * std::cos(u), r * std::sin(u), minor * std::sin(v)});
            const int i2 = (i + 1) % around, j2 = (j + 1) % across;
            const int a = i * across + j, b = i2 * across + j, c = i2 * across + j2, d = i * across + j2;
            torus.m_triangles.insert(torus.m_triangles.end(), {{a, b, c}, {a, c, d}});
        }
    return torus;
}

SurfaceMesh joined(const SurfaceMesh& a, const SurfaceMesh& b)
{
    SurfaceMesh both = a;
    const int shift = static_cast<int>(a.m_vertices.size());
    both.m_vertices.insert(both.m_vertices.end(), b.m_vertices.begin(), b.m_vertices.end());
    for (const Triangle& t : b.m_triangles) both.m_triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
    return both;
}

SurfaceMesh flipped(SurfaceMesh surface)
{
    for (Triangle& t : surface.m_triangles) std::swap(t[1], t[2]);
    return surface;
}

SurfaceMesh without(SurfaceMesh surface, int first, int last)
{
    surface.m_triangles.erase(surface.m_triangles.begin() + first, surface.m_triangles.begin() + last);
    return surface;
}

CageSettings withCell(double cellSize)
{
    CageSettings settings;
    settings.m_cellSize = cellSize;
    return settings;
}

bool piercesBoundary(const Cage& cage, const SurfaceMesh& surface, double depth)
{
    const TriangleTree tree(surface.m_vertices, surface.m_triangles);
    const std::vector<Vec3>& X = cage.m_mesh.restPositions();
    return std::any_of(cage.m_mesh.surface().begin(), cage.m_mesh.surface().end(),
                       [&](const Triangle& t)
                       {
                           // A thin tet on the outer side of the face.
                           const Vec3 &a = X[t[0]], &b = X[t[1]], &c = X[t[2]], n = cross(b - a, c - a);
                           const Vec3 tip = (a + b + c) * (1.0 / 3) + n * (1e-3 / std::sqrt(norm(n)));
                           return tree.entersTet({a, c, b, tip}, depth);
                       });
}

}  // namespace bullet_fem
