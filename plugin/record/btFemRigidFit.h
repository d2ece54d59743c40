// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "LinearMath/btVector3.h"
#include "bullet_bridge/body/fem_soft_body.h"

/// Mass-weighted best rigid fit X -> c + R (X - C) of the rest shape to a body's nodes: R is the rotation of sum m (x -
/// c) (X - C)^T. [Mueller et al. 2005, Meshless deformations based on shape matching]
class btFemRigidFit
{
public:
    explicit btFemRigidFit(const bullet_fem::FemSoftBody& fem);

    /// Position of a node in the undeformed body, world [m].
    btVector3 place(int node) const;

    /// The rotation R.
    const bullet_fem::Mat3& rotation() const { return m_rotation; }

private:
    const std::vector<bullet_fem::Vec3>& m_X;
    bullet_fem::Vec3 m_center, m_restCenter;
    bullet_fem::Mat3 m_rotation;
};
