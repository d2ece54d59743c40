// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/joints/soft_joints.h"

/// True if all rigid contact was switched off with m_cfg.collisions.
inline bool ignoresRigidBodies(const btSoftBody& body)
{
    using Flags = btSoftBody::fCollision;
    return (body.m_cfg.collisions & (Flags::RVSmask | Flags::RVDFmask)) == 0 || !body.hasContactResponse();
}

/// Bodies collide with each other if both have a flag for it in common; a body with itself by CL_SELF.
inline bool collide(const btSoftBody& a, const btSoftBody& b)
{
    using Flags = btSoftBody::fCollision;
    const int mask = &a == &b ? static_cast<int>(Flags::CL_SELF) : Flags::SVSmask & ~Flags::CL_SELF;
    return (a.m_cfg.collisions & b.m_cfg.collisions & mask) != 0 && a.hasContactResponse() && b.hasContactResponse() &&
           !bullet_fem::ignoresCollision(a, b) && !bullet_fem::ignoresCollision(b, a);
}
