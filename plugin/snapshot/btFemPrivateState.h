// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h"
#include "BulletDynamics/Dynamics/btRigidBody.h"
#include "BulletDynamics/Featherstone/btMultiBody.h"

// State of Bullet's classes without accessors. An explicit instantiation may name private members (C++17,
// [temp.explicit]/12): it defines the friend function that returns the pointer to the member.

template <class Tag, typename Tag::Member member>
struct btFemPrivateMember
{
    friend typename Tag::Member memberOf(Tag) { return member; }
};

#define BULLETFEM_PRIVATE_MEMBER(name, owner, type, member) \
    struct name                                             \
    {                                                       \
        using Member = type owner::*;                       \
        friend Member memberOf(name);                       \
    };                                                      \
    template struct btFemPrivateMember<name, &owner::member>

BULLETFEM_PRIVATE_MEMBER(btFemTotalForce, btRigidBody, btVector3, m_totalForce);
BULLETFEM_PRIVATE_MEMBER(btFemTotalTorque, btRigidBody, btVector3, m_totalTorque);
BULLETFEM_PRIVATE_MEMBER(btFemLinksAwake, btMultiBody, bool, m_awake);
BULLETFEM_PRIVATE_MEMBER(btFemLinksSleepTimer, btMultiBody, btScalar, m_sleepTimer);
BULLETFEM_PRIVATE_MEMBER(btFemLinksReals, btMultiBody, btAlignedObjectArray<btScalar>, m_realBuf);
BULLETFEM_PRIVATE_MEMBER(btFemLinksVectors, btMultiBody, btAlignedObjectArray<btVector3>, m_vectorBuf);
BULLETFEM_PRIVATE_MEMBER(btFemLinksMatrices, btMultiBody, btAlignedObjectArray<btMatrix3x3>, m_matrixBuf);
BULLETFEM_PRIVATE_MEMBER(btFemLinksBaseForce, btMultiBody, btVector3, m_baseForce);
BULLETFEM_PRIVATE_MEMBER(btFemLinksBaseTorque, btMultiBody, btVector3, m_baseTorque);
BULLETFEM_PRIVATE_MEMBER(btFemLinksBaseQuat, btMultiBody, btQuaternion, m_baseQuat);
BULLETFEM_PRIVATE_MEMBER(btFemLinksInterpolatedQuat, btMultiBody, btQuaternion, m_baseQuat_interpolate);
BULLETFEM_PRIVATE_MEMBER(btFemWorldTime, btDiscreteDynamicsWorld, btScalar, m_localTime);
BULLETFEM_PRIVATE_MEMBER(btFemPredictiveManifolds, btDiscreteDynamicsWorld, btAlignedObjectArray<btPersistentManifold*>,
                         m_predictiveManifolds);

#undef BULLETFEM_PRIVATE_MEMBER
