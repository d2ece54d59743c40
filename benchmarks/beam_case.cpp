// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/beam_case.h"

#include <stdexcept>

#include "bullet_fem/fem/generators.h"

namespace bullet_fem
{

BeamCase makeBeamCase(int cellsPerMetre, const Material& material)
{
    if (cellsPerMetre < 1 || cellsPerMetre > 32)
        throw std::invalid_argument("cells per metre is " + std::to_string(cellsPerMetre) +
                                    ", must be in [1, 32]; 4 gives 1,536 tets and 8 gives 12,288");
    material.validate();

    const double length = 4, width = 1, height = 1;
    const TetMesh mesh =
        makeBox({length, width, height}, {4 * cellsPerMetre, cellsPerMetre, cellsPerMetre}, {}, CellSplit::kuhnSix);
    BeamCase beam;
    beam.m_positions = mesh.restPositions();
    beam.m_tets = mesh.tets();
    beam.m_material = material;

    const double close = 1e-9;
    for (int i = 0; i < mesh.nodeCount(); ++i)
    {
        const Vec3& X = beam.m_positions[i];
        if (X.x < close) beam.m_clampedNodes.push_back(i);
        if (norm(X - Vec3{length, 0, 0}) < close) beam.m_tipNode = i;
    }
    return beam;
}

std::vector<double> lumpedNodeMasses(const BeamCase& beam)
{
    std::vector<double> masses(beam.m_positions.size(), 0.0);
    for (const Tet& tet : beam.m_tets)
    {
        const Vec3& X0 = beam.m_positions[tet[0]];
        const Mat3 Dm = Mat3::fromColumns(beam.m_positions[tet[1]] - X0, beam.m_positions[tet[2]] - X0,
                                          beam.m_positions[tet[3]] - X0);
        const double volume = determinant(Dm) / 6;
        for (int i : tet) masses[i] += beam.m_material.m_density * volume / 4;
    }
    return masses;
}

}  // namespace bullet_fem
