// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/rigid/contact_finder.h"

#include <algorithm>
#include <limits>

#include "BulletCollision/CollisionShapes/btCollisionShape.h"
#include "BulletCollision/CollisionShapes/btSphereShape.h"
#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body/contact_patch.h"
#include "bullet_bridge/contact/friction.h"
#include "bullet_bridge/contact/nearest_contacts.h"
#include "bullet_bridge/joints/soft_joints.h"
#include "bullet_fem/fem/step/stepping.h"

namespace bullet_fem
{
namespace
{

constexpr double kContactBand = 0.05;  // width of the contact band over the mean edge [-]
constexpr double kAdvantage = 0.003;   // by which a nearest point must be closer than the fixed points, over the mean
                                       // edge [-]
constexpr double kSlop = 5e-5;         // permitted penetration over the body's size, for objects that cannot move [-]
constexpr double kMovableSlop = 1e-4;  // and for movable objects: position corrections cost angular momentum [-]
constexpr double kRigidStiffness = 1e17;       // Bullet's value for a rigid contact is 1e18 (float) or 1e30 [N/m]
constexpr double kUsualKineticHardness = 0.1;  // Bullet's default of kKHR; those of kCHR and kSHR are 1
constexpr double kLeastLikeness = -2;          // smallest similarity of a contact to one of the last step; 1: equal

// Curvature of a shape [1/m]: that of a sphere; 0 for all other shapes.
double curvatureOf(const ShapeLeaf& leaf)
{
    if (leaf.m_shape->getShapeType() != SPHERE_SHAPE_PROXYTYPE) return 0;
    const double radius = static_cast<const btSphereShape*>(leaf.m_shape)->getRadius();
    return radius > 0 ? 1 / radius : 0;
}

// Upper bound on the speed of an object's points near the body [m/s]: linear velocity plus spin times the leaf's size.
double fastestPoint(const RigidProxy& rigidProxy, const ShapeLeaf& shape)
{
    const double spin = norm(rigidProxy.m_angularVelocity);
    const double size = spin > 0 ? norm(shape.m_boundsMax - shape.m_boundsMin) : 0;  // a plane's would be infinite
    return norm(rigidProxy.m_linearVelocity) + spin * size;
}

// Correction of the gap for rotation [m]: a point of a rotating object moves along an arc, so it comes closer than its
// velocity predicts.
double closedByArc(const RigidProxy& motion, const Vec3& point, const Vec3& normal, double step)
{
    const Vec3 turn = step * motion.m_angularVelocity;
    return 0.5 * dot(normal, cross(turn, cross(turn, point - motion.m_center)));
}

}  // namespace

void recordTouching(FemSoftBody& fem, const btCollisionObject& object)
{
    const std::lock_guard<std::mutex> lock(fem.m_touchingMutex);
    if (std::find(fem.m_touching.begin(), fem.m_touching.end(), &object) == fem.m_touching.end())
        fem.m_touching.push_back(&object);
}

void recordTouching(FemSoftBody& fem, const btSoftBody& other)
{
    const std::lock_guard<std::mutex> lock(fem.m_touchingMutex);
    if (std::find(fem.m_touchingSoft.begin(), fem.m_touchingSoft.end(), &other) == fem.m_touchingSoft.end())
        fem.m_touchingSoft.push_back(&other);
}

ContactSearchReport ContactFinder::find(FemSoftBody& fem, int bodyIndex, const RigidSurroundings& around)
{
    ContactSearchReport report;
    begin(fem, bodyIndex);
    for (int k = 0; k < around.m_count; ++k)
        report.m_unknownShape = around.m_touched[k].m_unknownShape || report.m_unknownShape;
    listTargets(fem, around);
    for (Target& target : m_targets) findNear(fem, target);
    makeRoom();
    m_near.swap(m_contacts);
    m_nearOrigins.swap(m_origins);
    m_nearWeights.swap(m_weights);
    m_contacts.clear();
    m_origins.clear();
    markFlush(fem);
    for (const Target& target : m_targets) findWithinStep(fem, target);
    thin(fem, around);
    report.m_limited = keepNearest(around.m_maxContacts, m_contacts, m_origins, m_order);
    takeOverImpulses(fem);
    fem.m_contacts.assign(m_contacts.begin(), m_contacts.end());
    fem.m_origins.assign(m_origins.begin(), m_origins.end());
    fem.m_sheetSides.assign(m_sheetSides.begin(), m_sheetSides.end());
    return report;
}

// Reserves for contacts that may come, so that steps with no more contacts than before do not allocate.
void ContactFinder::makeRoom()
{
    constexpr std::size_t kLeast = 64;  // contacts
    const std::size_t room = std::max(kLeast, 2 * m_contacts.size());
    for (std::vector<ContactPoint>* points : {&m_contacts, &m_near}) points->reserve(room);
    for (std::vector<ContactOrigin>* origins : {&m_origins, &m_nearOrigins}) origins->reserve(room);
    for (std::vector<Weights>* weights : {&m_weights, &m_nearWeights}) weights->reserve(room);
    m_flush.reserve(room);
    m_targets.reserve(kLeast);
    m_carried.reserve(room);
    m_lainOn.reserve(kLeast);
}

// Bullet has moved kinematic objects already, while their leaves are at the start of the step: moves the proxy back.
const RigidProxy& ContactFinder::asTheStepBegan(const TouchedObject& touched, const RigidSurroundings& around)
{
    const RigidProxy& rigidProxy = around.m_rigidProxies[touched.m_rigidProxy];
    if (!touched.m_object->isKinematicObject()) return rigidProxy;
    m_starts.push_back(rigidProxy);
    m_starts.back().m_center -= around.m_step * rigidProxy.m_linearVelocity;
    return m_starts.back();
}

// Lists all leaves of all objects near the body.
void ContactFinder::listTargets(FemSoftBody& fem, const RigidSurroundings& around)
{
    m_targets.clear();
    m_starts.clear();
    m_starts.reserve(around.m_count);  // m_targets points into it
    if (around.m_count == 0) return;
    fem.updateSkin();
    m_culling.begin(fem.m_surface, fem.surfacePosition());
    m_fastest = fastestNode(fem.m_body, Vec3());
    const double softReach =
        m_band + fem.m_contactOffset + around.m_step * (fem.m_skin ? fastestVertex(fem, Vec3()) : m_fastest);
    for (int k = 0; k < around.m_count; ++k)
    {
        const TouchedObject& touched = around.m_touched[k];
        const RigidProxy& rigidProxy = asTheStepBegan(touched, around);
        const Surface surface = surfaceOf(*fem.m_softBody, *touched.m_object);
        for (int l = 0; l < touched.m_leafCount; ++l)
        {
            const ShapeLeaf& shape = around.m_leaves[touched.m_firstLeaf + l];
            m_targets.push_back({&shape, touched.m_object, l, touched.m_rigidProxy, &rigidProxy,
                                 around.m_rigidProxies[touched.m_rigidProxy].m_center - rigidProxy.m_center, surface,
                                 softReach + around.m_step * fastestPoint(rigidProxy, shape), Vec3(), around.m_step,
                                 &touched.m_carrying, TargetKind::slow, 0, 0, 0, 0});
            m_targets.back().m_fall = fallOf(fem, m_targets.back());
            m_targets.back().m_reach += norm(m_targets.back().m_fall);
        }
    }
}

void ContactFinder::begin(const FemSoftBody& fem, int bodyIndex)
{
    m_contacts.clear();
    m_origins.clear();
    m_weights.clear();
    m_sheetSides.clear();
    m_measured = false;

    m_bodyIndex = bodyIndex;
    m_edge = fem.m_surface.meanEdge();
    m_band = kContactBand * m_edge;
    m_advantage = kAdvantage * m_edge;
    m_size = fem.m_surface.size();
    noteHeld(fem);
}

// Per vertex, the normal of the strongest contact of the last step.
void ContactFinder::noteHeld(const FemSoftBody& fem)
{
    const int vertexCount = fem.m_surface.vertexCount();
    m_heldNormal.assign(vertexCount, Vec3());
    m_heldBy.assign(vertexCount, 0);
    for (std::size_t k = 0; k < fem.m_contacts.size(); ++k)
    {
        const int vertex = fem.m_origins[k].m_feature;
        const double impulse = dot(fem.m_contacts[k].m_impulse, fem.m_contacts[k].m_normal);
        if (vertex >= vertexCount || impulse <= m_heldBy[vertex]) continue;
        m_heldBy[vertex] = impulse;
        m_heldNormal[vertex] = fem.m_contacts[k].m_normal;
    }
}

// Contact parameters from both sides, as Bullet combines them, with the soft body's friction coefficient. NaN counts as
// 0.
ContactFinder::Surface ContactFinder::surfaceOf(const btSoftBody& soft, const btCollisionObject& object)
{
    const auto atLeastZero = [](double value) { return value > 0 ? value : 0; };
    Surface surface;
    surface.m_hardness = atLeastZero(object.isStaticOrKinematicObject() ? soft.m_cfg.kKHR / kUsualKineticHardness
                                                                        : double(soft.m_cfg.kCHR));
    surface.m_friction = frictionBetween(soft, object);
    surface.m_restitution = std::min(1.0, atLeastZero(double(soft.getRestitution()) * object.getRestitution()));
    if (!(object.getCollisionFlags() & btCollisionObject::CF_HAS_CONTACT_STIFFNESS_DAMPING)) return surface;
    if (!(object.getContactStiffness() < kRigidStiffness)) return surface;
    surface.m_stiffness = atLeastZero(object.getContactStiffness());
    surface.m_damping = atLeastZero(object.getContactDamping());
    return surface;
}

// True if the surface at a feature faces against the normal: one of its triangles does, or their mean. A point beside a
// box that lies on the surface is near the box's side wall, but its surface does not face that wall.
bool ContactFinder::faces(const FemSoftBody& fem, const Triangle& nodes, const Vec3& normal)
{
    const std::vector<Triangle>& triangles = fem.m_surface.triangles();
    const std::vector<Vec3>& x = fem.surfacePosition();
    const SurfaceFeatures& features = fem.m_surface.features();
    Vec3 mean;
    for (int k = features.m_firstAround[nodes[0]]; k < features.m_firstAround[nodes[0] + 1]; ++k)
    {
        const Triangle& t = triangles[features.m_around[k]];
        const auto has = [&t](int node) { return t[0] == node || t[1] == node || t[2] == node; };
        if (!has(nodes[1]) || !has(nodes[2])) continue;
        const Vec3 area = cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]]);
        if (dot(area, normal) < kOpposedCosine * norm(area)) return true;
        mean += area;
    }
    return dot(mean, normal) <= kOpposedCosine * norm(mean);
}

