// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/scene_shapes.h"

#include <cmath>

#include "btBulletDynamicsCommon.h"
#include "bullet_fem/btFemVectors.h"

namespace bullet_fem
{
namespace
{

constexpr double kPi = 3.14159265358979323846;
constexpr int kSegments = 32, kRings = 8;  // segments around y, and rings of a hemisphere from pole to equator

SurfaceMesh boxSurface(const Vec3& size)
{
    // Corners are numbered by their signs, x + 2 y + 4 z.
    constexpr Triangle sides[12] = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                                    {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
    SurfaceMesh mesh;
    for (int corner = 0; corner < 8; ++corner)
        mesh.m_vertices.push_back(scaled(size, {corner & 1 ? .5 : -.5, corner & 2 ? .5 : -.5, corner & 4 ? .5 : -.5}));
    mesh.m_triangles.assign(sides, sides + 12);
    return mesh;
}

struct Ring
{
    double m_radius, m_y;
};

/// A surface of revolution through rings about y, lowest first, closed by flat or pointed ends.
SurfaceMesh turned(const std::vector<Ring>& rings)
{
    SurfaceMesh mesh;
    const int count = static_cast<int>(rings.size());
    for (const Ring& ring : rings)
        for (int k = 0; k < kSegments; ++k)
        {
            const double angle = 2 * kPi * k / kSegments;
            mesh.m_vertices.push_back({ring.m_radius * std::cos(angle), ring.m_y, ring.m_radius * std::sin(angle)});
        }
    const int lower = static_cast<int>(mesh.m_vertices.size()), upper = lower + 1;
    mesh.m_vertices.push_back({0, rings.front().m_y, 0});
    mesh.m_vertices.push_back({0, rings.back().m_y, 0});
    for (int k = 0; k < kSegments; ++k)
    {
        const int next = (k + 1) % kSegments;
        for (int r = 0; r + 1 < count; ++r)
        {
            const int a = r * kSegments + k, b = r * kSegments + next, c = a + kSegments, d = b + kSegments;
            mesh.m_triangles.push_back({a, c, b});
            mesh.m_triangles.push_back({b, c, d});
        }
        mesh.m_triangles.push_back({lower, k, next});
        mesh.m_triangles.push_back({upper, (count - 1) * kSegments + next, (count - 1) * kSegments + k});
    }
    return mesh;
}

/// A ball, or a capsule with a cylinder of `height` between hemispheres.
SurfaceMesh roundSurface(double radius, double height)
{
    std::vector<Ring> rings;
    for (int half = 0; half < 2; ++half)
        for (int r = 0; r < kRings; ++r)
        {
            const double latitude = 0.5 * kPi * (half ? r : r - kRings + 1) / kRings;
            rings.push_back({radius * std::cos(latitude), radius * std::sin(latitude) + (half ? 0.5 : -0.5) * height});
        }
    if (height <= 0) rings.erase(rings.begin() + kRings);  // removes the duplicate equator
    rings.insert(rings.begin(), {radius * 1e-3, -radius - 0.5 * height});
    rings.push_back({radius * 1e-3, radius + 0.5 * height});
    return turned(rings);
}

}  // namespace

std::unique_ptr<btCollisionShape> makeShape(const SceneShape& shape)
{
    const btScalar radius = btScalar(shape.m_radius), height = btScalar(shape.m_height);
    switch (shape.m_kind)
    {
        case SceneShape::Kind::plane:
            return std::make_unique<btStaticPlaneShape>(bulletVector(shape.m_size).normalized(), btScalar(0));
        case SceneShape::Kind::sphere:
            return std::make_unique<btSphereShape>(radius);
        case SceneShape::Kind::cylinder:
            return std::make_unique<btCylinderShape>(btVector3(radius, height / 2, radius));
        case SceneShape::Kind::capsule:
            return std::make_unique<btCapsuleShape>(radius, height);
        default:
            return std::make_unique<btBoxShape>(bulletVector(0.5 * shape.m_size));
    }
}

SurfaceMesh drawnShape(const SceneShape& shape)
{
    switch (shape.m_kind)
    {
        case SceneShape::Kind::plane:
            return {};
        case SceneShape::Kind::sphere:
            return roundSurface(shape.m_radius, 0);
        case SceneShape::Kind::cylinder:
            return turned({{shape.m_radius, -0.5 * shape.m_height}, {shape.m_radius, 0.5 * shape.m_height}});
        case SceneShape::Kind::capsule:
            return roundSurface(shape.m_radius, shape.m_height);
        default:
            return boxSurface(shape.m_size);
    }
}

}  // namespace bullet_fem
