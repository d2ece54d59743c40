// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <algorithm>
#include <limits>
#include <optional>

#include "BulletCollision/CollisionDispatch/btCollisionObject.h"
#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body/contact_patch.h"
#include "bullet_bridge/contact/rigid/contact_finder.h"
#include "bullet_bridge/geometry/shapes/field_distance.h"
#include "bullet_fem/bullet_bridge/vectors.h"
#include "bullet_fem/fem/step/stepping.h"

namespace bullet_fem
{
namespace
{

constexpr double kRollingGap = 0.1;  // largest approach of a rolling contact within a step, over the body's size
constexpr double kGrazing = 1e-3;  // clearance up to which paths still meet, as along the rim of a face, over the mean
                                   // edge
constexpr double kSameSideCosine = 0.9;  // smallest cosine between the normal of the nearest point and that of the
                                         // meeting point
constexpr double kNever = std::numeric_limits<double>::infinity();

/// Speed that gravity adds in a step [m/s]. It does not count as motion: resting bodies have it as well.
double fallingSpeed(const FemSoftBody& fem, double step)
{
    return step * norm(fem.gravity());
}

}  // namespace

SweptShape ContactFinder::sweptShapeOf(const Target& target)
{
    const RigidProxy& motion = *target.m_motion;
    return SweptShape(*target.m_shape, {motion.m_center, motion.m_linearVelocity, motion.m_angularVelocity},
                      target.m_step);
}

bool ContactFinder::isFastTarget(const FemSoftBody& fem, const Target& target) const
{
    const SweptShape swept = sweptShapeOf(target);
    const double edge = fem.m_body.m_model->mesh().meanEdgeLength();  // as in RigidProxies
    const double falling = 2 * fallingSpeed(fem, target.m_step);
    // cheap upper bound first
    return isFast(swept, m_fastest + norm(swept.m_motion.m_linearVelocity) - falling, edge) &&
           isFast(swept, fastestNode(fem.m_body, swept.m_motion.m_linearVelocity) - falling, edge);
}

// Contacts of a fast target as the step begins: nodes only; edges and triangles are searched on their paths.
void ContactFinder::findTouchingNodes(FemSoftBody& fem, const Target& target)
{
    const double reach = m_band + fem.m_contactOffset;
    if (!m_culling.meets({target.m_shape->m_boundsMin, target.m_shape->m_boundsMax, reach})) return;
    for (int i : fem.m_surface.nodes())
    {
        const Vec3& x = fem.surfacePosition()[i];
        SurfaceDistance d;
        if (!m_culling.noteVertex(i, x, x) || !pointShapeDistance(*target.m_shape, x, reach, d)) continue;
        d.m_gap -= fem.m_contactOffset;
        const Vec3 relative = fem.surfaceVelocity()[i] - target.m_motion->velocityAt(x);
        const double closest = d.m_gap + target.m_step * dot(d.m_normal, relative) - norm(target.m_fall);
        const bool parts = d.m_gap > 0 && closest > m_band;
        if (d.m_gap <= m_band && !parts) consider(fem, target, i, {i, i, i}, d);
    }
}

// Appends the contacts of a target: those near it that are not flush, and those that the surface meets on its path,
// which its carriers limit.
void ContactFinder::findWithinStep(FemSoftBody& fem, const Target& target)
{
    if (target.m_kind == TargetKind::fast) return findOnPaths(fem, target);
    if (target.m_kind == TargetKind::sheets) return findOnSheetPaths(fem, target);
    const bool hasInside = isSolid(*target.m_shape->m_shape);
    std::optional<SweptShape> swept;
    for (std::size_t k = target.m_first; k < target.m_end; ++k)
    {
        if (!hasInside || m_near[k].m_gap <= m_band)
        {
            keepNear(k);
            continue;
        }
        if (!swept) swept.emplace(sweptShapeOf(target));
        const int feature = m_nearOrigins[k].m_feature;
        const Triangle corners = cornersOf(fem, target, feature);
        SweptContact contact;
        if (!meets(fem, {target, *swept, 0, kGrazing * m_edge}, corners, contact)) continue;
        if (dot(contact.m_surface.m_normal, m_near[k].m_normal) > kSameSideCosine)
            keepNear(k);
        else
            keep(fem, target, feature, corners, contact.m_surface);
    }
}

// Keeps a contact found near, unless it is flush.
void ContactFinder::keepNear(std::size_t k)
{
    if (m_flush[k]) return;
    m_contacts.push_back(m_near[k]);
    m_origins.push_back(m_nearOrigins[k]);
}

// Displacement by gravity within the step, 0 for objects that cannot move or fall little.
Vec3 ContactFinder::fallOf(const FemSoftBody& fem, const Target& target)
{
    const Vec3 gravity = fem.gravity();
    if (!target.m_motion->canMove() || !isFinite(gravity)) return {};
    const double edge = fem.m_body.m_model->mesh().meanEdgeLength();  // as in RigidProxies
    return fallsFar(sweptShapeOf(target), norm(gravity), edge) ? target.m_step * target.m_step * gravity : Vec3();
}

// Path of a feature within the step: a vertex with carriers starts lifted off them, and does not enter them. `held`:
// velocity to be added to the free one [m/s].
SweptFeature ContactFinder::pathOf(const FemSoftBody& fem, const Triangle& nodes, const Vec3& held, double step) const
{
    SweptFeature path;
    path.m_count = nodes[1] == nodes[0] ? 1 : nodes[2] == nodes[0] ? 2 : 3;
    for (int i = 0; i < path.m_count; ++i)
    {
        path.m_position[i] = fem.surfacePosition()[nodes[i]];
        path.m_velocity[i] = fem.surfaceVelocity()[nodes[i]] + held;
        if (!m_carried.isCarried(nodes[i])) continue;
        path.m_position[i] += m_carried.liftOf(nodes[i]);
        path.m_velocity[i] = m_carried.allowed(nodes[i], step * path.m_velocity[i]) * (1 / step);
    }
    return path;
}

// Finds contacts on paths. Nodes come first; a point of an edge or triangle counts only if it is met before all of the
// feature's corners and edges.
void ContactFinder::findOnPaths(FemSoftBody& fem, const Target& target)
{
    const SweptShape swept = sweptShapeOf(target);
    const double spin = norm(swept.m_motion.m_angularVelocity) * swept.m_spinRadius;
    const double fall = norm(target.m_fall);
    const double fastest = fastestVertex(fem, swept.m_motion.m_linearVelocity) + fall / target.m_step;
    const PathSearch search = {target, swept, fastest + spin, 0};
    m_culling.meets({swept.m_boundsMin, swept.m_boundsMax, fem.m_contactOffset + fall});
    std::size_t near = target.m_first;
    for (int i : fem.m_surface.nodes())
    {
        const SweptFeature path = pathOf(fem, {i, i, i}, {}, target.m_step);
        m_culling.noteVertex(i, path.m_position[0], path.m_position[0] + target.m_step * path.m_velocity[0]);
        fem.m_nodeGap[i] = kNever;
        if (near < target.m_end && m_nearOrigins[near].m_feature == i)
        {
            const ContactPoint& contact = m_near[near];
            fem.m_nodeNormal[i] = contact.m_normal;
            if (!m_flush[near])
            {
                fem.m_nodeGap[i] = contact.m_gap / search.m_speed;
                keepNear(near);
            }
            ++near;
            continue;
        }
        if (!m_culling.isOutside({i, i, i})) fem.m_nodeGap[i] = considerPath(fem, search, i, {i, i, i}, kNever);
    }
    const int edgeCount = static_cast<int>(fem.m_surface.features().m_edges.size());
    int firstFeature = fem.m_surface.vertexCount() + 1;  // the features of nearest points have odd numbers
    for (int k = 0; k < edgeCount; ++k)
    {
        const auto [a, b] = fem.m_surface.features().m_edges[k];
        fem.m_edgeGap[k] = std::min(fem.m_nodeGap[a], fem.m_nodeGap[b]);
        if (!overOneFace(fem, a, b) && !m_culling.isOutside({a, b, a}))
            fem.m_edgeGap[k] = considerPath(fem, search, firstFeature + 2 * k, {a, b, a}, fem.m_edgeGap[k]);
    }
    const int triangleCount = static_cast<int>(fem.m_surface.triangles().size());
    firstFeature += 2 * edgeCount;
    for (int k = 0; k < triangleCount; ++k)
    {
        const Triangle& t = fem.m_surface.triangles()[k];
        if (m_culling.isOutside(t) || (overOneFace(fem, t[0], t[1]) && overOneFace(fem, t[0], t[2]))) continue;
        double earliest = kNever;
        for (int a = 0; a < 3; ++a)
            earliest = std::min(
                {earliest, fem.m_nodeGap[t[a]], fem.m_edgeGap[fem.m_surface.features().m_triangleEdges[k][a]]});
        considerPath(fem, search, firstFeature + 2 * k, t, earliest);
    }
}

// True if a node (three equal indices), edge (first and last equal) or triangle meets a target within the step, in free
// motion or with the fall of one side removed. Pairs that overlap as the step begins met before it.
bool ContactFinder::meets(const FemSoftBody& fem, const PathSearch& search, const Triangle& nodes,
                          SweptContact& contact) const
{
    const Vec3 given = (1 / search.m_target.m_step) * search.m_target.m_fall;
    if (meetsIfHeld(fem, search, nodes, {}, contact)) return true;
    if (norm(given) == 0) return false;
    return meetsIfHeld(fem, search, nodes, -given, contact) || meetsIfHeld(fem, search, nodes, given, contact);
}

bool ContactFinder::meetsIfHeld(const FemSoftBody& fem, const PathSearch& search, const Triangle& nodes,
                                const Vec3& held, SweptContact& contact) const
{
    const SweptFeature path = pathOf(fem, nodes, held, search.m_target.m_step);
    const double offset = fem.m_contactOffset + search.m_clearance;
    if (!mayMeet(search.m_swept, path, offset) || !sweptDistance(search.m_swept, path, offset, contact)) return false;
    SurfaceDistance& d = contact.m_surface;
    d.m_gap += search.m_clearance;
    if (search.m_target.m_carrying->m_exists && contact.m_time > 0 && !faces(fem, nodes, d.m_normal)) return false;
    for (int i = 0; i < path.m_count; ++i)
        d.m_gap -= d.m_barycentric[i] * dot(d.m_normal, path.m_position[i] - fem.surfacePosition()[nodes[i]]);
    const Vec3 point = interpolated(fem.surfacePosition(), nodes, d.m_barycentric);
    if (isBesideCarryingPlane(search.m_target, point, d.m_normal, d.m_gap)) return false;
    if (search.m_target.m_carrying->m_exists && dot(d.m_normal, search.m_target.m_carrying->m_normal) > kSameSideCosine)
        d.m_normal = search.m_target.m_carrying->m_normal;
    return true;
}

// Keeps the first point of a feature that is met, if that is before `earliest` [s]. Overlapping points count as met
// earlier the deeper they are. Returns the earlier of the two times.
double ContactFinder::considerPath(FemSoftBody& fem, const PathSearch& search, int feature, const Triangle& nodes,
                                   double earliest)
{
    SweptContact contact;
    if (!meets(fem, search, nodes, contact)) return earliest;
    const double time = contact.m_time > 0 ? contact.m_time : contact.m_surface.m_gap / search.m_speed;
    if (feature < fem.m_surface.vertexCount()) fem.m_nodeNormal[nodes[0]] = contact.m_surface.m_normal;
    if (time < earliest - m_advantage / search.m_speed)
        if (ContactPoint* kept = keep(fem, search.m_target, feature, nodes, contact.m_surface))
            setLevers(fem, search.m_target, feature, contact, *kept);
    return std::min(time, earliest);
}

// Sets the levers of a contact that is met later in the step to its place at that time. A nearby rolling contact has
// one lever for both sides, which conserves angular momentum; a contact of far motion has one for each side.
void ContactFinder::setLevers(const FemSoftBody& fem, const Target& target, int feature, const SweptContact& met,
                              ContactPoint& contact) const
{
    const bool isNode = feature < fem.m_surface.vertexCount();
    if (isNode) contact.m_patch = patchOf(fem, target, feature, contact.m_normal, met.m_time);
    if (isNode && contact.m_gap < kRollingGap * m_size && roundness(fem.m_surface.curvature(feature), m_size) > 0)
        return;
    contact.m_isMetLater = true;
    contact.m_approach += met.m_arm - (contact.m_point + contact.m_patch - target.m_motion->m_center);
}

}  // namespace bullet_fem
