// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>

#include "LinearMath/btVector3.h"
#include "bullet_fem/fem/common/export.h"

struct btFemRayHit;

/// Pulls a point of a soft body to a place in the world, as a mouse or a hand does: a force k (target - x) - d v,
/// limited, with x and v those at the end of the step. Stable at any stiffness and step.
struct BULLETFEM_API btFemSpring
{
    int m_nodes[3] = {0, 0, 0};         ///< nodes that carry the point; those without weight do not matter
    btScalar m_weights[3] = {1, 0, 0};  ///< barycentric [-], sum 1
    btVector3 m_target{0, 0, 0};        ///< where the point shall be [m]
    btScalar m_stiffness = 1000;        ///< k [N/m], in [0, 1e12]; beyond some mass / step^2 it is as good as rigid
    btScalar m_damping = 0;             ///< d [N s/m], in [0, 1e12]: of the point's velocity in the world
    btScalar m_maxForce = 0;  ///< [N], in [0, 1e12]; 0: no limit. Some 20 times the weight keeps a target that jumps
                              ///< from tearing at the body

    /// A spring at the point that a ray has hit, at rest. Nothing else is set.
    static btFemSpring at(const btFemRayHit& hit);

    /// True if every value is in its range; else `why` (if given) names the value, the range and the remedy.
    bool valid(std::string* why = nullptr) const;
};
