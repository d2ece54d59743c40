// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

#include "bullet_fem/fem/body/body.h"
#include "bullet_fem/fem/common/export.h"

namespace bullet_fem
{

constexpr double kMostInitialStress = 1e13;  ///< of every number [Pa], as of Young's modulus

/// Gives every element of a body a stress sigma_0 [Pa] besides the one of its strain: of heat, fibres or residual
/// stress, in the frame that turns with the element, that is in the axes of the rest shape; tension positive. The
/// stress is sigma = R (2 mu eps + lambda tr(eps) I + sigma_0) R^T then (docs/theory.md, Initial stress). One tensor an
/// element in the mesh's order; none for none at all. It may change in every step: neither the stiffness nor its factor
/// knows it. Allocates when a body that had none gets some. Throws std::invalid_argument, naming the value, on a wrong
/// number of tensors, and on a number that is not in [-1e13, 1e13]; the body keeps what it had.
BULLETFEM_API void setInitialStress(Body& body, const std::vector<SymmetricTensor>& perElement);

/// True if it could be set; else `why` (if given) names the value, the range and the remedy.
BULLETFEM_API bool isInitialStress(const BodyModel& model, const std::vector<SymmetricTensor>& perElement,
                                   std::string* why = nullptr);

}  // namespace bullet_fem