// Keeps a point if it is within the band, or comes within it by the end of the step in free motion.
void ContactFinder::consider(FemSoftBody& fem, const Target& target, int feature, const Triangle& nodes,
                             const SurfaceDistance& d)
{
    const Vec3 point = interpolated(fem.surfacePosition(), nodes, d.m_barycentric);
    const Vec3 relative =
        interpolated(fem.surfaceVelocity(), nodes, d.m_barycentric) - target.m_motion->velocityAt(point);
    const double closest = d.m_gap + target.m_step * dot(d.m_normal, relative) - norm(target.m_fall);
    if (d.m_gap > m_band && closest > m_band) return;
    // A plane fills all of its half space: a point on its way into one is a contact whatever its normal. Otherwise the
    // core of a body that is crushed within one step would pass the contacts on its surface.
    const double nearest = isPlane(*target.m_shape) ? std::min(d.m_gap, closest) : d.m_gap;
    if (nearest > -m_band && !faces(fem, nodes, d.m_normal)) return;
    keep(fem, target, feature, nodes, d);
}

// Offset from a node's contact point to the contact patch after `time`. Nearest points of edges and triangles move with
// the patch and have none.
Vec3 ContactFinder::patchOf(const FemSoftBody& fem, const Target& target, int node, const Vec3& normal,
                            double time) const
{
    const Vec3& x = fem.surfacePosition()[node];
    const double infinite = std::numeric_limits<double>::infinity();
    const bool canMove = !target.m_object->isStaticOrKinematicObject();
    const SurfacePoint point = fem.pointOn(m_bodyIndex, {node, node, node}, {1, 0, 0});
    TouchingSide soft = {point.of(fem.m_body.m_state.m_v), fem.m_meanMotion.m_spin,
                         roundness(fem.m_surface.curvature(node), m_size), m_size, std::nullopt};
    if (fem.m_surface.hasFewFacets(node)) soft.m_ofMass = fem.m_meanMotion.m_velocity;
    const TouchingSide rigid = {
        target.m_motion->velocityAt(x), target.m_motion->m_angularVelocity, curvatureOf(*target.m_shape),
        canMove ? norm(target.m_shape->m_boundsMax - target.m_shape->m_boundsMin) : infinite, std::nullopt};
    return patchLag(soft, rigid, normal, time);
}

