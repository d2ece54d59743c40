// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/btFemReports.h"

struct btFemBodyRecord;

/// Two objects as Bullet's dispatcher pairs them, seen from the FEM body among them.
struct btFemPair
{
    const btFemBodyRecord* m_record = nullptr;   ///< of the FEM body, the one awake of two; null if neither is one
    const btCollisionObject* m_other = nullptr;  ///< not null if m_record is not
    bool m_isFirst = false;                      ///< the FEM body is the first of the pair
};

/// Both must be in a world.
btFemPair femPair(const btCollisionObject& first, const btCollisionObject& second);

/// A contact point in the manner of Bullet's manifolds.
struct btFemPairPoint
{
    btVector3 m_onFirst, m_onSecond;  ///< surfaces at the start of the step, world [m]
    btVector3 m_normal;               ///< unit, from the second to the first
    btVector3 m_friction;             ///< impulse on the first [N s]
};

/// The contact must be one of pair.m_record's with pair.m_other.
btFemPairPoint pairPoint(const btFemPair& pair, const btFemContact& contact);
