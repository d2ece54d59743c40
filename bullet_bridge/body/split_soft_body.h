// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <memory>
#include <vector>

#include "bullet_bridge/body/fem_soft_body.h"
#include "bullet_fem/fem/fracture/fracture.h"

namespace bullet_fem
{

/// Splits a FEM body between steps. Its btSoftBody gets copies of nodes, with their positions and velocities, appended
/// to its nodes, and the crack surfaces appended to its faces. `model` is that of the split mesh, `mass` [kg] has one
/// entry per node of it. Joints and attachments keep the original nodes; pins and targets apply to copies, too.
/// Discards contacts, and makes the mesh's boundary the collision surface.
void splitSoftBody(FemSoftBody& fem, const SplitMesh& split, const std::vector<double>& mass,
                   const std::shared_ptr<const BodyModel>& model, std::shared_ptr<ComplianceCache> compliance);

}  // namespace bullet_fem
