// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/mesh/material.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"

namespace bullet_fem
{

/// What one element knows of its rest shape. The shape gradients g_1, g_2, g_3 [1/m] are the rows of D_m^-1,
/// g_0 = -(g_1 + g_2 + g_3); the deformation gradient is F = sum over a of (x_a - x_0) g_a^T.
struct RestElement
{
    Mat3 m_DmInverse;       ///< inverse of [X1-X0, X2-X0, X3-X0] [1/m]
    double m_lambdaVolume;  ///< lambda V_e times the filled fraction [J]
    double m_muVolume;      ///< mu V_e times the filled fraction [J]
    double m_volume;        ///< V_e times the filled fraction [m3]
};

/// Masses that a density gives the nodes: sum of rho V_e filled_e / 4 [kg]. `filled` is one fraction an element, or
/// empty for all 1.
std::vector<double> lumpedMasses(const TetMesh& mesh, const std::vector<double>& filled, double density);

/// A mesh of a material, ready to be stepped: built once, then const; shared by all bodies that are made of it.
struct RestShape
{
    /// `filled`: per element, the fraction in (0, 1] that its mass and stiffness are scaled by; empty for all 1.
    /// `massScale`: factor on all masses, > 0. Throws std::invalid_argument on a bad material, fraction or scale.
    RestShape(TetMesh mesh, const Material& material, const std::vector<double>& filled = {}, double massScale = 1);

    TetMesh m_mesh;
    Material m_material;
    std::vector<RestElement> m_elements;
    std::vector<double> m_lumpedMass;  ///< per node, sum of rho V_e / 4 [kg]; of 1 kg/m3 where the density is 0
};

}  // namespace bullet_fem
