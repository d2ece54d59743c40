// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/cage/winding_near.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "fem/scenes/test_surfaces.h"

namespace bullet_fem
{
namespace
{

Vec3 anywhere(std::mt19937& generator, double size)
{
    Vec3 p;
    for (int a = 0; a < 3; ++a) p[a] = size * (generator() / 2147483648.0 - 1);
    return p;
}

// Evaluates random points in turn: nearly all rays cross the surface, some several times.
void expectWholeNumbers(const SurfaceMesh& surface, double size)
{
    const SurfaceWinding winding(surface.m_vertices, surface.m_triangles, true);
    WindingNear near(winding, 10 * size);
    std::mt19937 generator(1);
    for (int k = 0; k < 2000; ++k)
    {
        const Vec3 p = anywhere(generator, size);
        EXPECT_EQ(std::round(near.at(p)), std::round(winding.m_number.at(p))) << p.x << " " << p.y << " " << p.z;
    }
}

TEST(WindingNear, CountsSurfaceCrossings)
{
    expectWholeNumbers(boxSurface({-1, -1, -1}, {1, 1, 1}), 1.5);
    expectWholeNumbers(sphereSurface(1, {}, 3), 1.5);
    expectWholeNumbers(torusSurface(1, 0.4, 40), 1.6);
    expectWholeNumbers(flipped(sphereSurface(1, {}, 2)), 1.5);
}

TEST(WindingNear, CountsOverlappingComponentsTwice)
{
    expectWholeNumbers(joined(sphereSurface(1, {}, 2), sphereSurface(1, {0.7, 0.1, 0.2}, 2)), 2);
}

// Rays along a lattice cross boxes at their edges, diagonals and corners.
TEST(WindingNear, PassesEdgesAndCornersOnce)
{
    const SurfaceMesh box = boxSurface({-1, -1, -1}, {1, 1, 1});
    const SurfaceWinding winding(box.m_vertices, box.m_triangles, true);
    for (int k = 0; k < 125; ++k)
    {
        const Vec3 from = {k % 5 - 2.5, k / 5 % 5 - 2.5, k / 25 - 2.5};
        for (int n = 0; n < 125; ++n)
        {
            const Vec3 to = {n % 5 - 2.5, n / 5 % 5 - 2.5, n / 25 - 2.5};
            const auto inside = [](const Vec3& p) {
                return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) < 1 ? 1 : 0;
            };
            EXPECT_EQ(winding.m_closed->crossings(from, to), inside(from) - inside(to)) << k << " to " << n;
        }
    }
}

TEST(WindingNear, EvaluatesEveryPointOfAnOpenSurface)
{
    const SurfaceMesh open = without(sphereSurface(1, {}, 2), 0, 100);
    const SurfaceWinding winding(open.m_vertices, open.m_triangles, false);
    WindingNear near(winding, 10);
    std::mt19937 generator(1);
    for (int k = 0; k < 100; ++k)
    {
        const Vec3 p = anywhere(generator, 1.5);
        EXPECT_EQ(near.at(p), winding.m_number.at(p));
    }
}

}  // namespace
}  // namespace bullet_fem