// Appends a contact. Returns null, and appends nothing, where the surface is anchored to the object.
ContactPoint* ContactFinder::keep(FemSoftBody& fem, const Target& target, int feature, const Triangle& nodes,
                                  const SurfaceDistance& d)
{
    ContactPoint contact;
    contact.m_soft = fem.pointOn(m_bodyIndex, nodes, d.m_barycentric);
    for (int a = 0; a < contact.m_soft.m_count; ++a)
        if (isAnchoredTo(fem, contact.m_soft.m_nodes[a], *target.m_object)) return nullptr;
    const Vec3& inverseMass = target.m_motion->m_inverseMass;
    contact.m_point = interpolated(fem.surfacePosition(), nodes, d.m_barycentric);
    contact.m_rigidProxy = target.m_rigidProxy;
    contact.m_approach = target.m_moved;
    if (feature < fem.m_surface.vertexCount())
        contact.m_patch = patchOf(fem, target, feature, d.m_normal, target.m_step);
    contact.m_normal = d.m_normal;
    contact.m_gap = d.m_gap;
    if (target.m_object->isKinematicObject())
        contact.m_gap -= closedByArc(*target.m_motion, contact.m_point, d.m_normal, target.m_step);
    contact.m_slop = (dot(inverseMass, inverseMass) > 0 ? kMovableSlop : kSlop) * m_size;
    contact.m_friction = target.m_surface.m_friction;
    contact.m_restitution = target.m_surface.m_restitution;
    contact.m_stiffness = target.m_surface.m_stiffness;
    contact.m_damping = target.m_surface.m_damping;
    contact.m_hardness = target.m_surface.m_hardness;
    m_contacts.push_back(contact);
    m_origins.push_back(originOf(target, feature));
    m_weights.push_back(d.m_barycentric);
    return &m_contacts.back();
}

