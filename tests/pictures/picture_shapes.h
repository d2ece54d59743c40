// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "tools/pictures/offscreen_renderer.h"

namespace bullet_fem
{

/// A ball of 2 n^2 quadrilaterals around `centre`; its vertices lie on the sphere.
inline PictureMesh ball(const Vec3& centre, double radius, int n = 48)
{
    const double pi = std::acos(-1.);
    PictureMesh mesh;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j < 2 * n; ++j)
        {
            const double theta = pi * i / n, phi = pi * j / n;
            const Vec3 out{std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
            mesh.m_positions.push_back(centre + radius * out);
        }
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < 2 * n; ++j)
        {
            const int a = i * 2 * n + j, b = i * 2 * n + (j + 1) % (2 * n);
            mesh.m_triangles.push_back({a, b, b + 2 * n});
            mesh.m_triangles.push_back({a, b + 2 * n, a + 2 * n});
        }
    return mesh;
}

/// A rectangle around `centre` with corners at the signs - -, + -, + +, - + of both half sides.
inline PictureMesh rectangle(const Vec3& centre, const Vec3& halfSide0, const Vec3& halfSide1)
{
    PictureMesh mesh;
    mesh.m_positions = {centre - halfSide0 - halfSide1, centre + halfSide0 - halfSide1, centre + halfSide0 + halfSide1,
                        centre - halfSide0 + halfSide1};
    mesh.m_triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

/// The cube with corners at +-half around `centre`.
inline PictureMesh cube(const Vec3& centre, double half)
{
    PictureMesh mesh;
    for (int corner = 0; corner < 8; ++corner)
        mesh.m_positions.push_back(centre +
                                   half * Vec3{corner & 1 ? 1. : -1., corner & 2 ? 1. : -1., corner & 4 ? 1. : -1.});
    mesh.m_triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                        {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
    return mesh;
}

/// A view from (0, 0, 5) to the origin, with an empty background and no ground.
inline PictureScene emptyScene()
{
    PictureScene scene;
    scene.m_ground.m_shown = false;
    scene.m_camera.m_eye = {0, 0, 5};
    scene.m_camera.m_target = {0, 0, 0};
    return scene;
}

/// The pixel at the projection of `point`.
inline std::array<int, 3> pixelAt(const Image& image, const PictureCamera& camera, const Vec3& point)
{
    const PicturePoint p = projected(camera, image.m_size, point);
    return image.at(static_cast<int>(p.m_x), static_cast<int>(p.m_y));
}

inline int brightness(const std::array<int, 3>& pixel)
{
    return pixel[0] + pixel[1] + pixel[2];
}

/// Maximum difference of a colour component, out of 255.
inline int difference(const std::array<int, 3>& a, const std::array<int, 3>& b)
{
    return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

/// A colour as a pixel value.
inline std::array<int, 3> bytes(const Vec3& c)
{
    const auto byte = [](double part) { return static_cast<int>(std::lround(255 * part)); };
    return {byte(c.x), byte(c.y), byte(c.z)};
}

}  // namespace bullet_fem
