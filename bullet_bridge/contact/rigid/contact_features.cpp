// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/rigid/contact_features.h"

#include <algorithm>
#include <limits>

#include "BulletCollision/CollisionDispatch/btCollisionObject.h"
#include "bullet_bridge/contact/contact_reduction.h"

namespace bullet_fem
{
namespace
{

// Up to which sine neighbours may lie below a lowest node: the edge of a blade bends [-].
constexpr double kLowestSine = 0.05;

int triangleOfCorner(const FemSoftBody& fem, int feature)
{
    return (feature - firstCornerFeature(fem)) / kMaxCorners;
}

// The body's first contact of an origin in the last step that `is` accepts, or null.
template <class Is>
const ContactPoint* lastContact(const FemSoftBody& fem, const ContactOrigin& origin, const Is& is)
{
    const std::vector<ContactOrigin>& origins = fem.m_memory.m_origins;
    const auto [first, last] = std::equal_range(origins.begin(), origins.end(), origin);
    const auto contactOf = [&](const ContactOrigin& old) { return &fem.m_memory.m_contacts[&old - origins.data()]; };
    const auto found = std::find_if(first, last, [&](const ContactOrigin& old) { return is(*contactOf(old)); });
    return found == last ? nullptr : contactOf(*found);
}

}  // namespace

int firstCornerFeature(const FemSoftBody& fem)
{
    const SurfaceTopology& topology = fem.m_surface.topology();
    return topology.vertexCount() + 2 * (topology.edgeCount() + topology.triangleCount());
}

bool isFixedPoint(const FemSoftBody& fem, const ContactTarget& target, int feature)
{
    const int vertexCount = fem.m_surface.topology().vertexCount();
    if (feature < vertexCount) return true;
    if (target.m_kind == TargetKind::sheets || feature >= firstCornerFeature(fem)) return false;
    return (feature - vertexCount) % 2 == 0;
}

Triangle cornersOf(const FemSoftBody& fem, const ContactTarget& target, int feature)
{
    const SurfaceTopology& topology = fem.m_surface.topology();
    const bool areSheets = target.m_kind == TargetKind::sheets;
    const int vertexCount = topology.vertexCount(), edgeCount = topology.edgeCount();
    if (feature < vertexCount) return {feature, feature, feature};
    if (!areSheets && feature >= firstCornerFeature(fem)) return topology.triangles()[triangleOfCorner(fem, feature)];
    const int k = areSheets ? feature - vertexCount : (feature - vertexCount) / 2;
    const int edge = areSheets ? k - topology.triangleCount() : k;
    if (edge >= 0 && edge < edgeCount)
    {
        const auto [a, b] = topology.edges()[edge];
        return {a, b, a};
    }
    return topology.triangles()[areSheets ? k : k - edgeCount];
}

bool areOverOneFace(const FemSoftBody& fem, int a, int b)
{
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    return fem.m_search.m_nodeGap[a] < kInfinity && fem.m_search.m_nodeGap[b] < kInfinity &&
           dot(fem.m_search.m_nodeNormal[a], fem.m_search.m_nodeNormal[b]) > 1 - 1e-9;
}

bool faces(const FemSoftBody& fem, const Triangle& nodes, const Vec3& normal)
{
    const std::vector<Vec3>& x = fem.surfacePosition();
    const SurfaceTopology& topology = fem.m_surface.topology();
    const Vec3 along = unit(x[nodes[1]] - x[nodes[0]]);
    Vec3 mean;
    bool isLowest = true;
    for (int k : topology.trianglesAt(nodes[0]))
    {
        const Triangle& t = topology.triangles()[k];
        const auto has = [&t](int node) { return t[0] == node || t[1] == node || t[2] == node; };
        if (!has(nodes[1]) || !has(nodes[2])) continue;
        const Vec3 area = cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]]);
        if (dot(area, normal) < kOpposedCosine * norm(area)) return true;
        mean += area;
        for (int corner : t)
        {
            const Vec3 way = x[corner] - x[nodes[0]], across = way - dot(way, along) * along;
            isLowest = isLowest && dot(across, normal) >= -kLowestSine * norm(across);
        }
    }
    return dot(mean, normal) <= (isLowest ? 0 : kOpposedCosine) * norm(mean);
}

ContactOrigin originOf(const ContactTarget& target, int feature)
{
    const btCollisionObject* object = target.m_object;
    return {object, broadphaseId(*object), target.m_leaf, feature};
}

const ContactPoint* deepContact(const FemSoftBody& fem, const ContactOrigin& origin)
{
    return lastContact(fem, origin, [](const ContactPoint& contact) { return contact.m_gap < 0; });
}

const ContactPoint* pushingContact(const FemSoftBody& fem, const ContactOrigin& origin)
{
    return lastContact(fem, origin, isPushing);
}

}  // namespace bullet_fem
