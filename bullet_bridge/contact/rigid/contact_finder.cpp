// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/rigid/contact_finder.h"

#include <algorithm>

#include "BulletCollision/CollisionDispatch/btCollisionObject.h"
#include "BulletCollision/CollisionShapes/btCollisionShape.h"
#include "bullet_bridge/contact/nearest_contacts.h"
#include "bullet_bridge/contact/rigid/entered_face.h"
#include "bullet_bridge/geometry/shapes/field_distance.h"
#include "fem/common/rotation.h"

namespace bullet_fem
{
namespace
{

template <class Object>
void noteOverlap(const Object& object, std::mutex& mutex, std::vector<const Object*>& overlapping)
{
    const std::lock_guard<std::mutex> lock(mutex);
    if (std::find(overlapping.begin(), overlapping.end(), &object) == overlapping.end()) overlapping.push_back(&object);
}

}  // namespace

void recordOverlap(FemSoftBody& fem, const btCollisionObject& object)
{
    noteOverlap(object, fem.m_overlaps.m_mutex, fem.m_overlaps.m_rigid);
}

void recordOverlap(FemSoftBody& fem, const btSoftBody& other)
{
    noteOverlap(other, fem.m_overlaps.m_mutex, fem.m_overlaps.m_soft);
}

ContactSearchReport ContactFinder::find(FemSoftBody& fem, int bodyIndex, const RigidSurroundings& around)
{
    ContactSearchReport report;
    for (int k = 0; k < around.m_count; ++k)
        report.m_unknownShape = around.m_touched[k].m_unknownShape || report.m_unknownShape;
    m_near.clear();
    m_found.clear();
    m_sheets.begin();
    m_scope.begin(fem, bodyIndex);
    m_matcher.begin(fem);
    m_targets.list(m_scope, around);
    for (ContactTarget& target : m_targets.targets())
    {
        findNear(target);
        report.m_encloses = report.m_encloses || isEnclosed(m_scope, target);
    }
    reserve();
    m_filter.judge(m_scope, m_targets.targets(), m_near);
    for (const ContactTarget& target : m_targets.targets()) findWithinStep(target);
    const double cell = ContactReduction::cellOf(fem);
    if (cell > 0)
    {
        listForReduction(around, cell);
        m_reduction.thin(m_found.points(), m_found.origins());
    }
    report.m_limited = limit(around);
    m_matcher.transferImpulses(m_scope, m_found);
    fem.m_memory.m_contacts.assign(m_found.points().begin(), m_found.points().end());
    fem.m_memory.m_origins.assign(m_found.origins().begin(), m_found.origins().end());
    fem.m_memory.m_sheetSides.assign(m_sheets.sides().begin(), m_sheets.sides().end());
    notePlaces(m_targets.targets(), fem);
    return report;
}

// Finds the contacts of a target as the step begins, and the candidates within the step.
void ContactFinder::findNear(ContactTarget& target)
{
    const InnerFaces innerFaces(m_targets.targets(), m_matcher.heldNormal());
    target.m_first = m_near.size();
    const btCollisionShape& shape = *target.m_shape->m_shape;
    if (isSheet(shape))
    {
        target.m_kind = TargetKind::sheets;
        m_sheets.findNear(m_scope, target, m_matcher.heldNormal(), m_near);
    }
    else if (isSolid(shape) && isFastTarget(m_scope, target))
    {
        target.m_kind = TargetKind::fast;
        findTouchingNodes(m_scope, innerFaces, target, m_near);
    }
    else if (m_scope.m_culling.meets({target.m_shape->m_boundsMin, target.m_shape->m_boundsMax, target.m_reach}))
        m_nodes.find(m_scope, innerFaces, target, m_near);
    target.m_end = m_near.size();
}

// Appends the contacts of a target: those near it that are not flush, and those that the surface meets on its path.
void ContactFinder::findWithinStep(const ContactTarget& target)
{
    const std::size_t first = m_found.size();
    if (target.m_kind == TargetKind::fast)
        findOnPaths(m_scope, target, m_near, m_filter, m_found);
    else if (target.m_kind == TargetKind::sheets)
        m_sheets.findOnPaths(m_scope, target, m_near, m_filter, m_found);
    else
        confirmOnPaths(m_scope, target, m_near, m_filter, m_found);
    turnToEnd(target, first);
}

// Turns the contacts of a kinematic object, from `first` on, to its pose at the end of the step: a surface that slides
// along a turning wall would pass it. Those of fast targets have their normals at the time of impact.
void ContactFinder::turnToEnd(const ContactTarget& target, std::size_t first)
{
    const Vec3 turn = target.m_step * target.m_motion->m_angularVelocity;
    if (!target.m_object->isKinematicObject() || target.m_kind == TargetKind::fast || first == m_found.size()) return;
    if (!(norm(turn) > 0 && norm(turn) <= RigidProxy::kMaxTurn)) return;
    const Mat3 R = exponential(turn);
    for (std::size_t k = first; k < m_found.size(); ++k)
    {
        Vec3& normal = m_found.points()[k].m_normal;
        normal = unit(R * normal);
    }
}

// Reserves for contacts that may come, so that steps with no more contacts than before do not allocate.
void ContactFinder::reserve()
{
    constexpr std::size_t kMin = 64;  // contacts
    const std::size_t room = std::max(kMin, 2 * m_near.size());
    m_near.reserve(room);
    m_found.reserve(room);
    m_filter.reserve(room);
    m_targets.reserve(kMin);
    m_nodes.reserve(kMin);
}

// Keeps at most m_maxContacts: thins them by place, and drops those of largest gap where that does not suffice.
bool ContactFinder::limit(const RigidSurroundings& around)
{
    if (static_cast<int>(m_found.points().size()) <= around.m_maxContacts) return false;
    listForReduction(around, ContactReduction::smallestCellOf(m_scope.fem()));
    m_reduction.limit(around.m_maxContacts, m_found.points(), m_found.origins());
    keepNearest(around.m_maxContacts, m_order, m_found.points(), m_found.origins());
    return true;
}

// Lists the contacts with their gaps at the end of the step, predicted with the last step's velocities: the free motion
// ignores the support of contacts.
void ContactFinder::listForReduction(const RigidSurroundings& around, double cell)
{
    const FemSoftBody& fem = m_scope.fem();
    const std::vector<ContactPoint>& contacts = m_found.points();
    const std::vector<ContactOrigin>& origins = m_found.origins();
    m_reduction.clear(cell);
    const std::vector<Vec3>& X = fem.m_body.m_model->mesh().restPositions();
    for (std::size_t k = 0; k < contacts.size(); ++k)
    {
        const ContactPoint& contact = contacts[k];
        const Vec3 relative = contact.m_soft.of(fem.m_body.m_state.m_v) -
                              around.m_rigidProxies[contact.m_rigidProxy].velocityAt(contact.m_point);
        m_reduction.add({origins[k].m_objectId, contact, contact.m_soft.of(X),
                         contact.m_gap + around.m_step * dot(contact.m_normal, relative),
                         pushingContact(fem, origins[k]) != nullptr});
    }
}

}  // namespace bullet_fem
