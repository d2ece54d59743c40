// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <functional>
#include <map>
#include <vector>

#include "LinearMath/btVector3.h"
#include "bullet_bridge/body/soft_body_mesh.h"
#include "bullet_fem/btFemMaterial.h"
#include "bullet_fem/fem/mesh/element_materials.h"

class btFemBodyRegistry;
class btSoftBody;

/// Makes the materials of a mesh at rest.
using btFemMaterialMaker = std::function<bullet_fem::ElementMaterials(const bullet_fem::RestMesh& rest)>;

/// Gives a body its materials. A density > 0 sets the masses of nodes that are not pinned at once. Throws
/// std::invalid_argument, and changes nothing, if the materials are invalid or the body cannot be FEM.
void giveMaterials(btFemBodyRegistry& registry, btSoftBody* body, const btFemMaterialMaker& make);

// The materials of btFemSoftBodySolver::setMaterial and setMaterials. Values that are invalid for every mesh throw
// std::invalid_argument here; a mesh that does not fit makes the returned function throw it.

btFemMaterialMaker materialOfAll(const btFemMaterial& material);
btFemMaterialMaker materialsOfTets(const std::vector<btFemMaterial>& perTet);
btFemMaterialMaker materialsOfRegions(const std::vector<int>& labels, const std::map<int, btFemMaterial>& ofLabel);
btFemMaterialMaker materialsByPlace(const std::function<btFemMaterial(const btVector3& centroid)>& materialAt);
