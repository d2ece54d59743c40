// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/snapshot/contact_snapshot.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "BulletSoftBody/btSoftBody.h"
#include "fem/common/message.h"

namespace bullet_fem
{
namespace
{

// Bound of values in a snapshot: no scene reaches it, and its square is finite in single precision.
constexpr double kMax = 1e12;

bool isSane(double value)
{
    return std::fabs(value) < kMax;
}

bool isSane(const Vec3& v)
{
    return isSane(v.x) && isSane(v.y) && isSane(v.z);
}

template <class... Values>
void checkSane(const char* whose, const Values&... values)
{
    if (!(isSane(values) && ...)) reject("the numbers of ", whose, " are not in (-1e12, 1e12)");
}

int nodesOf(const FemSoftBody& fem)
{
    return fem.m_softBody->m_nodes.size();
}

void checkNode(int node, const FemSoftBody& fem, const char* what)
{
    if (node < 0 || node >= nodesOf(fem)) reject("node ", node, " of ", what, " is not in [0, ", nodesOf(fem), ")");
}

void checkSurfacePoint(const SurfacePoint& point, const FemSoftBody& fem, const char* what)
{
    for (int a = 0; a < point.m_count; ++a)
    {
        checkNode(point.m_nodes[a], fem, what);
        checkSane("a contact", point.m_weights[a]);
    }
}

double sumOfWeights(const SurfacePoint& point)
{
    double sum = 0;
    for (int a = 0; a < point.m_count; ++a) sum += point.m_weights[a];
    return sum;
}

bool isOne(double value)
{
    constexpr double kAlmost = 1e-9;
    return std::fabs(value - 1) <= kAlmost;
}

// Checks the values that the next step may use unchanged.
void checkKept(const ContactPoint& c)
{
    if (!isOne(norm(c.m_normal)))
        reject("the normal of a contact between bodies has length ", norm(c.m_normal), ", not 1");
    for (const SurfacePoint* point : {&c.m_soft, &c.m_other})
        if (!isOne(sumOfWeights(*point)))
            reject("the weights of a contact between bodies sum up to ", sumOfWeights(*point), ", not 1");
}

// `soft` is the body of m_soft; `other` is null for a rigid object, or a body that has left the world.
void checkPoint(const ContactPoint& c, const FemSoftBody& soft, const FemSoftBody* other)
{
    checkSurfacePoint(c.m_soft, soft, "a contact");
    if (other) checkSurfacePoint(c.m_other, *other, "a contact's other side");
    checkSane("a contact", c.m_gap, c.m_slop, c.m_friction, c.m_restitution, c.m_stiffness, c.m_damping, c.m_point,
              c.m_approach, c.m_normal, c.m_impulse, c.m_slip);
}

// More impacts at once fit into no memory.
constexpr int kMaxImpactGroup = 1000000000;

// `other` is null for a rigid object, or a body that has left the world.
void checkImpact(const Impact& i, const FemSoftBody& fem, const FemSoftBody* other)
{
    const auto checkComponent = [](int component, int least, const FemSoftBody& of)
    {
        const int count = of.m_body.m_model->mesh().componentCount();
        if (component < least || component >= count)
            reject("the component of an impact is ", component, ", not in [", least, ", ", count, ")");
    };
    checkComponent(i.m_component, 0, fem);
    if (other)
        checkComponent(i.m_otherComponent, 0, *other);
    else if (i.m_otherComponent < -1)
        reject("the other component of an impact is ", i.m_otherComponent, ", below -1");
    checkSane("an impact", i.m_passedOn, i.m_push, i.m_velocity, i.m_energy, i.m_loss, i.m_speed, i.m_gain, i.m_point,
              i.m_normal, i.m_frame, i.m_time, i.m_stopTime);
    if (!(i.m_restitution >= 0 && i.m_restitution <= 1))
        reject("the restitution of an impact is ", i.m_restitution, ", not in [0, 1]");
    if (!(i.m_group >= 0 && i.m_group < kMaxImpactGroup))
        reject("the group of an impact is ", i.m_group, ", not in [0, ", kMaxImpactGroup, ")");
    if (!isOne(norm(i.m_normal))) reject("the normal of an impact has length ", norm(i.m_normal), ", not 1");
}

bool isAnchor(const HeldJoint& joint)
{
    return joint.m_kind == HeldJoint::Kind::anchor || joint.m_kind == HeldJoint::Kind::deformableAnchor;
}

bool isClusterJoint(const HeldJoint& joint)
{
    return joint.m_kind == HeldJoint::Kind::linearJoint || joint.m_kind == HeldJoint::Kind::angularJoint;
}

void checkHeld(const HeldJoint& joint, const FemSoftBody& fem)
{
    if (joint.m_kind < HeldJoint::Kind::anchor || joint.m_kind > HeldJoint::Kind::spring)
        reject("the kind of a joint is ", static_cast<int>(joint.m_kind), ", not in [0, 5]");
    const int least = isAnchor(joint) ? 0 : -1;  // -1: no node
    if (joint.m_node < least || joint.m_node >= nodesOf(fem))
        reject("the node of a joint is ", joint.m_node, ", not in [", least, ", ", nodesOf(fem), ")");
    checkSane("a joint", joint.m_point, joint.m_impulse, joint.m_error);
}

void checkAttachment(const AttachmentSnapshot& a, const FemSoftBody& fem, const WorldIds& world)
{
    checkNode(a.m_attachment.m_node, fem, "an attachment");
    if (const FemSoftBody* other = world.bodyOf(a.m_other))
        for (int node : a.m_attachment.m_otherNodes) checkNode(node, *other, "an attachment's other side");
    for (double weight : a.m_attachment.m_weights) checkSane("an attachment", weight);
    for (double value : {a.m_attachment.m_area, a.m_attachment.m_compliance})
        if (!(value >= 0 && std::isfinite(value))) reject("an area or compliance of a weld is ", value, ", below 0");
}

void checkWeld(const Weld& weld, const FemSoftBody& fem)
{
    for (const std::array<int, 3>& face : weld.m_faces)
        for (int node : face) checkNode(node, fem, "a weld");
    for (double limit : {weld.m_breakForce, weld.m_breakStress, weld.m_breakStretch})
        if (!(limit > 0)) reject("a limit of a weld is ", limit, ", not above 0");
}

// Finds the user's joint among those of the bodies, and stores its owner and index.
void tellSource(const void* source, const WorldIds& world, HeldSnapshot& held)
{
    if (!source) return;
    held.m_owner = WorldIds::kGone;
    for (const FemSoftBody* fem : world.m_bodies)
        for (int k = 0; k < fem->m_softBody->m_joints.size(); ++k)
            if (fem->m_softBody->m_joints[k] == source) held.m_owner = world.idOf(fem->m_softBody), held.m_source = k;
}

// The user's joint; null if it no longer exists.
const void* sourceOf(const HeldSnapshot& held, const WorldIds& world)
{
    const FemSoftBody* fem = world.bodyOf(held.m_owner);
    if (!fem || held.m_source < 0 || held.m_source >= fem->m_softBody->m_joints.size()) return nullptr;
    const btSoftBody::Joint* joint = fem->m_softBody->m_joints[held.m_source];
    const bool angular = joint->Type() == btSoftBody::Joint::eType::Angular;
    return angular == (held.m_joint.m_kind == HeldJoint::Kind::angularJoint) ? joint : nullptr;
}

void restoreJoints(const ContactSnapshot& s, const WorldIds& world, HeldJoints& joints)
{
    joints.m_now.clear();
    joints.m_before.clear();
    for (const HeldSnapshot& held : s.m_held)
    {
        HeldJoint joint = held.m_joint;
        joint.m_object = world.objectOf(held.m_object);
        joint.m_source = sourceOf(held, world);
        const bool gone = !joint.m_object && held.m_object != WorldIds::kNone;
        if (!gone && (joint.m_source || !isClusterJoint(joint))) joints.m_now.push_back(joint);
    }
    joints.m_attachments.clear();
    for (const AttachmentSnapshot& a : s.m_attachments)
    {
        const FemSoftBody* other = world.bodyOf(a.m_other);
        if (!other) continue;
        joints.m_attachments.push_back(a.m_attachment);
        joints.m_attachments.back().m_other = other->m_softBody;
        joints.m_attachments.back().m_otherMark = other->m_setUp.m_mark;
    }
    joints.m_welds.clear();
    for (const WeldSnapshot& w : s.m_welds)
    {
        const FemSoftBody* other = world.bodyOf(w.m_other);
        if (!other) continue;
        joints.m_welds.push_back(w.m_weld);
        joints.m_welds.back().m_other = other->m_softBody;
    }
    joints.m_lastId = s.m_lastAttachment;
    for (const ClothAttachment& a : joints.m_clothAttachments)  // they are not part of a snapshot
        joints.m_lastId = std::max(joints.m_lastId, a.m_id);
}

void checkSolids(const ContactSnapshot& s, const FemSoftBody& fem)
{
    for (const SolidPlace& solid : s.m_solids)
    {
        const Mat3& rotation = solid.m_pose.m_rotation;
        checkSane("the pose of a solid", solid.m_pose.m_origin, rotation.column(0), rotation.column(1),
                  rotation.column(2));
    }
    const std::size_t vertices = fem.surfacePosition().size();
    if (!s.m_positions.empty() && s.m_positions.size() != vertices)
        reject("positions of ", s.m_positions.size(), " vertices are noted, not of 0 or of ", vertices);
    for (const Vec3& position : s.m_positions) checkSane("a noted position", position);
}

}  // namespace

void checkNodeCount(int count)
{
    if (count < 1 || count > SurfacePoint::kMaxNodes)
        reject("a contact point has ", count, " nodes, not 1 to ", SurfacePoint::kMaxNodes);
}

ContactSnapshot contactSnapshotOf(const FemSoftBody& fem, const WorldIds& world)
{
    ContactSnapshot s;
    s.m_contacts = fem.m_memory.m_contacts;
    s.m_origins = fem.m_memory.m_origins;
    s.m_sheetSides = fem.m_memory.m_sheetSides;
    s.m_solids = fem.m_memory.m_solids;
    s.m_positions = fem.m_memory.m_positions;
    for (const Impact& impact : fem.m_memory.m_impacts) s.m_impacts.push_back({impact, world.idOf(impact.m_other)});
    for (const HeldJoint& joint : fem.m_joints.m_now)
    {
        HeldSnapshot held;
        held.m_joint = joint;
        held.m_object = world.idOf(joint.m_object);
        tellSource(joint.m_source, world, held);
        s.m_held.push_back(held);
    }
    for (const NodeAttachment& attachment : fem.m_joints.m_attachments)
    {
        const FemSoftBody* other = world.bodyAt(attachment.m_other);
        const bool here = other && other->m_setUp.m_mark == attachment.m_otherMark;
        s.m_attachments.push_back({attachment, here ? world.idOf(attachment.m_other) : WorldIds::kGone});
    }
    for (const Weld& weld : fem.m_joints.m_welds) s.m_welds.push_back({weld, world.idOf(weld.m_other)});
    s.m_lastAttachment = fem.m_joints.m_lastId;
    s.m_place = fem.m_memory.m_place.positions();
    return s;
}

void check(const ContactSnapshot& s, const FemSoftBody& fem, const WorldIds& world)
{
    if (s.m_contacts.size() != s.m_origins.size())
        reject(s.m_contacts.size(), " contacts with ", s.m_origins.size(), " origins");
    for (const ContactPoint& contact : s.m_contacts) checkPoint(contact, fem, nullptr);
    for (const ContactOrigin& origin : s.m_origins)
        if (origin.m_feature < 0) reject("the feature of a contact is ", origin.m_feature, ", below 0");
    for (const SheetSide& side : s.m_sheetSides) checkSane("a sheet's side", side.m_position, side.m_safe);
    checkSolids(s, fem);
    for (const ImpactSnapshot& impact : s.m_impacts) checkImpact(impact.m_impact, fem, world.bodyOf(impact.m_other));
    for (const HeldSnapshot& held : s.m_held) checkHeld(held.m_joint, fem);
    for (const AttachmentSnapshot& a : s.m_attachments) checkAttachment(a, fem, world);
    for (const WeldSnapshot& w : s.m_welds) checkWeld(w.m_weld, fem);
    if (s.m_lastAttachment < 0) reject("the last attachment's handle is ", s.m_lastAttachment, ", below 0");
    const std::size_t vertices = fem.m_surface.topology().vertices().size();
    if (!s.m_place.empty() && s.m_place.size() != vertices)
        reject("places of ", s.m_place.size(), " vertices are noted, not of 0 or of ", vertices);
    for (const Vec3& place : s.m_place) checkSane("a noted place", place);
}

void restore(const ContactSnapshot& s, const WorldIds& world, FemSoftBody& fem)
{
    ContactMemory& memory = fem.m_memory;
    memory.m_contacts.clear();
    memory.m_origins.clear();
    for (std::size_t k = 0; k < s.m_contacts.size(); ++k)
    {
        const btCollisionObject* object = world.objectOf(s.m_origins[k].m_objectId);
        if (!object) continue;
        memory.m_contacts.push_back(s.m_contacts[k]);
        memory.m_origins.push_back(s.m_origins[k]);
        memory.m_origins.back().m_object = object;
    }
    memory.m_sheetSides.assign(s.m_sheetSides.begin(), s.m_sheetSides.end());
    memory.m_solids.assign(s.m_solids.begin(), s.m_solids.end());
    memory.m_positions.assign(s.m_positions.begin(), s.m_positions.end());
    memory.m_impacts.clear();
    for (const ImpactSnapshot& impact : s.m_impacts)
    {
        const btCollisionObject* other = world.objectOf(impact.m_other);
        if (!other) continue;
        memory.m_impacts.push_back(impact.m_impact);
        memory.m_impacts.back().m_other = other;
    }
    fem.m_overlaps.m_rigid.clear();
    fem.m_overlaps.m_soft.clear();
    restoreJoints(s, world, fem.m_joints);
    fem.m_memory.m_place.restore(s.m_place);
}

void checkAndDrop(SoftPairMemory::Kept& kept, const WorldIds& world)
{
    if (kept.m_contacts.size() != kept.m_origins.size())
        reject(kept.m_contacts.size(), " contacts between bodies with ", kept.m_origins.size(), " origins");
    std::size_t left = 0;
    for (std::size_t k = 0; k < kept.m_contacts.size(); ++k)
    {
        const SoftPairOrigin& origin = kept.m_origins[k];
        if (origin.m_kind < SoftPairKind::nodeOfFirst || origin.m_kind > SoftPairKind::edges)
            reject("the kind of a contact between bodies is ", static_cast<int>(origin.m_kind), ", not in [0, 2]");
        const FemSoftBody *first = world.bodyOf(origin.m_firstId), *second = world.bodyOf(origin.m_secondId);
        if (!first || !second) continue;
        if (origin.m_kind == SoftPairKind::nodeOfSecond) std::swap(first, second);
        checkPoint(kept.m_contacts[k], *first, second);
        checkKept(kept.m_contacts[k]);
        kept.m_contacts[left] = kept.m_contacts[k];
        kept.m_origins[left++] = kept.m_origins[k];
    }
    kept.m_contacts.resize(left);
    kept.m_origins.resize(left);
}

void check(const RigidHistory::Memory& memory)
{
    for (const RigidHistory::Remainder& r : memory.m_remainders)
        checkSane("a rigid body's remainder", r.m_linear, r.m_angular, r.m_linearGiven, r.m_angularGiven,
                  r.m_linearExpected, r.m_angularExpected);
}

}  // namespace bullet_fem
