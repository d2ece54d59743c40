// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <vector>

#include "bullet_bridge/body/fem_soft_body.h"

/// Check of a body's stiffness against its own weight; see BT_FEM_TOO_SOFT.
class btFemTooSoft
{
public:
    /// Sums the masses, and repeats the check only if mass, rest shape, material or gravity have changed since the last
    /// one. Allocates if the body has more connected components than before.
    bool look(const bullet_fem::FemSoftBody& fem);

private:
    struct Span
    {
        double m_low, m_high;
    };

    double extentAlong(const bullet_fem::TetMesh& mesh, const bullet_fem::Vec3& direction);
    double weightStrain(const bullet_fem::FemSoftBody& fem);

    std::weak_ptr<const bullet_fem::RestShape> m_shape;  // at the last check, as the next two members
    bullet_fem::Vec3 m_gravity;                          // [m/s2]
    double m_mass = 0;                                   // [kg]
    bool m_isTooSoft = false;
    std::vector<Span> m_spans;  // of connected components; scratch
};
