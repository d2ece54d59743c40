// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/beam/beam_case.h"

#include <stdexcept>

#include "bullet_fem/fem/mesh/generators.h"

namespace bullet_fem
{

namespace
{

constexpr int kMaxCells = 32;  // per metre

}  // namespace

int beamCells(int tets)
{
    for (int n = 1; n <= kMaxCells; ++n)
        if (24 * n * n * n == tets) return n;
    throw std::invalid_argument("--tets is " + std::to_string(tets) +
                                ", must be 24 n^3 with n in [1, 32] cells per metre; try 192, 1536, 12288, 24000, "
                                "41472, 98304 or 192000");
}

BeamCase makeBeamCase(int cellsPerMetre, const Material& material)
{
    if (cellsPerMetre < 1 || cellsPerMetre > kMaxCells)
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
