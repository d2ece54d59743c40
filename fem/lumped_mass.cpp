// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/lumped_mass.h"

namespace bullet_fem
{

std::vector<double> massesOf(const TetMesh& mesh, const std::vector<double>& filled, double density)
{
    std::vector<double> mass(mesh.nodeCount(), 0.0);
    for (int e = 0; e < mesh.tetCount(); ++e)
        for (int node : mesh.tets()[e])
            mass[node] += density * mesh.tetVolume(e) * (filled.empty() ? 1.0 : filled[e]) / 4;
    return mass;
}

}  // namespace bullet_fem
