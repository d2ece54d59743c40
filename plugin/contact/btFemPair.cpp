// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/contact/btFemPair.h"

#include "BulletSoftBody/btSoftBody.h"
#include "plugin/bodies/btFemBodyRegistry.h"
#include "plugin/btFemCoupling.h"

namespace
{

const btFemEntry* entryOf(const btCollisionObject& object)
{
    const btSoftBody* soft = btSoftBody::upcast(&object);
    const auto* solver = soft ? dynamic_cast<const btFemSoftBodySolver*>(soft->getSoftBodySolver()) : nullptr;
    const btFemEntry* entry = solver ? btFemCoupling::entry(*solver, *soft) : nullptr;
    return entry && entry->m_fem ? entry : nullptr;
}

}  // namespace

btFemPair femPair(const btCollisionObject& first, const btCollisionObject& second)
{
    const btFemEntry *a = entryOf(first), *b = entryOf(second);
    const bool isFirst = a && (!b || first.isActive() || !second.isActive());
    if (isFirst) return {a, &second, true};
    return {b, b ? &first : nullptr, false};
}

// Contact points lie on the soft surface, between soft bodies in the middle.
btFemPairPoint pairPoint(const btFemPair& pair, const btFemContact& contact)
{
    const btScalar share = btSoftBody::upcast(pair.m_other) ? btScalar(0.5) : btScalar(0);
    const btVector3 onBody = contact.m_point + share * contact.m_gap * contact.m_normal;
    const btVector3 onOther = contact.m_point - (1 - share) * contact.m_gap * contact.m_normal;
    if (pair.m_isFirst) return {onBody, onOther, contact.m_normal, contact.m_frictionImpulse};
    return {onOther, onBody, -contact.m_normal, -contact.m_frictionImpulse};
}
