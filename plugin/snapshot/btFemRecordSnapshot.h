// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bullet_bridge/snapshot/contact_snapshot.h"
#include "bullet_bridge/snapshot/node_snapshot.h"
#include "bullet_fem/fem/body/body_snapshot.h"
#include "plugin/record/btFemBodyRecord.h"

/// A value that refers to another object, with that object's id in place of its pointer: see WorldIds.
template <class T>
struct btFemWithOther
{
    T m_value;
    int m_other = bullet_fem::WorldIds::kGone;
};

/// All of a btFemBodyRecord that steps write and that the next step or the user reads. Times are omitted, so that equal
/// states give equal bytes.
struct btFemRecordSnapshot
{
    int m_id = -1;  ///< broadphase id
    int m_nodeCount = 0, m_tetCount = 0;
    bool m_materialGiven = false, m_materialChanged = false;
    std::uint64_t m_materialMark = 0;  ///< hash of the materials asked for
    bullet_fem::BodySnapshot m_body;
    bool m_hasFormerFactor = false;
    bullet_fem::FactorInput m_formerFactor;
    bullet_fem::NodeSnapshot m_nodes;
    bullet_fem::ContactSnapshot m_contact;
    int m_setUpFlags = 0;
    std::string m_message;
    btFemStepReport m_report;
    std::vector<btFemWithOther<btFemContact>> m_contacts;
    std::vector<btFemWithOther<btFemTouch>> m_touches;
    btFemSleepRecord m_sleep;  ///< its neighbours are in m_neighbours
    std::vector<btFemWithOther<btFemNeighbour>> m_neighbours;
    double m_lastStep = 0;
    btFemDetailLevel m_detailLevel;
    btFemFactorAccount m_factorAccount;
    btFemInsideOut m_insideOut;
};

/// The snapshot of a body that is in the world.
btFemRecordSnapshot snapshotOf(const btFemBodyRecord& record, const bullet_fem::WorldIds& world);

/// Throws std::invalid_argument, naming the value, unless the snapshot is consistent with this body and its present
/// material.
void check(const btFemRecordSnapshot& snapshot, const btFemBodyRecord& record, const bullet_fem::WorldIds& world);

/// Restores the body, which must have the factor of the snapshot. Drops references to objects that are not in the
/// world. Call after check().
void restore(const btFemRecordSnapshot& snapshot, const bullet_fem::WorldIds& world, btFemBodyRecord& record);

template <class Bytes>
void transfer(Bytes& bytes, btVector3& v)
{
    bytes(v[0], v[1], v[2]);
}

template <class Bytes>
void transfer(Bytes& bytes, btTransform& t)
{
    bytes(t.getBasis()[0], t.getBasis()[1], t.getBasis()[2], t.getOrigin(), t.getOrigin()[3]);
}

template <class Bytes>
void transfer(Bytes& bytes, btFemContact& c)
{
    bytes(c.m_point, c.m_normal, c.m_gap, c.m_impulse, c.m_normalImpulse, c.m_frictionImpulse, c.m_part, c.m_index,
          c.m_nodeCount);
    bullet_fem::checkNodeCount(c.m_nodeCount);
    for (int a = 0; a < c.m_nodeCount; ++a) bytes(c.m_nodes[a], c.m_weights[a]);
}

template <class Bytes>
void transfer(Bytes& bytes, btFemTouch& t)
{
    bytes(t.m_otherId, t.m_state, t.m_points, t.m_impulse, t.m_normalImpulse);
}

template <class Bytes>
void transfer(Bytes& bytes, btFemNeighbour& n)
{
    bytes(n.m_id, n.m_transform, n.m_touches, n.m_held, n.m_mark);
}

template <class Bytes, class T>
void transfer(Bytes& bytes, btFemWithOther<T>& w)
{
    bytes(w.m_value, w.m_other);
}

template <class Bytes>
void transfer(Bytes& bytes, btFemSleepRecord& s)
{
    bytes(s.m_asleep, s.m_recorded, s.m_influences, s.m_targets, s.m_low, s.m_high, s.m_forces);
}

template <class Bytes>
void transfer(Bytes& bytes, btFemStepReport& r)
{
    bytes(r.m_flags, r.m_detail, r.m_iterations, r.m_residual, r.m_contactIterations, r.m_contactSweeps, r.m_contacts,
          r.m_contactViolation, r.m_deepestPenetration, r.m_impactStress);
}

template <class Bytes>
void transfer(Bytes& bytes, btFemRecordSnapshot& s)
{
    bytes(s.m_id, s.m_nodeCount, s.m_tetCount, s.m_materialGiven, s.m_materialChanged, s.m_materialMark, s.m_body,
          s.m_hasFormerFactor, s.m_formerFactor, s.m_nodes, s.m_contact, s.m_setUpFlags, s.m_message, s.m_report,
          s.m_contacts, s.m_touches, s.m_sleep, s.m_neighbours, s.m_lastStep);
    s.m_detailLevel.transfer(bytes);
    s.m_factorAccount.transfer(bytes);
    s.m_insideOut.transfer(bytes);
}
