// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>

#include "bullet_fem/fem/mesh/material.h"

namespace bullet_fem
{

/// A material and a mesh size, with the step of all scenes.
struct StiffnessCase
{
    static constexpr double kStep = 1.0 / 60;  ///< h [s]
    static constexpr double kDensity = 1000;   ///< rho [kg/m3]

    double m_young = 1e6;  ///< E [Pa]
    double m_edge = 0.01;  ///< e, of the cells [m]

    /// Dimensionless stiffness h^2 E / (rho e^2) [-]: the square of the edges that a wave passes in a step.
    double number() const { return kStep * kStep * m_young / (kDensity * m_edge * m_edge); }

    Material material() const
    {
        Material material;
        material.m_youngModulus = m_young;
        material.m_poissonRatio = 0.3;
        material.m_density = kDensity;
        material.m_stiffnessDamping = 0.005;  // as by default in the plug-in [s]
        return material;
    }
};

/// A number of iterations per step.
struct WorkCount
{
    int m_steps = 0;
    int m_most = 0;
    long m_sum = 0;

    void add(int count)
    {
        ++m_steps;
        m_most = std::max(m_most, count);
        m_sum += count;
    }

    double mean() const { return m_steps > 0 ? static_cast<double>(m_sum) / m_steps : 0; }
};

/// Result of a cube in contact.
struct CubeFigures
{
    double m_force = 0;    ///< mean force over the theory's, at the end [-]
    double m_fastest = 0;  ///< largest speed of a node [m/s]; between jaws over theirs [-]
    /// The cube has left the jaws, or a node is not finite.
    bool m_isThrown = false;
    bool m_isTooSoft = false;  ///< BT_FEM_TOO_SOFT: it collapses under its weight
    WorkCount m_rounds;        ///< outer iterations; known of the solver alone, not in a world
    WorkCount m_sweeps;        ///< in all outer iterations
    WorkCount m_iterations;    ///< of conjugate gradients, in the corrective solves
};

}  // namespace bullet_fem
