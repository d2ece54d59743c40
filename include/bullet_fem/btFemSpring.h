// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>

#include "LinearMath/btVector3.h"
#include "bullet_fem/fem/common/export.h"

struct btFemRayHit;

/// A spring that pulls a point of a soft body to a target in the world, as a mouse or a hand does: the force k (target
/// - x) - d v, limited to m_maxForce, with position x and velocity v at the end of the step (implicit). Stable for any
/// stiffness and step.
struct BULLETFEM_API btFemSpring
{
    int m_nodes[3] = {0, 0, 0};         ///< nodes whose weighted mean is the point; ignored where the weight is 0
    btScalar m_weights[3] = {1, 0, 0};  ///< barycentric weights [-], sum 1
    btVector3 m_target{0, 0, 0};        ///< target of the point, in the world [m]
    btScalar m_stiffness = 1000;        ///< k [N/m], in [0, 1e12]; practically rigid beyond some mass / step^2
    btScalar m_damping = 0;             ///< d [N s/m], in [0, 1e12], of the point's velocity in the world
    /// Maximum force [N], in [0, 1e12]; 0: no limit. Some 20 times the weight keeps a jumping target from distorting
    /// the body violently.
    btScalar m_maxForce = 0;

    /// A spring at the point of a ray's hit, with the target there. All other values are defaults.
    static btFemSpring at(const btFemRayHit& hit);

    /// True if every value is in its range; else `why` (if given) names the value, the range and the remedy.
    bool valid(std::string* why = nullptr) const;
};
