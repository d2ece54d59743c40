// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "demos/common/demo_surfaces.h"

#include <cmath>

#include "LinearMath/btConvexHullComputer.h"
#include "bullet_fem/btFemVectors.h"

namespace bullet_fem
{
namespace
{

constexpr int kSegments = 32, kRings = 8;  // segments around an axis, rings from pole to equator

/// Appends points on a hemisphere about `centre`, the upper or the lower one along y.
void appendHalfBall(const btVector3& centre, btScalar radius, bool upper, std::vector<btVector3>& points)
{
    for (int ring = 0; ring <= kRings; ++ring)
        for (int k = 0; k < (ring == kRings ? 1 : kSegments); ++k)
        {
            const btScalar latitude = SIMD_HALF_PI * btScalar(ring) / kRings,
                           angle = SIMD_2_PI * btScalar(k) / kSegments;
            const btScalar flat = radius * btCos(latitude), height = radius * btSin(latitude);
            points.push_back(centre + btVector3(flat * btCos(angle), upper ? height : -height, flat * btSin(angle)));
        }
}

/// Extreme points of a convex shape: its vertices, or sample points on curved shapes.
std::vector<btVector3> pointsOf(const btConvexShape& shape)
{
    std::vector<btVector3> points;
    if (shape.getShapeType() == SPHERE_SHAPE_PROXYTYPE)
        for (const bool upper : {false, true})
            appendHalfBall({0, 0, 0}, static_cast<const btSphereShape&>(shape).getRadius(), upper, points);
    else if (shape.getShapeType() == CAPSULE_SHAPE_PROXYTYPE)
    {
        const auto& capsule = static_cast<const btCapsuleShape&>(shape);
        for (const bool upper : {false, true})
            appendHalfBall({0, upper ? capsule.getHalfHeight() : -capsule.getHalfHeight(), 0}, capsule.getRadius(),
                           upper, points);
        if (capsule.getUpAxis() != 1)
            for (btVector3& p : points) std::swap(p[1], p[capsule.getUpAxis()]);
    }
    else if (shape.getShapeType() == CYLINDER_SHAPE_PROXYTYPE)
    {
        const auto& cylinder = static_cast<const btCylinderShape&>(shape);
        const int axis = cylinder.getUpAxis(), a = (axis + 1) % 3, b = (axis + 2) % 3;
        const btVector3 half = cylinder.getHalfExtentsWithMargin();
        for (int k = 0; k < 2 * kSegments; ++k)
        {
            btVector3 p;
            p[axis] = k % 2 ? half[axis] : -half[axis];
            p[a] = half[a] * btCos(SIMD_2_PI * btScalar(k / 2) / kSegments);
            p[b] = half[a] * btSin(SIMD_2_PI * btScalar(k / 2) / kSegments);
            points.push_back(p);
        }
    }
    else if (shape.isPolyhedral())
        for (int i = 0; i < static_cast<const btPolyhedralConvexShape&>(shape).getNumVertices(); ++i)
        {
            btVector3 p;
            static_cast<const btPolyhedralConvexShape&>(shape).getVertex(i, p);
            points.push_back(p);
        }
    return points;
}

}  // namespace

DemoSurfaces::Shape DemoSurfaces::makeShape(const btCollisionShape& shape)
{
    Shape made;
    if (shape.isCompound())
    {
        const auto& compound = static_cast<const btCompoundShape&>(shape);
        for (int child = 0; child < compound.getNumChildShapes(); ++child)
        {
            const Shape part = makeShape(*compound.getChildShape(child));
            const int first = static_cast<int>(made.m_points.size());
            for (const Vec3& p : part.m_points)
                made.m_points.push_back(vec3(compound.getChildTransform(child) * bulletVector(p)));
            for (const Triangle& t : part.m_triangles)
                made.m_triangles.push_back({first + t[0], first + t[1], first + t[2]});
        }
    }
    else if (shape.isConvex())
    {
        const std::vector<btVector3> points = pointsOf(static_cast<const btConvexShape&>(shape));
        btConvexHullComputer hull;
        if (points.size() > 3)
            hull.compute(&points[0].x(), sizeof(btVector3), static_cast<int>(points.size()), btScalar(0), btScalar(0));
        for (int i = 0; i < hull.vertices.size(); ++i) made.m_points.push_back(vec3(hull.vertices[i]));
        for (int face = 0; face < hull.faces.size(); ++face)
        {
            const btConvexHullComputer::Edge* first = &hull.edges[hull.faces[face]];
            for (const auto* e = first->getNextEdgeOfFace(); e->getTargetVertex() != first->getSourceVertex();
                 e = e->getNextEdgeOfFace())
                made.m_triangles.push_back({first->getSourceVertex(), e->getSourceVertex(), e->getTargetVertex()});
        }
    }
    else if (shape.getShapeType() != STATIC_PLANE_PROXYTYPE && shape.isConcave())
    {
        struct Triangles : btTriangleCallback
        {
            Shape* m_made;
            void processTriangle(btVector3* triangle, int, int) override
            {
                const int first = static_cast<int>(m_made->m_points.size());
                for (int a = 0; a < 3; ++a) m_made->m_points.push_back(vec3(triangle[a]));
                m_made->m_triangles.push_back({first, first + 1, first + 2});
            }
        } triangles;
        triangles.m_made = &made;
        const btVector3 far(BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT);
        static_cast<const btConcaveShape&>(shape).processAllTriangles(&triangles, -far, far);
    }
    return made;
}

const DemoSurfaces::Shape& DemoSurfaces::shapeOf(const btCollisionShape& shape)
{
    const auto [known, isNew] = m_shapes.try_emplace(&shape);
    if (isNew) known->second = makeShape(shape);
    return known->second;
}

void DemoSurfaces::update(const std::vector<const btDynamicsWorld*>& worlds)
{
    m_frames.clear();
    m_objects.clear();
    m_ground = nullptr;
    int id = 0;
    for (const btDynamicsWorld* world : worlds)
        for (int k = 0; k < world->getNumCollisionObjects(); ++k) append(*world->getCollisionObjectArray()[k], id++);
}

void DemoSurfaces::append(const btCollisionObject& object, int id)
{
    BodyFrame frame;
    frame.m_id = id;
    if (const btSoftBody* body = btSoftBody::upcast(&object))
    {
        const bool follows = body->m_renderFaces.size() > 0;
        for (int i = 0; i < (follows ? body->m_renderNodes.size() : body->m_nodes.size()); ++i)
            frame.m_positions.push_back(vec3(follows ? body->m_renderNodes[i].m_x : body->m_nodes[i].m_x));
        for (int t = 0; t < (follows ? body->m_renderFaces.size() : body->m_faces.size()); ++t)
        {
            Triangle triangle;
            for (int a = 0; a < 3; ++a)
                triangle[a] = static_cast<int>(follows ? body->m_renderFaces[t].m_n[a] - &body->m_renderNodes[0]
                                                       : body->m_faces[t].m_n[a] - &body->m_nodes[0]);
            frame.m_triangles.push_back(triangle);
        }
    }
    else
    {
        const btCollisionShape& shape = *object.getCollisionShape();
        if (shape.getShapeType() == STATIC_PLANE_PROXYTYPE && !m_ground) m_ground = &object;
        const Shape& surface = shapeOf(shape);
        for (const Vec3& p : surface.m_points)
            frame.m_positions.push_back(vec3(object.getWorldTransform() * bulletVector(p)));
        frame.m_triangles = surface.m_triangles;
    }
    if (frame.m_triangles.empty()) return;
    m_frames.push_back(std::move(frame));
    m_objects.push_back(&object);
}

}  // namespace bullet_fem
