// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Bodies of several materials against closed formulas: layers in parallel and in series, bending of a laminate, a stiff
// sphere in a soft one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "benchmarks/reference/warped_elements.h"
#include "bullet_fem/fem/step/stress.h"
#include "fem/factor/block_matrix.h"
#include "fem/scenes/elasticity_scenes.h"
#include "fem/scenes/lattice_box.h"

namespace bullet_fem
{
namespace
{

constexpr double kRegionBar = 2, kRegionSide = .5;  // [m]

Vec3 middleOf(const TetMesh& mesh, int e)
{
    Vec3 sum;
    for (const int node : mesh.tets()[e]) sum += 0.25 * mesh.restPositions()[node];
    return sum;
}

ElementMaterials inRegions(const TetMesh& mesh, const std::function<int(const Vec3&)>& region,
                           const std::map<int, Material>& table)
{
    std::vector<int> labels;
    for (int e = 0; e < mesh.tetCount(); ++e) labels.push_back(region(middleOf(mesh, e)));
    return ElementMaterials::ofLabels(labels, table);
}

bool atFoot(const Vec3& X)
{
    return X.x == 0;
}
bool atHead(const Vec3& X)
{
    return X.x == kRegionBar;
}
int layerOf(const Vec3& X)
{
    return X.z < kRegionSide / 2 ? 1 : 2;
}
int halfOf(const Vec3& X)
{
    return X.x < kRegionBar / 2 ? 1 : 2;
}

std::vector<Vec3> forcesOf(const Body& body)
{
    std::vector<Vec3> force(body.m_state.m_x.size()), rest(force.size());
    addElasticForces(body.m_model->shape(), body.m_state.m_x, rest, 0, elementRotations(body), force, nullptr);
    return force;
}

// With equal Poisson's ratios both layers contract equally, so that uniform strain is the solution: the bar's force is
// (E_1 A_1 + E_2 A_2) eps (Voigt), and each layer has its stress E eps.
TEST(ElasticityRegions, LayersSideBySideShareTheStrain)
{
    const double strain = .01, nu = .3, E[2] = {1e6, 3e7};
    const TetMesh mesh = shuffledMesh(makeBox({kRegionBar, kRegionSide, kRegionSide}, {8, 4, 4}), 0, 3);
    const ElementMaterials materials =
        inRegions(mesh, layerOf, {{1, elasticMaterial(E[0], nu, 1)}, {2, elasticMaterial(E[1], nu, 1)}});
    Body body = makeBody(
        mesh, materials, [](const Vec3& X) { return atFoot(X) || atHead(X); }, 1);
    std::vector<Vec3> exact = mesh.restPositions();
    for (Vec3& x : exact) x = {(1 + strain) * x.x, (1 - nu * strain) * x.y, (1 - nu * strain) * x.z};
    for (std::size_t i = 0; i < exact.size(); ++i)
        if (body.m_state.m_fixed[i]) body.m_state.m_x[i] = exact[i];
    EXPECT_LE(relax(body, 1e-13), 1e-13);
    EXPECT_LE(largestDistance(body.m_state.m_x, exact), 1e-11);

    double force = 0;
    const std::vector<Vec3> all = forcesOf(body);
    for (std::size_t i = 0; i < all.size(); ++i)
        if (atHead(mesh.restPositions()[i])) force -= all[i].x;
    EXPECT_NEAR(force, (E[0] + E[1]) / 2 * kRegionSide * kRegionSide * strain, 1e-8 * force);
    std::vector<Stress> stress;
    elementStresses(body, stress);
    for (int e = 0; e < mesh.tetCount(); ++e)
    {
        const double expected = E[layerOf(middleOf(mesh, e)) - 1] * strain;
        EXPECT_NEAR(stress[e].xx, expected, 1e-8 * E[1] * strain);
        EXPECT_NEAR(stress[e].yy, 0, 1e-8 * E[1] * strain);
        EXPECT_NEAR(elementStress(body, e).xx, expected, 1e-8 * E[1] * strain);
    }
}

// Without lateral strains the halves of a bar carry equal forces and add their elongations (Reuss).
TEST(ElasticityRegions, HalvesInSeriesShareTheForce)
{
    const double force = 500, E[2] = {1e6, 3e7}, area = kRegionSide * kRegionSide;
    const TetMesh mesh = makeBox({kRegionBar, kRegionSide, kRegionSide}, {8, 3, 3});
    const ElementMaterials materials =
        inRegions(mesh, halfOf, {{1, elasticMaterial(E[0], 0, 1)}, {2, elasticMaterial(E[1], 0, 1)}});
    Body body = makeBody(mesh, materials, atFoot, 1);
    const std::vector<double> share = faceAreas(mesh, atHead);
    for (std::size_t i = 0; i < share.size(); ++i) body.m_loads.m_force[i].x = share[i] / area * force;
    EXPECT_LE(relax(body, 1e-12), 1e-12);
    const double elongation = force / area * kRegionBar / 2 * (1 / E[0] + 1 / E[1]);
    std::vector<Vec3> u = body.m_state.m_x;
    for (std::size_t i = 0; i < u.size(); ++i) u[i] -= mesh.restPositions()[i];
    EXPECT_NEAR(weightedMean(share, u).x, elongation, 1e-8 * elongation);
    std::vector<Stress> stress;
    elementStresses(body, stress);
    for (const Stress& s : stress) EXPECT_NEAR(s.xx, force / area, 1e-6 * force / area);
}

// One half yields and hardens, the other is elastic: under a slow pull the force is equal in both, and the permanent
// elongation is (sigma - sigma_y) / H of the yielding half, minus the constraint of the other half, which does not
// contract at the interface: 9 % of a half twice as long as wide.
TEST(ElasticityRegions, YieldEachByItsOwnLaw)
{
    const double E = 1e6, yield = 2e3, hardening = 2e5, stress = 4e3;
    Material elastic = elasticMaterial(E, 0, 1), soft = elastic;
    elastic.m_stiffnessDamping = soft.m_stiffnessDamping = 0.1;
    soft.m_yieldStress = yield;
    soft.m_hardeningModulus = hardening;
    const TetMesh mesh = makeBox({kRegionBar, kRegionSide, kRegionSide}, {8, 2, 2});
    Body body = makeBody(mesh, inRegions(mesh, halfOf, {{1, elastic}, {2, soft}}), atFoot);
    const std::vector<double> share = faceAreas(mesh, atHead);
    const auto hold = [&](double pull)
    {
        for (std::size_t i = 0; i < share.size(); ++i) body.m_loads.m_force[i].x = share[i] * pull;
        for (int k = 0; k < 300; ++k) step(body, StepSettings());
    };
    for (int k = 1; k <= 8; ++k) hold(stress * k / 8);
    hold(0);
    std::vector<Vec3> u = body.m_state.m_x;
    for (std::size_t i = 0; i < u.size(); ++i) u[i] -= mesh.restPositions()[i];
    const double left = kRegionBar / 2 * (stress - yield) / hardening;
    EXPECT_NEAR(weightedMean(share, u).x, 0.95 * left, 0.05 * left);
    for (int e = 0; e < mesh.tetCount(); ++e)
        EXPECT_EQ(body.m_state.m_equivalentPlasticStrain[e] > 0, halfOf(middleOf(mesh, e)) == 2) << e;
}

constexpr double kBeamLength = 10;  // [m]; the section is 1 m x 1 m

// Tip deflection under 1 N of a clamped beam of two layers, with E = lower below and upper above.
double tipDeflection(double lower, double upper, int n)
{
    const TetMesh mesh = makeBox({kBeamLength, 1, 1}, {10 * n, n, n});
    const ElementMaterials materials = inRegions(mesh, [](const Vec3& X) { return X.z < .5 ? 1 : 2; },
                                                 {{1, elasticMaterial(lower, .3)}, {2, elasticMaterial(upper, .3)}});
    const std::vector<double> area = faceAreas(mesh, [](const Vec3& X) { return X.x == kBeamLength; });
    std::vector<Vec3> force(area.size());
    for (std::size_t i = 0; i < area.size(); ++i) force[i].z = -area[i];
    return -weightedMean(area, LinearSystem(RestShape(mesh, materials), atFoot).displacement(force)).z;
}

// Bending stiffness of the transformed section: sum of E_i (I_i + A_i d_i^2) about the neutral axis [Gere & Goodno,
// Mechanics of Materials, Composite Beams].
double bendingStiffness(double lower, double upper)
{
    const double axis = (lower * .25 + upper * .75) / (lower + upper), own = std::pow(.5, 3) / 12;
    return lower * (own + .5 * std::pow(axis - .25, 2)) + upper * (own + .5 * std::pow(axis - .75, 2));
}

// Deflection over Euler's, extrapolated to zero element size with an error of second order.
double finestBending(double lower, double upper)
{
    const double exact = std::pow(kBeamLength, 3) / (3 * bendingStiffness(lower, upper));
    const double coarse = exact / tipDeflection(lower, upper, 4), fine = exact / tipDeflection(lower, upper, 6);
    return 1 / (fine + (fine - coarse) / (36. / 16 - 1));
}

// The contributions of shear and of the clamped section are taken from the homogeneous beam.
TEST(ElasticityRegions, LaminateBendsAsItsTransformedSection)
{
    const double uniform = finestBending(1e6, 1e6);
    EXPECT_NEAR(uniform, 1, 0.01);
    for (const double ratio : {3., 10.}) EXPECT_NEAR(finestBending(1e6, ratio * 1e6) / uniform, 1, 0.005) << ratio;
}

constexpr double kBall = .5;  // radius [m]

double bulkModulus(const Material& m)
{
    return m.lameLambda() + 2. / 3 * m.lameMu();
}

// The apparent bulk modulus of a sphere with uniform radial displacement of its surface: twice the energy over 9 eps^2
// V.
double apparentBulkModulus(const TetMesh& mesh, const ElementMaterials& materials)
{
    const double strain = 1e-4;
    std::vector<unsigned char> onSurface(mesh.nodeCount(), 0);
    for (const int node : mesh.surfaceNodes()) onSurface[node] = 1;
    int next = 0;
    Body body = makeBody(
        mesh, materials, [&](const Vec3&) { return onSurface[next++] != 0; }, 1);
    for (Vec3& x : body.m_state.m_x) x = (1 + strain) * x;
    EXPECT_LE(relax(body, 1e-13), 1e-13);
    for (Vec3& v : body.m_state.m_v) v = {};
    return 2 * mechanicalEnergy(body) / (9 * strain * strain * mesh.volume());
}

struct Inclusion
{
    double m_young, m_poisson;  // of the inner sphere; the matrix has 1e6 Pa and .3
};

// A sphere within a sphere has exactly Hashin's bulk modulus, which is Hashin and Shtrikman's bound [Hashin 1962]: K =
// K_m + f / (1 / (K_i - K_m) + 3 (1 - f) / (3 K_m + 4 G_m)). Displacement elements are stiffer, by 2.7 % of K with
// eight elements along the radius.
TEST(ElasticityRegions, BallInABallHasHashinsBulkModulus)
{
    const Material matrix = elasticMaterial(1e6, .3, 1);
    const double K = bulkModulus(matrix), G = matrix.lameMu();
    const TetMesh mesh = makeSphere(kBall, 16);
    for (const Inclusion& i : {Inclusion{1e8, .3}, {1e4, .3}, {1e7, .48}})
    {
        const Material inner = elasticMaterial(i.m_young, i.m_poisson, 1);
        const ElementMaterials materials =
            inRegions(mesh, [](const Vec3& X) { return norm(X) < .499 * kBall ? 1 : 2; }, {{1, inner}, {2, matrix}});
        double within = 0;
        for (int e = 0; e < mesh.tetCount(); ++e)
            if (materials.of(e) == inner) within += mesh.tetVolume(e);
        const double f = within / mesh.volume(), Ki = bulkModulus(inner);
        const double hashin = K + f / (1 / (Ki - K) + 3 * (1 - f) / (3 * K + 4 * G));
        const double found = apparentBulkModulus(mesh, materials);
        EXPECT_GE(found, hashin);
        EXPECT_LE(found, 1.03 * hashin);
        EXPECT_LE(found, f * Ki + (1 - f) * K);        // Voigt
        EXPECT_GE(found, 1 / (f / Ki + (1 - f) / K));  // Reuss
    }
}

// A nearly incompressible and a compressible material: some elements are in patches, some are not.
ElementMaterials mixture(const TetMesh& mesh, double ratio)
{
    return inRegions(mesh, [](const Vec3& X) { return X.x < .3   ? 1
                                                      : X.x < .6 ? 2
                                                                 : 3; },
                     {{1, elasticMaterial(1e5, .49)},
                      {2, elasticMaterial(ratio * 1e5, .2)},
                      {3, elasticMaterial(.1 * ratio * 1e5, .45)}});
}

// Forces of the step are minus the gradient of the energy, also for patches next to elements of other moduli.
TEST(ElasticityRegions, StressesAreTheEnergysGradient)
{
    const TetMesh mesh = shuffledMesh(makeBox({1, .5, .5}, {6, 3, 3}, {}, CellSplit::kuhnSix), .1, 1);
    Body body = makeBody(mesh, mixture(mesh, 30));
    RandomVectors random(4);
    for (Vec3& x : body.m_state.m_x) x = rotationAbout({1, 2, -1}, .7) * (x + .02 * random.next());
    for (Vec3& v : body.m_state.m_v) v = {};
    const double scale = mechanicalEnergy(body) / .1;
    // From rest, a step short against each period adds h f / m.
    Body moved(body.m_model);
    moved.m_state.m_x = body.m_state.m_x;
    StepSettings settings;
    settings.m_step = 1e-6;
    settings.m_tolerance = 1e-8;
    step(moved, settings);
    for (const int i : {0, 17, 40, 77})
        for (int c = 0; c < 3; ++c)
        {
            double& x = body.m_state.m_x[i][c];
            const double before = x, small = 1e-6;
            x = before + small;
            const double more = mechanicalEnergy(body);
            x = before - small;
            const double gradient = (more - mechanicalEnergy(body)) / (2 * small);
            x = before;
            EXPECT_NEAR(moved.m_state.m_v[i][c] * moved.m_state.m_mass[i] / settings.m_step, -gradient, 1e-4 * scale);
        }
}

// The kernels' A equals the factored one: at rest and rigidly rotated, one iteration converges.
TEST(ElasticityRegions, KernelsAndFactorAgree)
{
    const TetMesh mesh = makeBox({1, .5, .5}, {10, 5, 5});
    for (const double ratio : {1., 100., 1e4})
    {
        Body body = makeBody(mesh, mixture(mesh, ratio), atFoot);
        setGravity(body, {0, 0, -1e-6});
        StepSettings settings;
        settings.m_tolerance = 1e-4;
        const SolveReport report = step(body, settings);
        EXPECT_LE(report.m_iterations, 2) << ratio;
    }
}

// Large bending under its own weight. The factor includes the regions: with a stiff layer the body bends less, and
// takes fewer iterations.
TEST(ElasticityRegions, ContrastTakesNoMoreIterations)
{
    const TetMesh mesh = makeBox({1, .25, .25}, {16, 4, 4});
    const auto iterations = [&](double ratio)
    {
        Body body = makeBody(mesh,
                             inRegions(mesh, [](const Vec3& X) { return X.z < .125 ? 1 : 2; },
                                       {{1, elasticMaterial(2e5, .3)}, {2, elasticMaterial(ratio * 2e5, .3)}}),
                             atFoot);
        setGravity(body, {0, 0, -9.81});
        int sum = 0;
        StepSettings settings;
        settings.m_tolerance = 1e-3;
        for (int k = 0; k < 60; ++k) sum += step(body, settings).m_iterations;
        EXPECT_GT(smallestVolumeRatio(body), 0);
        return sum / 60.0;
    };
    const double uniform = iterations(1);
    for (const double ratio : {10., 100., 1e3, 1e4}) EXPECT_LE(iterations(ratio), uniform) << ratio;
}

}  // namespace
}  // namespace bullet_fem
