// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/geometry/surface/half_space_cull.h"

#include <gtest/gtest.h>

#include "bridge/random_vectors.h"
#include "bullet_fem/fem/mesh/generators.h"

namespace bullet_fem
{
namespace
{

constexpr double kFar = 0.1;  // [m]

// The oracle: by the nearest triangle, and by the side of its normal on which the point lies.
bool isFarOutside(const SoftSurface& surface, const Vec3& p)
{
    TrianglePoint nearest;
    const int t = surface.tree().nearestTriangle(
        p, 1e9, [](int) { return false; }, nearest);
    const Vec3 r = p - nearest.m_point;
    return norm(r) > kFar && !(dot(r, normalAt(surface, t, nearest)) < 0);
}

// Counts points that the cull proves to be far outside; the oracle must agree for each.
template <class Move>
int proved(const TetMesh& mesh, Move move)
{
    SoftSurface surface(boundaryOf(mesh));
    std::vector<Vec3> x = mesh.restPositions();
    for (Vec3& p : x) p = move(p);
    surface.place(x, std::vector<Vec3>(x.size()), 1);
    surface.prepareAll();
    Random random;
    int count = 0;
    for (int k = 0; k < 3000; ++k)
    {
        const Vec3 direction = unit(random.point());
        const HalfSpaceCull proof(surface, direction);
        for (int n = 0; n < 3; ++n)
        {
            const Vec3 p = 1.3 * direction + 0.8 * random.point();
            if (!proof.isFarOutside(p, kFar)) continue;
            ++count;
            EXPECT_TRUE(isFarOutside(surface, p));
        }
    }
    return count;
}

TEST(HalfSpaceCull, AgreesWithTheNearestTriangle)
{
    EXPECT_GT(proved(makeSphere(1, 6), [](const Vec3& X) { return X; }), 1000);
}

TEST(HalfSpaceCull, AgreesWithTheNearestTriangleOfACrumpledBody)
{
    Random random;
    EXPECT_GT(proved(makeSphere(1, 6), [&](const Vec3& X) { return X + 0.1 * random.point(); }), 300);
}

// Inverted elements have normals that point inwards, so the cull proves nothing there and the points are searched.
TEST(HalfSpaceCull, AgreesWithTheNearestTriangleOfAnInvertedBody)
{
    const auto pushedThrough = [](const Vec3& X) { return norm(X - Vec3{0, 0, 1}) < 0.3 ? Vec3{X.x, X.y, -1.4} : X; };
    EXPECT_GT(proved(makeSphere(1, 6), pushedThrough), 100);
    const auto insideOut = [](const Vec3& X) { return Vec3{-X.x, X.y, X.z}; };
    EXPECT_EQ(proved(makeSphere(1, 6), insideOut), 0);
}

TEST(HalfSpaceCull, CullsNothingForOpenSurfaces)
{
    SoftSurface sheet(RestSurface{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, 1, 1, {}});
    EXPECT_FALSE(sheet.topology().isClosed());
    EXPECT_FALSE(HalfSpaceCull(sheet, {0, 0, 1}).isFarOutside({0.3, 0.3, 5}, kFar));
    EXPECT_FALSE(HalfSpaceCull().isFarOutside({0, 0, 5}, kFar));
}

}  // namespace
}  // namespace bullet_fem
