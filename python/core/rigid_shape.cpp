// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "python/core/rigid_shape.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "BulletCollision/CollisionShapes/btTriangleMesh.h"
#include "LinearMath/btConvexHullComputer.h"
#include "btBulletDynamicsCommon.h"
#include "bullet_fem/btFemVectors.h"
#include "tools/scene/scene_shapes.h"

namespace bullet_fem::python
{
namespace
{

constexpr double kMarginShare = 0.01;  // of a hull's size: Bullet's .04 m are more than some hulls

SurfaceMesh surfaceOf(const btConvexHullComputer& hull)
{
    SurfaceMesh surface;
    for (int i = 0; i < hull.vertices.size(); ++i) surface.m_vertices.push_back(vec3(hull.vertices[i]));
    for (int face = 0; face < hull.faces.size(); ++face)
    {
        const btConvexHullComputer::Edge* first = &hull.edges[hull.faces[face]];
        const btConvexHullComputer::Edge* edge = first->getNextEdgeOfFace();
        for (; edge->getTargetVertex() != first->getSourceVertex(); edge = edge->getNextEdgeOfFace())
            surface.m_triangles.push_back({first->getSourceVertex(), edge->getSourceVertex(), edge->getTargetVertex()});
    }
    return surface;
}

}  // namespace

RigidShape RigidShape::primitive(const SceneShape& from)
{
    RigidShape shape;
    shape.m_shape = makeShape(from);
    shape.m_drawn = drawnShape(from);
    shape.m_isStaticOnly = from.m_kind == SceneShape::Kind::plane;
    return shape;
}

RigidShape RigidShape::hull(const std::vector<Vec3>& points)
{
    if (points.size() < 4)
        throw std::invalid_argument("points has " + std::to_string(points.size()) + " rows: a hull needs at least 4");
    btConvexHullComputer hull;
    hull.compute(&points[0].x, sizeof(Vec3), int(points.size()), 0, 0);
    RigidShape shape;
    shape.m_drawn = surfaceOf(hull);
    if (!(std::abs(signedVolume(shape.m_drawn)) > 0))
        throw std::invalid_argument("points lie in a plane: their hull has no volume");
    auto convex = std::make_shared<btConvexHullShape>();
    for (int i = 0; i < hull.vertices.size(); ++i) convex->addPoint(hull.vertices[i], false);
    convex->setMargin(btScalar(kMarginShare * std::cbrt(std::abs(signedVolume(shape.m_drawn)))));
    convex->recalcLocalAabb();
    shape.m_shape = std::move(convex);
    return shape;
}

RigidShape RigidShape::mesh(SurfaceMesh surface)
{
    if (surface.m_triangles.empty()) throw std::invalid_argument("triangles is empty: a mesh needs at least one");
    RigidShape shape;
    shape.m_triangles = std::make_shared<btTriangleMesh>();
    for (const Triangle& triangle : surface.m_triangles)
        shape.m_triangles->addTriangle(bulletVector(surface.m_vertices[std::size_t(triangle[0])]),
                                       bulletVector(surface.m_vertices[std::size_t(triangle[1])]),
                                       bulletVector(surface.m_vertices[std::size_t(triangle[2])]));
    shape.m_shape = std::make_shared<btBvhTriangleMeshShape>(shape.m_triangles.get(), true);
    shape.m_shape->setMargin(0);  // Bullet's .04 m would be a gap below rigid bodies
    shape.m_drawn = std::move(surface);
    shape.m_isStaticOnly = true;
    return shape;
}

RigidShape RigidShape::compound(std::vector<Part> parts)
{
    if (parts.empty()) throw std::invalid_argument("parts is empty: a compound needs at least one");
    RigidShape shape;
    auto compound = std::make_shared<btCompoundShape>();
    for (const Part& part : parts)
    {
        if (part.m_shape->isStaticOnly())
            throw std::invalid_argument("a plane or a mesh cannot be a part of a compound: make it a body of its own");
        compound->addChildShape(part.m_pose, part.m_shape->shape());
        const int offset = int(shape.m_drawn.m_vertices.size());
        for (const Vec3& vertex : part.m_shape->drawn().m_vertices)
            shape.m_drawn.m_vertices.push_back(vec3(part.m_pose * bulletVector(vertex)));
        for (const Triangle& t : part.m_shape->drawn().m_triangles)
            shape.m_drawn.m_triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
    }
    shape.m_shape = std::move(compound);
    shape.m_parts = std::move(parts);
    return shape;
}

RigidShape RigidShape::drawnOnly(const SceneShape& from)
{
    RigidShape shape;
    shape.m_drawn = drawnShape(from);
    return shape;
}

}  // namespace bullet_fem::python
