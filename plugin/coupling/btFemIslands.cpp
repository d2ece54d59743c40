// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/coupling/btFemIslands.h"

#include <algorithm>

#include "BulletCollision/NarrowPhaseCollision/btPersistentManifold.h"
#include "BulletDynamics/ConstraintSolver/btTypedConstraint.h"
#include "BulletDynamics/Featherstone/btMultiBodyConstraint.h"
#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/joints/soft_joints.h"
#include "plugin/record/btFemBodyRecord.h"
#include "plugin/record/btFemCoupling.h"
#include "plugin/registry/btFemBodyRegistry.h"

using namespace bullet_fem;

bool btFemIslands::isTagged(int tag) const
{
    return std::find(m_tags.begin(), m_tags.end(), tag) != m_tags.end();
}

// The order of the records does not depend on addresses.
void btFemIslands::listLeftOut(const btFemBatch& all)
{
    m_leftOut.clear();
    btCollisionObject** const end = all.m_bodies + all.m_bodyCount;
    for (const auto& record : btFemCoupling::registry(m_fem).records())
    {
        if (!record->isStepped() || !record->m_softBody->isActive()) continue;
        const int tag = record->m_softBody->getIslandTag();
        const auto isOfIsland = [tag](const btCollisionObject* body) { return body->getIslandTag() == tag; };
        if (tag < 0 || std::find(all.m_bodies, end, record->m_softBody) != end) continue;
        if (std::any_of(all.m_bodies, end, isOfIsland)) m_leftOut.push_back(record->m_softBody);
    }
}

template <class Visit>
void btFemIslands::forEachSoft(const btFemBatch& all, const Visit& visit) const
{
    for (int k = 0; k < all.m_bodyCount; ++k)
        if (const btSoftBody* soft = btSoftBody::upcast(all.m_bodies[k])) visit(*soft);
    for (const btCollisionObject* body : m_leftOut) visit(*btSoftBody::upcast(body));
}

// Bullet's islands contain contacts and its own constraints, not anchors and joints of soft bodies.
void btFemIslands::tagIslands(const btFemBatch& all)
{
    m_tags.clear();
    forEachSoft(all,
                [this](const btSoftBody& soft)
                {
                    if (!isTagged(soft.getIslandTag())) m_tags.push_back(soft.getIslandTag());
                });
    forEachSoft(all,
                [&](const btSoftBody& soft)
                {
                    const btFemBodyRecord* record = btFemCoupling::record(m_fem, soft);
                    const btCollisionObject* last = nullptr;
                    if (!record || !record->isFem()) return;
                    forEachRigidEnd(*record->m_model.m_fem,
                                    [&](const btCollisionObject* object)
                                    {
                                        if (object != last) tagJoined(all, object);
                                        last = object;
                                    });
                });
}

// The joined object may be deleted: its address is only compared.
void btFemIslands::tagJoined(const btFemBatch& all, const btCollisionObject* joined)
{
    btCollisionObject** end = all.m_bodies + all.m_bodyCount;
    btCollisionObject** found = std::find(all.m_bodies, end, joined);
    if (found != end && !isTagged((*found)->getIslandTag())) m_tags.push_back((*found)->getIslandTag());
}

void btFemIslands::select(const btFemBatch& all, bool withFem)
{
    listLeftOut(all);
    tagIslands(all);
    const auto isSelected = [&](int a, int b) { return isTagged(a >= 0 ? a : b) == withFem; };
    m_bodies.clear();
    m_manifolds.clear();
    m_constraints.clear();
    m_multiBodyConstraints.clear();
    for (int k = 0; k < all.m_bodyCount; ++k)
        if (isSelected(all.m_bodies[k]->getIslandTag(), all.m_bodies[k]->getIslandTag()))
            m_bodies.push_back(all.m_bodies[k]);
    for (int k = 0; k < all.m_manifoldCount; ++k)
        if (isSelected(all.m_manifolds[k]->getBody0()->getIslandTag(), all.m_manifolds[k]->getBody1()->getIslandTag()))
            m_manifolds.push_back(all.m_manifolds[k]);
    for (int k = 0; k < all.m_constraintCount; ++k)
        if (isSelected(all.m_constraints[k]->getRigidBodyA().getIslandTag(),
                       all.m_constraints[k]->getRigidBodyB().getIslandTag()))
            m_constraints.push_back(all.m_constraints[k]);
    for (int k = 0; k < all.m_multiBodyConstraintCount; ++k)
        if (isSelected(all.m_multiBodyConstraints[k]->getIslandIdA(), all.m_multiBodyConstraints[k]->getIslandIdB()))
            m_multiBodyConstraints.push_back(all.m_multiBodyConstraints[k]);
    m_softBodies.clear();
    for (int k = 0; k < all.m_softBodyCount; ++k)
        if (isSelected(all.m_softBodies[k]->getIslandTag(), all.m_softBodies[k]->getIslandTag()))
            m_softBodies.push_back(all.m_softBodies[k]);
    m_together.assign(m_bodies.begin(), m_bodies.end());
    if (withFem) m_together.insert(m_together.end(), m_leftOut.begin(), m_leftOut.end());
}

btFemBatch btFemIslands::selected()
{
    const auto count = [](const auto& values) { return static_cast<int>(values.size()); };
    return {m_bodies.data(),
            count(m_bodies),
            m_manifolds.data(),
            count(m_manifolds),
            m_constraints.data(),
            count(m_constraints),
            m_multiBodyConstraints.data(),
            count(m_multiBodyConstraints),
            m_softBodies.data(),
            count(m_softBodies)};
}
