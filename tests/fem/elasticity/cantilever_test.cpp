// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The clamped bar, 10 x 1 x 1 m, n cells through its thickness: bending, torsion, locking of linear tetrahedra, and
// their rate of convergence. The bands were measured with an independent prototype.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "fem/scenes/elasticity_scenes.h"

namespace bullet_fem
{
namespace
{

constexpr double kLength = 10;  // [m]; the section is 1 m x 1 m
constexpr double kYoung = 1e6;  // [Pa]

bool clamped(const Vec3& X)
{
    return X.x == 0;
}
bool onEnd(const Vec3& X)
{
    return X.x == kLength;
}

RestShape bar(CellSplit split, int n, double poisson)
{
    Material material = elasticMaterial(kYoung, poisson);
    material.m_meanDilatation = MeanDilatation::off;
    return RestShape(makeBox({kLength, 1, 1}, {10 * n, n, n}, {}, split), material);
}

// Timoshenko's F L^3 / (3 E I) + F L / (kappa G A) for F = 1 N.
double timoshenkoDeflection(double nu)
{
    const double I = 1.0 / 12, A = 1, G = kYoung / (2 * (1 + nu)), kappa = 10 * (1 + nu) / (12 + 11 * nu);
    return std::pow(kLength, 3) / (3 * kYoung * I) + kLength / (kappa * G * A);
}

// A shear load of 1 N down, spread over the end face by area.
std::vector<Vec3> endShear(const TetMesh& mesh)
{
    const std::vector<double> area = faceAreas(mesh, onEnd);
    std::vector<Vec3> force(area.size());
    for (std::size_t i = 0; i < area.size(); ++i) force[i].z = -area[i];
    return force;
}

double deflectionRatio(const RestShape& shape)
{
    const std::vector<Vec3> u = LinearSystem(shape, clamped).displacement(endShear(shape.m_mesh));
    return -weightedMean(faceAreas(shape.m_mesh, onEnd), u).z / timoshenkoDeflection(shape.m_material.m_poissonRatio);
}

// The stiffness against a torque at the free end, over St-Venant's G J / L with J = .1406 a^4. The forces of the torque
// are proportional to area and to the distance from the axis; the angle is the work-conjugate one.
double torsionRatio(const RestShape& shape)
{
    const std::vector<double> area = faceAreas(shape.m_mesh, onEnd);
    std::vector<Vec3> force(area.size());
    double torque = 0, work = 0;
    for (std::size_t i = 0; i < area.size(); ++i)
    {
        const Vec3 r = shape.m_mesh.restPositions()[i] - Vec3{kLength, .5, .5};
        force[i] = area[i] * cross({1, 0, 0}, r);
        torque += dot(cross(r, force[i]), {1, 0, 0});
    }
    const std::vector<Vec3> u = LinearSystem(shape, clamped).displacement(force);
    for (std::size_t i = 0; i < u.size(); ++i) work += dot(force[i], u[i]);
    const double angle = work / torque;
    return torque / angle / (shape.m_material.lameMu() * 0.1406 / kLength);
}

// The mode with the largest mass-weighted mean displacement along the bar.
const Mode& maxAxial(const std::vector<Mode>& modes, const std::vector<double>& mass)
{
    const auto along = [&mass](const Mode& m) { return std::fabs(weightedMean(mass, m.m_shape).x); };
    return *std::max_element(modes.begin(), modes.end(),
                             [&along](const Mode& a, const Mode& b) { return along(a) < along(b); });
}

struct Case
{
    const char* m_name;
    CellSplit m_split;
    int m_cells;
    std::array<double, 4> m_deflection;  // ratio at nu 0, .3, .45, .49
    double m_frequency;                  // lowest bending frequency over Euler's, nu .3
    double m_torsion;                    // nu .3
};

constexpr std::array<double, 4> kPoissonRatios = {0, .3, .45, .49};

void PrintTo(const Case& c, std::ostream* out)
{
    *out << c.m_name;
}

std::string nameOf(const testing::TestParamInfo<Case>& info)
{
    return info.param.m_name;
}

class ElasticityCantilever : public testing::TestWithParam<Case>
{
};

// 1 % of the table, plus half a unit of its last digit.
TEST_P(ElasticityCantilever, LocksAsMuchAsLinearTetrahedraDo)
{
    for (std::size_t k = 0; k < kPoissonRatios.size(); ++k)
    {
        const double band = GetParam().m_deflection[k];
        EXPECT_NEAR(deflectionRatio(bar(GetParam().m_split, GetParam().m_cells, kPoissonRatios[k])), band,
                    0.01 * band + 5e-4)
            << "nu " << kPoissonRatios[k];
    }
}

TEST_P(ElasticityCantilever, HasTheRecordedTorsionalStiffness)
{
    EXPECT_NEAR(torsionRatio(bar(GetParam().m_split, GetParam().m_cells, .3)), GetParam().m_torsion,
                0.01 * GetParam().m_torsion);
}

// f1 = (1.8751^2 / 2 pi) sqrt(E I / (rho A)) / L^2, up to the band; axial sqrt(E / rho) / (4 L), which linear
// tetrahedra meet within 1 % on two cells: its strain is nearly uniform across the section.
TEST_P(ElasticityCantilever, HasTheLowestBendingAndAxialFrequencies)
{
    const RestShape shape = bar(GetParam().m_split, GetParam().m_cells, .3);
    const std::vector<Mode> modes = LinearSystem(shape, clamped).lowestModes(8);
    const double rho = shape.m_material.m_density, bending = 1.8751 * 1.8751 * std::sqrt(kYoung / 12 / rho) / 100;
    EXPECT_NEAR(modes.front().m_omega / bending, GetParam().m_frequency, 0.01 * GetParam().m_frequency);

    const double axial = 2 * 3.14159265358979 * std::sqrt(kYoung / rho) / (4 * kLength);
    const Mode& found = maxAxial(modes, shape.m_lumpedMass);
    EXPECT_NEAR(found.m_omega / axial, 1, 0.01);
}

// Steps come to rest at the deflection of the assembled stiffness; at deflections of 1e-6 L, where both are linear.
TEST_P(ElasticityCantilever, StepsComeToRestAtTheStaticDeflection)
{
    const TetMesh mesh = makeBox({kLength, 1, 1}, {10 * GetParam().m_cells, GetParam().m_cells, GetParam().m_cells}, {},
                                 GetParam().m_split);
    const Material material = elasticMaterial(kYoung, .3, 1);
    Body body = makeBody(mesh, material, clamped, 1);
    std::vector<Vec3> force = endShear(mesh), u = body.m_state.m_x;
    for (Vec3& f : force) f *= 2.5e-3;
    body.m_loads.m_force = force;
    const double L = kLength;
    EXPECT_LE(relax(body, 1e-13 * L), 1e-13 * L);
    for (std::size_t i = 0; i < u.size(); ++i) u[i] = body.m_state.m_x[i] - u[i];
    const std::vector<Vec3> exact = LinearSystem(RestShape(mesh, material), clamped).displacement(force);
    const double largest = largestDistance(exact, std::vector<Vec3>(exact.size()));
    EXPECT_GT(largest, 2e-7 * L);
    EXPECT_LE(largestDistance(u, exact), 1e-5 * largest);  // rotations of 1e-6, and PCG to 1e-8 of a stiff system
}

INSTANTIATE_TEST_SUITE_P(
    Meshes, ElasticityCantilever,
    testing::Values(Case{"FiveTet2", CellSplit::alternatingFive, 2, {.642, .673, .638, .603}, 1.211, 2.08},
                    Case{"FiveTet4", CellSplit::alternatingFive, 4, {.877, .886, .860, .834}, 1.056, 1.30},
                    Case{"Kuhn2", CellSplit::kuhnSix, 2, {.550, .504, .299, .104}, 1.290, 2.33},
                    Case{"Kuhn4", CellSplit::kuhnSix, 4, {.824, .787, .598, .288}, 1.082, 1.37}),
    nameOf);

class ElasticityCantileverSlow : public testing::TestWithParam<Case>
{
};

// Linear elements converge with the square of their size once they resolve the bending; from 4 to 8 cells the measured
// order is 1.64 and 1.60, from 2 to 4 cells 1.52 and 1.22.
TEST_P(ElasticityCantileverSlow, ConvergesToTimoshenko)
{
    std::array<double, 3> error;
    for (int k = 0; k < 3; ++k) error[k] = 1 - deflectionRatio(bar(GetParam().m_split, 2 << k, .3));
    const double coarse = std::log2(error[0] / error[1]), fine = std::log2(error[1] / error[2]);
    EXPECT_GT(coarse, 1.1);
    EXPECT_GT(fine, 1.5);
    EXPECT_GT(fine, coarse);
    EXPECT_NEAR(1 - error[2], GetParam().m_deflection[1], 0.01 * GetParam().m_deflection[1]);
}

INSTANTIATE_TEST_SUITE_P(
    Meshes, ElasticityCantileverSlow,
    testing::Values(Case{"FiveTet8", CellSplit::alternatingFive, 8, {.966, .963, .947, .932}, 1.012, 1.08},
                    Case{"Kuhn8", CellSplit::kuhnSix, 8, {.949, .930, .836, .581}, 1.021, 1.10}),
    nameOf);

// q L^4 / (8 E I) + q L^2 / (2 kappa G A) under its own weight q = rho A g, within the band of the end load.
TEST(ElasticityCantileverOwnWeight, LocksLikeTheEndLoad)
{
    const RestShape shape = bar(CellSplit::alternatingFive, 4, .3);
    const double q = shape.m_material.m_density * 9.81, L = kLength, nu = .3;
    std::vector<Vec3> weight(shape.m_lumpedMass.size());
    for (std::size_t i = 0; i < weight.size(); ++i) weight[i].z = -9.81 * shape.m_lumpedMass[i];
    const std::vector<Vec3> u = LinearSystem(shape, clamped).displacement(weight);
    const double kappaG = 10 * (1 + nu) / (12 + 11 * nu) * shape.m_material.lameMu();
    const double exact = q * std::pow(L, 4) / (8 * kYoung / 12) + q * L * L / (2 * kappaG);
    EXPECT_NEAR(-weightedMean(faceAreas(shape.m_mesh, onEnd), u).z / exact, 0.886, 0.01 * 0.886);
}

}  // namespace
}  // namespace bullet_fem
