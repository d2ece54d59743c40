// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/btFemMaterial.h"
#include "bullet_fem/fem/cage/surface_mesh.h"
#include "bullet_fem/fem/mesh/tet_mesh.h"

class btSoftBody;
struct btSoftBodyWorldInfo;

namespace bullet_fem
{

/// Like the cube of Bullet's soft demo, which has 1,580 elements: edges of 2 m around the origin, 1,715 elements.
TetMesh exampleCube();

/// Like the torus of Bullet's data, which has 4,436 elements: tube of 0.25 m, 1.5 m across, around y; 1,920 elements.
TetMesh exampleTorus();

/// Like the bunny of Bullet's soft demo: a lumpy body with two ears in a box of 5.8 x 8.7 x 11.8 m around the origin.
SurfaceMesh lumpySurface();

/// Makes a body as Bullet's examples do: CreateFromTetGenData, with links along all edges.
btSoftBody* createFromTetGenText(btSoftBodyWorldInfo& info, const TetMesh& mesh);

/// Minimum of element volume over rest volume [-]; negative for an inverted element.
double smallestVolumeRatio(const btSoftBody& body);

/// Elastic energy of the isotropic corotational law, sum of V (mu |S - I|^2 + lambda / 2 tr(S - I)^2) with F = R S [J].
double elasticEnergy(const btSoftBody& body, double young, double poisson, btFemElasticLaw law);

}  // namespace bullet_fem
