// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/stiffness/bent_bar.h"

#include <cmath>
#include <memory>

#include "benchmarks/stiffness/solver_jaws.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "bullet_fem/fem/step/stepping.h"

namespace bullet_fem
{
namespace
{

constexpr double kAngle = 0.5235987755982988;  // of the bar's arc [rad]
constexpr int kSteps = 4;                      // in which the bar swings back and is strained most

}  // namespace

int releaseBentBar(const StiffnessCase& of)
{
    const double length = 12 * of.m_edge, height = 2 * of.m_edge, radius = length / kAngle;
    const TetMesh mesh =
        makeBox({length, height, height}, {12, 2, 2}, {-length / 2, -height / 2, -height / 2}, CellSplit::kuhnSix);
    Body bar = makeFreeBody(mesh, of);
    for (int i = 0; i < mesh.nodeCount(); ++i)
    {
        const Vec3& X = mesh.restPositions()[i];
        const double angle = X.x / radius, own = radius - X.y;
        bar.m_state.m_x[i] = {own * std::sin(angle), radius - own * std::cos(angle), X.z};
    }
    StepSettings settings;
    settings.m_step = StiffnessCase::kStep;
    int most = 0;
    for (int k = 0; k < kSteps; ++k) most = std::max(most, step(bar, settings).m_iterations);
    return most;
}

}  // namespace bullet_fem
