// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/dispatch/btFemPair.h"

#include "BulletSoftBody/btSoftBody.h"
#include "plugin/record/btFemBodyRecord.h"
#include "plugin/record/btFemCoupling.h"

namespace
{

const btFemBodyRecord* recordOf(const btCollisionObject& object)
{
    const btSoftBody* soft = btSoftBody::upcast(&object);
    const btFemBodyRecord* record = soft ? btFemCoupling::recordOf(*soft) : nullptr;
    return record && record->isFem() ? record : nullptr;
}

}  // namespace

btFemPair femPair(const btCollisionObject& first, const btCollisionObject& second)
{
    const btFemBodyRecord *a = recordOf(first), *b = recordOf(second);
    const bool isFirst = a && (!b || first.isActive() || !second.isActive());
    if (isFirst) return {a, &second, true};
    return {b, b ? &first : nullptr, false};
}

// Contact points lie on the soft surface, between soft bodies at the midpoint.
btFemPairPoint pairPoint(const btFemPair& pair, const btFemContact& contact)
{
    const btSoftBody* soft = btSoftBody::upcast(pair.m_other);
    const btScalar share = soft && soft->m_tetras.size() > 0 ? btScalar(0.5) : btScalar(0);
    const btVector3 onBody = contact.m_point + share * contact.m_gap * contact.m_normal;
    const btVector3 onOther = contact.m_point - (1 - share) * contact.m_gap * contact.m_normal;
    if (pair.m_isFirst) return {onBody, onOther, contact.m_normal, contact.m_frictionImpulse};
    return {onOther, onBody, -contact.m_normal, -contact.m_frictionImpulse};
}
