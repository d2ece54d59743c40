// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_bridge/rigid/impact_patches.h"

namespace bullet_fem
{

/// Stresses of the waves that impacts of a step start in bodies.
class ImpactStresses
{
public:
    /// Finds them: with the speed v at which a pressed contact closes as the step begins v Z Z' / (Z + Z'), Z and Z'
    /// the impedances of both (waveImpedance), and v Z against rigid objects. Speeds up to `least` [m/s] are no
    /// impacts.
    void find(const ImpactScene& scene, double least);

    /// The largest one of a body of the scene [Pa], >= 0; 0 without impact.
    double of(std::size_t body) const { return m_stresses[body]; }

private:
    double impedanceOf(const ImpactScene& scene, int body);

    std::vector<double> m_stresses, m_impedances;  // per body; impedance 0: not known yet
};

}  // namespace bullet_fem
