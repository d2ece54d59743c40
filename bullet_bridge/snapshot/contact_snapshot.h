// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/contact/soft/soft_pair_memory.h"
#include "bullet_bridge/rigid/rigid_proxies.h"
#include "bullet_bridge/snapshot/world_ids.h"

namespace bullet_fem
{

/// A HeldJoint with ids in place of pointers: see WorldIds.
struct HeldSnapshot
{
    HeldJoint m_joint;
    int m_object = WorldIds::kNone;  ///< the other side
    int m_owner = WorldIds::kNone;   ///< soft body whose m_joints contain the source
    int m_source = 0;                ///< index in its m_joints
};

/// A NodeAttachment with an id in place of its pointer.
struct AttachmentSnapshot
{
    NodeAttachment m_attachment;
    int m_other = WorldIds::kGone;
};

/// A Weld with an id in place of its pointer.
struct WeldSnapshot
{
    Weld m_weld;
    int m_other = WorldIds::kGone;
};

/// An Impact with an id in place of its pointer.
struct ImpactSnapshot
{
    Impact m_impact;
    int m_other = WorldIds::kGone;
};

/// Contacts, joints and impacts of a body in the last step: warm start and history of the next.
struct ContactSnapshot
{
    std::vector<ContactPoint> m_contacts;
    std::vector<ContactOrigin> m_origins;  ///< their pointers are not saved
    std::vector<SheetSide> m_sheetSides;
    std::vector<SolidPlace> m_solids;
    std::vector<Vec3> m_positions;
    std::vector<ImpactSnapshot> m_impacts;
    std::vector<HeldSnapshot> m_held;
    std::vector<AttachmentSnapshot> m_attachments;
    std::vector<WeldSnapshot> m_welds;
    int m_lastAttachment = 0;
    std::vector<Vec3> m_place;  ///< see NotedPlace
};

/// Copies the contacts, joints and impacts of a body, with the ids of `world` in place of pointers.
ContactSnapshot contactSnapshotOf(const FemSoftBody& fem, const WorldIds& world);

/// Throws std::invalid_argument, naming the value, unless the snapshot is consistent with this body.
void check(const ContactSnapshot& snapshot, const FemSoftBody& fem, const WorldIds& world);

/// Restores the body's contacts, joints and impacts. Drops those with objects that are not in the world. Call after
/// check().
void restore(const ContactSnapshot& snapshot, const WorldIds& world, FemSoftBody& fem);

/// Throws std::invalid_argument unless the contacts are consistent with the bodies of their origins. Drops contacts
/// with bodies that no longer exist.
void checkAndDrop(SoftPairMemory::Kept& kept, const WorldIds& world);

/// Throws std::invalid_argument unless all numbers are in (-1e12, 1e12).
void check(const RigidHistory::Memory& memory);

/// Throws std::invalid_argument unless `count` is a possible number of nodes of a SurfacePoint.
void checkNodeCount(int count);

template <class Bytes>
void transfer(Bytes& bytes, SurfacePoint& p)
{
    bytes(p.m_count);
    checkNodeCount(p.m_count);
    for (int a = 0; a < p.m_count; ++a) bytes(p.m_nodes[a], p.m_weights[a]);
}

template <class Bytes>
void transfer(Bytes& bytes, ContactPoint& c)
{
    bytes(c.m_soft, c.m_other, c.m_point, c.m_approach, c.m_normal, c.m_gap, c.m_slop, c.m_friction, c.m_restitution,
          c.m_stiffness, c.m_damping, c.m_impulse, c.m_slip);
}

template <class Bytes>
void transfer(Bytes& bytes, ContactOrigin& o)
{
    bytes(o.m_objectId, o.m_leaf, o.m_feature, o.m_part, o.m_triangle);
}

template <class Bytes>
void transfer(Bytes& bytes, SheetSide& s)
{
    bytes(s.m_objectId, s.m_leaf, s.m_node, s.m_position, s.m_safe);
}

template <class Bytes>
void transfer(Bytes& bytes, SolidPlace& s)
{
    bytes(s.m_objectId, s.m_leaf, s.m_pose.m_rotation, s.m_pose.m_origin);
}

template <class Bytes>
void transfer(Bytes& bytes, ImpactSnapshot& s)
{
    Impact& i = s.m_impact;
    bytes(s.m_other, i.m_otherId, i.m_component, i.m_otherComponent, i.m_restitution, i.m_passedOn, i.m_group, i.m_push,
          i.m_velocity, i.m_energy, i.m_loss, i.m_speed, i.m_gain, i.m_point, i.m_normal, i.m_frame, i.m_time,
          i.m_stopTime, i.m_isHeld, i.m_otherIsHeld);
}

template <class Bytes>
void transfer(Bytes& bytes, HeldSnapshot& h)
{
    HeldJoint& j = h.m_joint;
    bytes(j.m_kind, j.m_node, j.m_objectId, j.m_id, j.m_point, j.m_error, j.m_impulse, j.m_isEndB, h.m_object,
          h.m_owner, h.m_source);
}

template <class Bytes>
void transfer(Bytes& bytes, AttachmentSnapshot& a)
{
    bytes(a.m_attachment.m_id, a.m_attachment.m_node, a.m_other, a.m_attachment.m_otherNodes, a.m_attachment.m_weights,
          a.m_attachment.m_area, a.m_attachment.m_compliance);
}

template <class Bytes>
void transfer(Bytes& bytes, WeldSnapshot& w)
{
    bytes(w.m_weld.m_id, w.m_other, w.m_weld.m_faces, w.m_weld.m_breakForce, w.m_weld.m_breakStress,
          w.m_weld.m_breakStretch);
}

template <class Bytes>
void transfer(Bytes& bytes, ContactSnapshot& s)
{
    bytes(s.m_contacts, s.m_origins, s.m_sheetSides, s.m_solids, s.m_positions, s.m_impacts, s.m_held, s.m_attachments,
          s.m_welds, s.m_lastAttachment, s.m_place);
}

template <class Bytes>
void transfer(Bytes& bytes, SoftPairOrigin& o)
{
    bytes(o.m_firstId, o.m_secondId, o.m_kind, o.m_feature, o.m_otherFeature);
}

template <class Bytes>
void transfer(Bytes& bytes, SoftPairIds& p)
{
    bytes(p.m_firstId, p.m_secondId);
}

template <class Bytes>
void transfer(Bytes& bytes, SoftPairMemory::Kept& k)
{
    bytes(k.m_contacts, k.m_origins, k.m_completePairs);
}

template <class Bytes>
void transfer(Bytes& bytes, RigidHistory::Remainder& r)
{
    bytes(r.m_objectId, r.m_linear, r.m_angular, r.m_used, r.m_linearGiven, r.m_angularGiven, r.m_linearExpected,
          r.m_angularExpected);
}

template <class Bytes>
void transfer(Bytes& bytes, RigidHistory::Memory& m)
{
    bytes(m.m_remainders, m.m_rewound);
}

}  // namespace bullet_fem
