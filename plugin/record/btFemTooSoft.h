// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <vector>

#include "bullet_bridge/body/fem_soft_body.h"

/// Whether a body is too soft for its own weight; see BT_FEM_TOO_SOFT.
class btFemTooSoft
{
public:
    /// Sums up the masses; where these, rest shape, material or gravity are others than at the last look it passes over
    /// nodes and elements. Allocates where the body has more connected parts than before.
    bool look(const bullet_fem::FemSoftBody& fem);

private:
    struct Span
    {
        double m_low, m_high;
    };

    double extentAlong(const bullet_fem::TetMesh& mesh, const bullet_fem::Vec3& direction);
    double weightStrain(const bullet_fem::FemSoftBody& fem);

    std::weak_ptr<const bullet_fem::RestShape> m_shape;  // as of the last look, as the next two
    bullet_fem::Vec3 m_gravity;                          // [m/s2]
    double m_mass = 0;                                   // [kg]
    bool m_isTooSoft = false;
    std::vector<Span> m_spans;  // of connected parts; scratch
};
