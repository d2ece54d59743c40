// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <algorithm>

#include "BulletCollision/CollisionShapes/btPolyhedralConvexShape.h"
#include "bullet_bridge/contact/rigid/contact_finder.h"
#include "bullet_fem/bullet_bridge/vectors.h"

namespace bullet_fem
{
namespace
{

constexpr int kMostCorners = 32;  // largest number of corners of a shape: each triangle has as many feature numbers

// Distance between a polyhedron's vertices and its surface: the vertices of boxes include the margin, others do not.
double marginOf(const btCollisionShape& shape)
{
    return shape.getShapeType() == BOX_SHAPE_PROXYTYPE ? 0 : double(shape.getMargin());
}

}  // namespace

int ContactFinder::firstCornerFeature(const FemSoftBody& fem)
{
    const SoftSurface& surface = fem.m_surface;
    return surface.vertexCount() + 2 * static_cast<int>(surface.features().m_edges.size() + surface.triangles().size());
}

int ContactFinder::triangleOfCorner(const FemSoftBody& fem, int feature)
{
    return (feature - firstCornerFeature(fem)) / kMostCorners;
}

// Calls use(corner, distance) for the corners of a polyhedral shape that lie over a triangle and within reach.
template <class Use>
void ContactFinder::forEachCornerOver(const FemSoftBody& fem, const Target& target, const Triangle& t,
                                      const Use& use) const
{
    const btCollisionShape& shape = *target.m_shape->m_shape;
    if (!shape.isPolyhedral()) return;
    const auto& polyhedron = static_cast<const btPolyhedralConvexShape&>(shape);
    if (polyhedron.getNumVertices() > kMostCorners) return;
    const std::vector<Vec3>& x = fem.surfacePosition();
    const Corners corners = {x[t[0]], x[t[1]], x[t[2]]};
    const Vec3 normal = unit(cross(corners[1] - corners[0], corners[2] - corners[0]));
    const double distance = marginOf(shape) + fem.m_contactOffset;
    for (int k = 0; k < polyhedron.getNumVertices(); ++k)
    {
        btVector3 vertex;
        polyhedron.getVertex(k, vertex);
        const Vec3 corner = target.m_shape->m_pose.toWorld(vec3(vertex));
        SurfaceDistance d = {dot(normal, corner - corners[0]) - distance, -normal, {}};
        if (!(d.m_gap <= target.m_reach && d.m_gap > -kFeatureDepth * m_edge)) continue;
        if (!projectOnPlane(corners, corner, d.m_barycentric)) return;
        if (std::min({d.m_barycentric[0], d.m_barycentric[1], d.m_barycentric[2]}) >= 0) use(k, d);
    }
}

bool ContactFinder::isUnderCorner(const FemSoftBody& fem, const Target& target, const Triangle& t) const
{
    bool isUnder = false;
    forEachCornerOver(fem, target, t, [&](int, const SurfaceDistance&) { isUnder = true; });
    return isUnder;
}

// Contacts at the corners of a small shape whose face lies between all fixed points of the surface. A single nearest
// point would jump between the corners and tip the shape over.
void ContactFinder::findOnCorners(FemSoftBody& fem, const Target& target)
{
    const int firstFeature = firstCornerFeature(fem);
    for (int triangle : m_lainOn)
    {
        const Triangle& t = fem.m_surface.triangles()[triangle];
        forEachCornerOver(fem, target, t,
                          [&](int corner, const SurfaceDistance& d)
                          { consider(fem, target, firstFeature + kMostCorners * triangle + corner, t, d); });
    }
}

}  // namespace bullet_fem