ContactOrigin ContactFinder::originOf(const Target& target, int feature)
{
    const btCollisionObject* object = target.m_object;
    return {object, broadphaseId(*object), target.m_leaf, feature};
}

// The body's contact of this origin that pushed in the last step, or null.
const ContactPoint* ContactFinder::pushing(const FemSoftBody& fem, const ContactOrigin& origin)
{
    const auto [first, last] = std::equal_range(fem.m_origins.begin(), fem.m_origins.end(), origin);
    const auto contactOf = [&](const ContactOrigin& old) { return &fem.m_contacts[&old - fem.m_origins.data()]; };
    const auto found = std::find_if(first, last, [&](const ContactOrigin& old) { return isPushing(*contactOf(old)); });
    return found == last ? nullptr : contactOf(*found);
}

// Thins the contacts by their gaps at the end of the step, predicted with the last step's velocities: the free motion
// ignores the support of contacts.
void ContactFinder::thin(const FemSoftBody& fem, const RigidSurroundings& around)
{
    const double cell = ContactReduction::cellOf(fem);
    if (!(cell > 0)) return;
    m_reduction.clear(cell);
    const std::vector<Vec3>& X = fem.m_body.m_model->mesh().restPositions();
    for (std::size_t k = 0; k < m_contacts.size(); ++k)
    {
        const ContactPoint& contact = m_contacts[k];
        const Vec3 relative = contact.m_soft.of(fem.m_body.m_state.m_v) -
                              around.m_rigidProxies[contact.m_rigidProxy].velocityAt(contact.m_point);
        m_reduction.add({m_origins[k].m_objectId, contact, contact.m_soft.of(X),
                         contact.m_gap + around.m_step * dot(contact.m_normal, relative),
                         pushing(fem, m_origins[k]) != nullptr});
    }
    m_reduction.thin(m_contacts, m_origins);
}

