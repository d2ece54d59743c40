// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/mesh/rest_shape.h"

namespace bullet_fem
{

/// Stiffness-warped elements of one body [Mueller & Gross 2004] as three loops over the elements, each with a few dozen
/// multiplications per element. Arrays over nodes and elements are those of the mesh. Volume changes are averaged over
/// the shape's patches, if it has any.

/// R_e <- polar rotation of F_e = sum (x_a - x_0) g_a^T, started from the R_e given.
void updateElementRotations(const RestShape& shape, const std::vector<Vec3>& x, std::vector<Mat3>& R);

/// force_i += -sum over e of R_e K_e (R_e^T x_e - X_e) - damping K' v [N]; K' = sum R_e K_e R_e^T, `damping` [s].
/// `tension`, if given, receives V_e sigma_e^+ (6 entries: xx, yy, zz, yz, xz, xy) [J]: the positive spectral part of
/// the elastic stress in the element's own frame.
void addElasticForces(const RestShape& shape, const std::vector<Vec3>& x, const std::vector<Vec3>& v, double damping,
                      const std::vector<Mat3>& R, std::vector<Vec3>& force,
                      std::vector<std::array<double, 6>>* tension);

/// out += stiffnessFactor K' p + tensionFactor T p, T = sum V_e (g_a^T sigma_e^+ g_b) I; `tension` empty for T = 0.
void addStiffnessProduct(const RestShape& shape, const std::vector<Mat3>& R,
                         const std::vector<std::array<double, 6>>& tension, const std::array<double, 2>& factors,
                         const std::vector<Vec3>& p, std::vector<Vec3>& out);

}  // namespace bullet_fem
