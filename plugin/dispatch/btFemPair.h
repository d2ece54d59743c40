// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/btFemReports.h"

struct btFemBodyRecord;

/// A pair of Bullet's dispatcher, from the side of its FEM body.
struct btFemPair
{
    /// Record of the FEM body, of two the awake one; null if neither is FEM.
    const btFemBodyRecord* m_record = nullptr;
    const btCollisionObject* m_other = nullptr;  ///< not null if m_record is not
    bool m_isFirst = false;                      ///< the FEM body is the first of the pair
};

/// Both must be in a world.
btFemPair femPair(const btCollisionObject& first, const btCollisionObject& second);

/// A contact point in the form of Bullet's manifolds.
struct btFemPairPoint
{
    btVector3 m_onFirst, m_onSecond;  ///< points on both surfaces at the start of the step, world [m]
    btVector3 m_normal;               ///< unit, from the second to the first
    btVector3 m_friction;             ///< impulse on the first [N s]
};

/// The contact must be one of pair.m_record's with pair.m_other.
btFemPairPoint pairPoint(const btFemPair& pair, const btFemContact& contact);