// Warm start: takes over the impulses of the last step's contacts. Both lists are sorted by origin. If a feature has
// several contacts with a leaf, the one of most similar normal and position is taken.
void ContactFinder::takeOverImpulses(const FemSoftBody& fem)
{
    m_continued.assign(fem.m_origins.size(), 0);
    for (std::size_t k = 0; k < m_origins.size(); ++k)
    {
        const auto range = std::equal_range(fem.m_origins.begin(), fem.m_origins.end(), m_origins[k]);
        double best = kLeastLikeness;
        std::size_t before = fem.m_origins.size();
        for (auto old = range.first; old != range.second; ++old)
        {
            const std::size_t candidate = old - fem.m_origins.begin();
            const ContactPoint& contact = fem.m_contacts[candidate];
            const double likeness =
                dot(contact.m_normal, m_contacts[k].m_normal) - norm(contact.m_point - m_contacts[k].m_point) / m_size;
            if (likeness <= best || m_continued[candidate]) continue;
            best = likeness;
            before = candidate;
        }
        if (before == fem.m_origins.size()) continue;
        m_continued[before] = 1;
        m_contacts[k].m_impulse = fem.m_contacts[before].m_impulse;
        m_contacts[k].m_slip = fem.m_contacts[before].m_slip;
    }
    inheritImpulses(fem);
}

// Hands the impulses of contacts that are gone to new contacts nearby, object by object.
void ContactFinder::inheritImpulses(const FemSoftBody& fem)
{
    const auto idOf = [](const ContactOrigin& origin) { return origin.m_objectId; };
    for (std::size_t first = 0, end = 0, k = 0; first < fem.m_origins.size(); first = end)
    {
        const int id = idOf(fem.m_origins[first]);
        m_transfer.clear(fem.m_origins.size());
        for (end = first; end < fem.m_origins.size() && idOf(fem.m_origins[end]) == id; ++end)
        {
            const ContactPoint& old = fem.m_contacts[end];
            if (m_continued[end]) continue;
            m_transfer.addLost(old.m_soft.of(fem.m_body.m_state.m_x), old.m_normal, old.m_impulse);
        }
        while (k < m_origins.size() && idOf(m_origins[k]) < id) ++k;
        for (; k < m_origins.size() && idOf(m_origins[k]) == id; ++k) m_transfer.addHeir(m_contacts[k], 1);
        m_transfer.settle(fem.m_body.m_model->mesh().meanEdgeLength());
    }
}

}  // namespace bullet_fem
