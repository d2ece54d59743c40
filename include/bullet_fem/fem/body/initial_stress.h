// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

#include "bullet_fem/fem/body/body.h"
#include "bullet_fem/fem/common/export.h"

namespace bullet_fem
{

/// Maximum magnitude of every component [Pa], equal to that of Young's modulus.
constexpr double kMaxInitialStress = 1e13;
[[deprecated("kMaxInitialStress")]] constexpr double kMostInitialStress = kMaxInitialStress;

/// Sets the initial stress sigma_0 [Pa] of a body's elements, tension positive: thermal, active or residual stress, in
/// the frame that rotates with the element, that is in the axes of the rest shape. The total stress is then sigma = R
/// (2 mu eps + lambda tr(eps) I + sigma_0) R^T (docs/theory.md, Initial stress). One tensor per element in the mesh's
/// order, or none to clear it. It may change in every step, because neither the stiffness nor its factor depend on it.
/// Allocates when a body that had none gets some. Throws std::invalid_argument, naming the value, on a wrong number of
/// tensors and on a component outside [-1e13, 1e13]; the body is unchanged then.
BULLETFEM_API void setInitialStress(Body& body, const std::vector<SymmetricTensor>& perElement);

/// True if setInitialStress() accepts these values; else `why` (if given) names the value, the range and the remedy.
BULLETFEM_API bool isInitialStress(const BodyModel& model, const std::vector<SymmetricTensor>& perElement,
                                   std::string* why = nullptr);

}  // namespace bullet_fem
