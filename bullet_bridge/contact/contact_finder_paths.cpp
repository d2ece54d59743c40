// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <algorithm>
#include <limits>

#include "BulletCollision/CollisionDispatch/btCollisionObject.h"
#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/contact/contact_finder.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/step/stepping.h"

namespace bullet_fem
{
namespace
{

constexpr double kNever = std::numeric_limits<double>::infinity();

/// Kinematic objects have moved already.
SweptShape pathOf(const ShapeLeaf& leaf, const RigidProxy& rigidProxy, double step, bool moved)
{
    RigidMotion motion = {rigidProxy.m_center, rigidProxy.m_linearVelocity, rigidProxy.m_angularVelocity};
    if (!moved) return SweptShape(leaf, motion, step);
    const ShapeLeaf start = movedBack(leaf, motion, step);
    motion.m_center -= step * motion.m_linearVelocity;
    return SweptShape(start, motion, step);
}

/// What gravity gives in a step is not speed: resting bodies have it as well.
double fallingSpeed(const FemSoftBody& fem, double step)
{
    return step * norm(fem.gravity());
}

}  // namespace

// False, with nothing found, if the two do not move far. Nodes first; of edges and triangles only those points that are
// met before all their corners and edges.
bool ContactFinder::findOnPaths(FemSoftBody& fem, const Target& target)
{
    const SweptShape swept =
        pathOf(target.m_shape, target.m_rigidProxy, target.m_step, target.m_leaf.m_object->isKinematicObject());
    const double edge = fem.m_body.m_model->mesh().meanEdgeLength();  // as RigidProxies decides
    const double falling = 2 * fallingSpeed(fem, target.m_step);
    if (!isFast(swept, m_fastest + norm(swept.m_motion.m_linearVelocity) - falling, edge)) return false;  // at most
    const double nodeSpeed = fastestNode(fem.m_body, swept.m_motion.m_linearVelocity);
    if (!isFast(swept, nodeSpeed - falling, edge)) return false;

    const double speed = fastestVertex(fem, swept.m_motion.m_linearVelocity);
    const double spin = norm(swept.m_motion.m_angularVelocity) * swept.m_spinRadius;
    const PathSearch search = {fem, target, swept, speed + spin};
    m_culling.meets({swept.m_boundsMin, swept.m_boundsMax, fem.m_contactOffset});
    for (int i : fem.m_surface.nodes())
    {
        const Vec3& x = fem.surfacePosition()[i];
        m_culling.noteVertex(i, x, x + target.m_step * fem.surfaceVelocity()[i]);
        fem.m_nodeGap[i] = considerPath(search, i, {i, i, i}, kNever);
    }
    const int edgeCount = static_cast<int>(fem.m_surface.features().m_edges.size());
    int firstFeature = fem.m_surface.vertexCount() + 1;  // ids are those of nearest points
    for (int k = 0; k < edgeCount; ++k)
    {
        const auto [a, b] = fem.m_surface.features().m_edges[k];
        fem.m_edgeGap[k] = std::min(fem.m_nodeGap[a], fem.m_nodeGap[b]);
        if (!overOneFace(fem, a, b))
            fem.m_edgeGap[k] = considerPath(search, firstFeature + 2 * k, {a, b, a}, fem.m_edgeGap[k]);
    }
    const int triangleCount = static_cast<int>(fem.m_surface.triangles().size());
    firstFeature += 2 * edgeCount;
    for (int k = 0; k < triangleCount; ++k)
    {
        const Triangle& t = fem.m_surface.triangles()[k];
        if (overOneFace(fem, t[0], t[1]) && overOneFace(fem, t[0], t[2])) continue;
        double earliest = kNever;
        for (int a = 0; a < 3; ++a)
            earliest = std::min(
                {earliest, fem.m_nodeGap[t[a]], fem.m_edgeGap[fem.m_surface.features().m_triangleEdges[k][a]]});
        considerPath(search, firstFeature + 2 * k, t, earliest);
    }
    return true;
}

// Keeps the first point of a node (all three the same), edge (first and last the same) or triangle that is met, if this
// is before `earliest` [s]; what overlaps already was met before the step, the sooner the deeper. Returns the earlier
// of the two times.
double ContactFinder::considerPath(const PathSearch& search, int feature, const Triangle& nodes, double earliest)
{
    FemSoftBody& fem = search.m_fem;
    if (m_culling.isOutside(nodes)) return earliest;
    SweptFeature path;
    path.m_count = nodes[1] == nodes[0] ? 1 : nodes[2] == nodes[0] ? 2 : 3;
    for (int i = 0; i < path.m_count; ++i)
    {
        path.m_position[i] = fem.surfacePosition()[nodes[i]];
        path.m_velocity[i] = fem.surfaceVelocity()[nodes[i]];
    }
    SweptContact contact;
    if (!mayMeet(search.m_swept, path, fem.m_contactOffset) ||
        !sweptDistance(search.m_swept, path, fem.m_contactOffset, contact))
        return earliest;
    const double time = contact.m_time > 0 ? contact.m_time : contact.m_surface.m_gap / search.m_speed;
    if (path.m_count == 1) fem.m_nodeNormal[nodes[0]] = contact.m_surface.m_normal;
    if (time < earliest - m_advantage / search.m_speed)
        if (ContactPoint* kept = keep(fem, search.m_target, feature, nodes, contact.m_surface))
            kept->m_approach = contact.m_arm - (kept->m_point - search.m_target.m_rigidProxy.m_center);
    return std::min(time, earliest);
}

}  // namespace bullet_fem
