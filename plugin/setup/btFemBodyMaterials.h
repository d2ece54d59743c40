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

/// The materials of a mesh at rest.
using btFemMaterialMaker = std::function<bullet_fem::ElementMaterials(const bullet_fem::RestMesh& rest)>;

/// Gives a body its materials; densities > 0 set the masses of nodes that are not pinned, now. Throws
/// std::invalid_argument, and changes nothing then, if there are none to be had or the body cannot be FEM.
void giveMaterials(btFemBodyRegistry& registry, btSoftBody* body, const btFemMaterialMaker& make);

// What btFemSoftBodySolver::setMaterial and setMaterials make them of. Throw std::invalid_argument when called with a
// mesh that they do not fit, or now, on values that are bad for any mesh.

btFemMaterialMaker materialOfAll(const btFemMaterial& material);
btFemMaterialMaker materialsOfTets(const std::vector<btFemMaterial>& perTet);
btFemMaterialMaker materialsOfRegions(const std::vector<int>& labels, const std::map<int, btFemMaterial>& ofLabel);
btFemMaterialMaker materialsByPlace(const std::function<btFemMaterial(const btVector3& centroid)>& materialAt);
