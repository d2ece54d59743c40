// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// A ball on a thin plate clamped in a block: graded cages must not suppress bending of the plate.
#include <gtest/gtest.h>

#include "fem/scenes/elasticity_scenes.h"
#include "fem/scenes/test_surfaces.h"

namespace bullet_fem
{
namespace
{

constexpr double kPlateLength = 0.8, kWidth = 0.3, kThickness = 0.05;  // of the plate [m]
constexpr double kPlateYoung = 1e6;                                    // [Pa]

/// The block ends at x = 0, the ball is around the plate's end.
SurfaceMesh ballOnAPlate()
{
    const SurfaceMesh block = boxSurface({-0.3, -0.2, -0.2}, {0, 0.2, 0.2});
    const SurfaceMesh plate =
        boxSurface({-0.05, -kWidth / 2, -kThickness / 2}, {kPlateLength, kWidth / 2, kThickness / 2});
    return joined(joined(block, plate), sphereSurface(0.2, {kPlateLength + 0.1, 0, 0}, 2));
}

/// Displacement of the ball under 1 N on it, with all nodes within the block fixed [m].
double deflection(const Cage& cage, const SurfaceMesh& surface)
{
    const RestShape shape(cage.m_mesh, elasticMaterial(kPlateYoung, 0.3), cage.m_filled);
    const auto onBall = [&](std::size_t vertex) { return surface.m_vertices[vertex].x > kPlateLength; };
    std::vector<Vec3> force(shape.m_mesh.nodeCount());
    double count = 0, sum = 0;
    const auto forEachWeight = [&](const auto& act)
    {
        for (std::size_t v = 0; v < surface.m_vertices.size(); ++v)
            for (int a = 0; a < 4 && onBall(v); ++a)
                act(cage.m_mesh.tets()[cage.m_embedding[v].m_tet][a], cage.m_embedding[v].m_weights[a]);
    };
    forEachWeight([&](int, double weight) { count += weight; });
    forEachWeight([&](int node, double weight) { force[node].z -= weight / count; });
    const LinearSystem system(shape, [](const Vec3& X) { return X.x < 1e-9; });
    const std::vector<Vec3> u = system.displacement(force);
    forEachWeight([&](int node, double weight) { sum -= u[node].z * weight / count; });
    return sum;
}

/// Deflection of the plate as a beam loaded at the ball's centre; the ball covers part of its length.
double beamDeflection()
{
    const double L = kPlateLength - 0.1, I = kWidth * kThickness * kThickness * kThickness / 12, arm = 0.2;
    return (L * L * L / 3 + arm * L * L + arm * arm * L) / (kPlateYoung * I);
}

// Measured over the beam's deflection: .03 with cells of 0.15 m, .24 with 12,002 equal elements, .63 with 10,534 graded
// ones. Linear tetrahedra, two or three across, are too stiff; the beam is an upper bound within a few per cent.
TEST(ElasticityCage, GradedPlatesBend)
{
    const SurfaceMesh surface = ballOnAPlate();
    CageSettings settings = withCell(0.15);
    const Cage coarse = makeCage(surface, settings), alike = makeCage(surface, withCell(0.0375));
    settings.m_cellsAcross = 2;
    const Cage graded = makeCage(surface, settings);
    EXPECT_LT(graded.m_report.m_tets, alike.m_report.m_tets);
    EXPECT_LT(deflection(coarse, surface), 0.05 * beamDeflection());
    EXPECT_LT(deflection(alike, surface), 0.3 * beamDeflection());
    EXPECT_GT(deflection(graded, surface), 0.57 * beamDeflection());
    EXPECT_LT(deflection(graded, surface), 1.05 * beamDeflection());
}

}  // namespace
}  // namespace bullet_fem
