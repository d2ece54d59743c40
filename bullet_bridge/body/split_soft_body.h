// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <vector>

#include "bullet_bridge/body/fem_soft_body.h"
#include "bullet_fem/fem/step/fracture.h"

namespace bullet_fem
{

/// Splits a FEM body between steps: its btSoftBody gets the copies of nodes, at their places and with their velocities,
/// after the nodes that it has, and faces for the sides of the cracks after those that it has; `model` is that of the
/// split mesh, `mass` [kg] of its nodes. What holds the body holds it on, with the nodes that were there before; pins
/// and targets hold copies, too. Contacts begin anew, with the boundary.
void splitSoftBody(FemSoftBody& fem, const SplitMesh& split, const std::vector<double>& mass,
                   const std::shared_ptr<const BodyModel>& model, std::shared_ptr<ComplianceCache> compliance);

}  // namespace bullet_fem
