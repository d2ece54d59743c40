// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Elements of assumed strain: bending follows beam theory, and other properties are kept.
#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>
#include <array>
#include <cmath>
#include <string>
#include <tuple>

#include "bullet_fem/fem/body/body_snapshot.h"
#include "bullet_fem/fem/body/initial_stress.h"
#include "bullet_fem/fem/common/threads.h"
#include "bullet_fem/fem/step/stress.h"
#include "fem/scenes/elasticity_scenes.h"
#include "fem/scenes/lattice_box.h"
#include "fem/scenes/sparse_stiffness.h"
#include "support/allocation_counter.h"

namespace bullet_fem
{
namespace
{

constexpr double kBendYoung = 1e6;  // [Pa]

Material accurate(double nu, double density = 1000)
{
    Material material = elasticMaterial(kBendYoung, nu, density);
    material.m_bending = Bending::accurate;
    return material;
}

TetMesh bendingBar(const std::string& kind, int n)
{
    if (kind == "lattice") return makeLatticeBox({10 * n, n, n}, 1.0 / n);
    return makeBox({10, 1, 1}, {10 * n, n, n}, {}, kind == "kuhn" ? CellSplit::kuhnSix : CellSplit::alternatingFive);
}

bool isClampedEnd(const Vec3& X)
{
    return X.x == 0;
}
bool atEnd(const Vec3& X)
{
    return std::fabs(X.x - 10) < 1e-9;
}

// Solves K u = force with the components fixed for which isFixed(node, component).
template <class Fixed>
std::vector<Vec3> displacement(const RestShape& shape, const std::vector<Vec3>& force, const Fixed& isFixed)
{
    std::vector<Eigen::Triplet<double>> entries;
    const Eigen::SparseMatrix<double> K = sparseStiffness(shape);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(K.rows());
    const auto isFree = [&](Eigen::Index k) { return !isFixed(static_cast<int>(k / 3), static_cast<int>(k % 3)); };
    for (int column = 0; column < K.outerSize(); ++column)
        for (Eigen::SparseMatrix<double>::InnerIterator k(K, column); k; ++k)
            if (isFree(k.row()) && isFree(k.col())) entries.emplace_back(k.row(), k.col(), k.value());
    for (Eigen::Index k = 0; k < b.size(); ++k)
        if (isFree(k))
            b[k] = force[k / 3][static_cast<int>(k % 3)];
        else
            entries.emplace_back(k, k, 1);
    Eigen::SparseMatrix<double> A(K.rows(), K.cols());
    A.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(A);
    const Eigen::VectorXd u = factor.solve(b);
    std::vector<Vec3> result(force.size());
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = {u[3 * i], u[3 * i + 1], u[3 * i + 2]};
    return result;
}

// Nodes at x = 0 are fixed.
std::vector<Vec3> displacement(const RestShape& shape, const std::vector<Vec3>& force)
{
    return displacement(shape, force, [&](int i, int) { return isClampedEnd(shape.m_mesh.restPositions()[i]); });
}

// Tip deflection divided by Timoshenko's F L^3 / (3 E I) + F L / (kappa G A).
double tipOverTimoshenko(const TetMesh& mesh, const Material& material)
{
    const std::vector<double> area = faceAreas(mesh, atEnd);
    std::vector<Vec3> force(area.size());
    for (std::size_t i = 0; i < area.size(); ++i) force[i].z = -area[i];
    const double nu = material.m_poissonRatio, kappa = 10 * (1 + nu) / (12 + 11 * nu);
    const double exact = 4 * 1e3 / kBendYoung + 10 / (kappa * material.lameMu());
    return -weightedMean(area, displacement(RestShape(mesh, material), force)).z / exact;
}

TEST(ElasticityAccurateBending, TipDeflectsAsTimoshenkoSays)
{
    for (const std::string kind : {"kuhn", "five", "lattice"})
        for (const double nu : {.3, .45, .49, .499})
        {
            SCOPED_TRACE(kind + ", nu " + std::to_string(nu));
            EXPECT_NEAR(tipOverTimoshenko(bendingBar(kind, 4), accurate(nu)), 1, .03);
            EXPECT_NEAR(tipOverTimoshenko(bendingBar(kind, 3), accurate(nu)), 1, .04);
            EXPECT_NEAR(tipOverTimoshenko(bendingBar(kind, 2), accurate(nu)), 1, .06);
            EXPECT_NEAR(tipOverTimoshenko(bendingBar(kind, 1), accurate(nu)), 1, .16);
        }
}

// Bar of 32 x 1 x 1 m, n cells of six elements across, cells `ratio` times as long as thick.
double flatBarOverTimoshenko(int n, int ratio, double nu)
{
    const double length = 32;
    const TetMesh mesh = makeBox({length, 1, 1}, {32 * n / ratio, n, n}, {}, CellSplit::kuhnSix);
    const std::vector<double> area = faceAreas(mesh, [](const Vec3& X) { return std::fabs(X.x - 32) < 1e-9; });
    std::vector<Vec3> force(area.size());
    for (std::size_t i = 0; i < area.size(); ++i) force[i].z = -area[i];
    const double kappa = 10 * (1 + nu) / (12 + 11 * nu), mu = accurate(nu).lameMu();
    const double exact = 4 * length * length * length / kBendYoung + length / (kappa * mu);
    return -weightedMean(area, displacement(RestShape(mesh, accurate(nu)), force)).z / exact;
}

// A quarter of a clamped plate of 64 x 64 x 1 m under uniform load: .001265 q l^4 / D in the middle [Timoshenko &
// Woinowsky-Krieger 1959, table 35]; shear adds .5 %.
double flatPlateOverTheory(int n, int ratio, double nu)
{
    const double half = 32, length = 64;
    const TetMesh mesh = makeBox({half, half, 1}, {32 * n / ratio, 32 * n / ratio, n}, {}, CellSplit::kuhnSix);
    const std::vector<Vec3>& X = mesh.restPositions();
    const std::vector<double> area = faceAreas(mesh, [](const Vec3& x) { return std::fabs(x.z - 1) < 1e-9; });
    std::vector<Vec3> force(area.size());
    for (std::size_t i = 0; i < area.size(); ++i) force[i].z = -area[i];
    const auto isFixed = [&](int i, int c)
    {
        const bool isClamped = X[i].x == 0 || X[i].y == 0;
        return isClamped || (c == 0 && std::fabs(X[i].x - 32) < 1e-9) || (c == 1 && std::fabs(X[i].y - 32) < 1e-9);
    };
    const std::vector<Vec3> u = displacement(RestShape(mesh, accurate(nu)), force, isFixed);
    double middle = 0;
    for (std::size_t i = 0; i < u.size(); ++i)
        if (norm(X[i] - Vec3{half, half, 1}) < 1e-9) middle = u[i].z;
    const double D = kBendYoung / (12 * (1 - nu * nu)), q = -1;
    return middle / (1.005 * .001265 * q * length * length * length * length / D);
}

// A quarter of a ring of 10 m radius, 1 x 1 m thick, clamped at one end, with a radial load on the other: pi R / 4 (F
// R^2 / (E I) + F / (kappa G A) + F / (E A)) by Castigliano's theorem. n cells of six elements across, `ratio` times as
// long as thick.
double archOverTheory(int n, int ratio, double nu)
{
    const double radius = 10, quarter = 2 * std::atan(1.0);
    const int along = static_cast<int>(std::lround(radius * quarter * n / ratio));
    const TetMesh bar = makeBox({1, 1, 1}, {along, n, n}, {0, -0.5, -0.5}, CellSplit::kuhnSix);
    std::vector<Vec3> X = bar.restPositions();
    const std::vector<double> area = faceAreas(bar, [](const Vec3& x) { return std::fabs(x.x - 1) < 1e-9; });
    for (Vec3& x : X)
        x = {(radius + x.y) * std::sin(quarter * x.x), (radius + x.y) * std::cos(quarter * x.x) - radius, x.z};
    std::vector<Vec3> force(area.size());
    for (std::size_t i = 0; i < area.size(); ++i) force[i].x = area[i];
    const RestShape arch(TetMesh(X, bar.tets()), accurate(nu));
    const auto isFixed = [&](int i, int) { return bar.restPositions()[i].x == 0; };
    const double kappa = 10 * (1 + nu) / (12 + 11 * nu);
    const double exact = quarter * radius / 2 *
                         (12 * radius * radius / kBendYoung + 1 / (kappa * accurate(nu).lameMu()) + 1 / kBendYoung);
    return weightedMean(area, displacement(arch, force, isFixed)).x / exact;
}

// Cells eight times as long as thick are segments of 15 and 23 degrees.
TEST(ElasticityAccurateBending, ArchesBendAsCastiglianoSays)
{
    for (const int n : {2, 3})
        for (const int ratio : {1, 2, 4}) EXPECT_NEAR(archOverTheory(n, ratio, .3), 1, .03) << n << ' ' << ratio;
    EXPECT_NEAR(archOverTheory(3, 8, .3), 1, .07);
}

// Parasitic shear of plain elements grows with the square of the ratio: at 8 they have .05 and .06 of this.
TEST(ElasticityAccurateBending, FlatCellsBendAsCubesDo)
{
    for (const int ratio : {1, 2, 4, 8})
        for (const double nu : {.3, .49})
        {
            SCOPED_TRACE("ratio " + std::to_string(ratio) + ", nu " + std::to_string(nu));
            EXPECT_NEAR(flatBarOverTimoshenko(2, ratio, nu), 1, .05);
            EXPECT_NEAR(flatBarOverTimoshenko(3, ratio, nu), 1, .05);
            if (ratio < 2) continue;  // plates of 6,000 cubes and more
            EXPECT_NEAR(flatPlateOverTheory(1, ratio, nu), 1, nu < .4 ? .08 : .13);
            if (ratio < 4) continue;
            EXPECT_NEAR(flatPlateOverTheory(2, ratio, nu), 1, nu < .4 ? .06 : .11);
        }
}

// Steps and the assembled matrix agree: small loads; all of the body's forces and A take part.
TEST(ElasticityAccurateBending, StepsFindTheSameDeflection)
{
    const TetMesh mesh = shuffledMesh(makeBox({10, 1, 1}, {20, 2, 2}, {}, CellSplit::kuhnSix), .1, 1);
    const std::vector<double> area = faceAreas(mesh, atEnd);
    Body body = makeBody(mesh, accurate(.45, 1), isClampedEnd, 1);
    for (std::size_t i = 0; i < area.size(); ++i) body.m_loads.m_force[i].z = -1e-3 * area[i];
    EXPECT_LE(relax(body, 1e-12), 1e-12);
    const std::vector<Vec3> exact = displacement(body.m_model->shape(), body.m_loads.m_force);
    std::vector<Vec3> u = body.m_state.m_x;
    for (std::size_t i = 0; i < u.size(); ++i) u[i] -= mesh.restPositions()[i];
    double largest = 0;
    for (const Vec3& ui : exact) largest = std::max(largest, norm(ui));
    EXPECT_LE(largestDistance(u, exact), 1e-4 * largest);
}

// Displacement of the tip over L of a bar of 10 x 1 x 1 m under a vertical load P = load E I / L^2, for nu 0.
Vec3 tipOfElastica(const TetMesh& mesh, double load)
{
    constexpr double L = 10, I = 1.0 / 12;
    const std::vector<double> area = faceAreas(mesh, atEnd);
    Body body = makeBody(mesh, accurate(0, 1), isClampedEnd, 1);
    for (std::size_t i = 0; i < area.size(); ++i)
        body.m_loads.m_force[i].z = -load * kBendYoung * I / (L * L) * area[i];
    EXPECT_LE(relax(body, 1e-6 * L), 1e-6 * L);
    EXPECT_GT(smallestVolumeRatio(body), .5);
    return (1 / L) * (weightedMean(area, body.m_state.m_x) - weightedMean(area, mesh.restPositions()));
}

// w / L = .60325, u / L = .25442 at P L^2 / (E I) = 3 [Mattiasson 1981]. Four cells across, and two across the width,
// along which the solution is constant at nu 0; shear adds .5 % to w.
TEST(ElasticityAccurateBending, FollowsTheElastica)
{
    for (const CellSplit split : {CellSplit::kuhnSix, CellSplit::alternatingFive})
    {
        const Vec3 tip = tipOfElastica(makeBox({10, 1, 1}, {40, 4, 4}, {}, split), 3);
        EXPECT_NEAR(-tip.z, .60325, .02 * .60325);
        EXPECT_NEAR(-tip.x, .25442, .02 * .25442);
    }
}

// w / L = .71379 at P L^2 / (E I) = 5 [Mattiasson 1981], with cells .125 x .5 x .125 m: their patches turn far.
TEST(ElasticityAccurateBending, FollowsTheElasticaWithFlatCells)
{
    for (const CellSplit split : {CellSplit::kuhnSix, CellSplit::alternatingFive})
        EXPECT_NEAR(-tipOfElastica(makeBox({10, 1, 1}, {80, 2, 8}, {}, split), 5).z, .71379, .03 * .71379);
}

// Two to four cells across, and a bar so long that shear adds .3 %: elements with mean dilatation alone have .83 and
// .91 of w.
TEST(ElasticityAccurateBending, FollowsTheElasticaWithFewCells)
{
    const double L = 16, I = 1.0 / 12;
    for (const CellSplit split : {CellSplit::kuhnSix, CellSplit::alternatingFive})
        for (const double nu : {.3, .45, .49})
            for (const int n : {2, 3, 4})
            {
                const TetMesh mesh = makeBox({L, 1, 1}, {16 * n, n, n}, {}, split);
                const std::vector<double> area = faceAreas(mesh, [](const Vec3& X) { return X.x > 16 - 1e-9; });
                Body body = makeBody(mesh, accurate(nu, 1), isClampedEnd, 1);
                for (std::size_t i = 0; i < area.size(); ++i)
                    body.m_loads.m_force[i].z = -3 * kBendYoung * I / (L * L) * area[i];
                EXPECT_LE(relax(body, 1e-5 * L), 1e-5 * L);
                const double z = weightedMean(area, body.m_state.m_x).z - weightedMean(area, mesh.restPositions()).z;
                EXPECT_NEAR(-z / L, .60325, .04 * .60325) << "nu " << nu << ", n " << n;
            }
}

// (tan u - u) / (u^3 / 3): how much more a clamped column bends under a load across its end at u = pi/2 sqrt(P / P_cr).
double bendingFactor(double share)
{
    const double u = M_PI / 2 * std::sqrt(share);
    return 3 * (std::tan(u) - u) / (u * u * u);
}

// Euler's load pi^2 E I / (4 L^2), from the deflections under a small load across without and with half of it along.
TEST(ElasticityAccurateBending, ColumnsBuckleAtEulersLoad)
{
    const double L = 20, euler = M_PI * M_PI * kBendYoung / (12 * 4 * L * L);
    for (const CellSplit split : {CellSplit::kuhnSix, CellSplit::alternatingFive})
        for (const double nu : {.3, .45, .49})
            for (const int n : {2, 3, 4})
            {
                const TetMesh mesh = makeBox({L, 1, 1}, {20 * n, n, n}, {}, split);
                const std::vector<double> area = faceAreas(mesh, [](const Vec3& X) { return X.x > 20 - 1e-9; });
                double deflection[2];
                for (const int loaded : {0, 1})
                {
                    Body body = makeBody(mesh, accurate(nu, 1), isClampedEnd, 1);
                    for (std::size_t i = 0; i < area.size(); ++i)
                        body.m_loads.m_force[i] = {-.5 * loaded * euler * area[i], 0, -1e-3 * euler * area[i]};
                    EXPECT_LE(relax(body, 1e-7), 1e-7);
                    deflection[loaded] =
                        weightedMean(area, mesh.restPositions()).z - weightedMean(area, body.m_state.m_x).z;
                }
                double low = .1, high = 1;  // of the share P / P_cr
                for (int k = 0; k < 50; ++k)
                {
                    const double middle = .5 * (low + high);
                    (bendingFactor(middle) < deflection[1] / deflection[0] ? low : high) = middle;
                }
                EXPECT_NEAR(.5 / low, 1, .06) << "nu " << nu << ", n " << n;
            }
}

// Saint-Venant torsion, G J / L: plain elements have 1.30 and 1.37 of it with four cells across.
TEST(ElasticityAccurateBending, TwistsAsSaintVenantSays)
{
    for (const std::string kind : {"kuhn", "five", "lattice"})
        for (const double nu : {.3, .49})
        {
            const TetMesh mesh = bendingBar(kind, 4);
            const std::vector<double> area = faceAreas(mesh, atEnd);
            std::vector<Vec3> force(area.size());
            double torque = 0, work = 0;
            for (std::size_t i = 0; i < area.size(); ++i)
            {
                const Vec3 r = mesh.restPositions()[i] - Vec3{10, .5, .5};
                force[i] = area[i] * cross({1, 0, 0}, r);
                torque += dot(cross(r, force[i]), {1, 0, 0});
            }
            const Material material = accurate(nu);
            const std::vector<Vec3> u = displacement(RestShape(mesh, material), force);
            for (std::size_t i = 0; i < u.size(); ++i) work += dot(force[i], u[i]);
            EXPECT_NEAR(torque * torque / work / (material.lameMu() * .1406 / 10), 1, .12) << kind << " " << nu;
        }
}

// The number of eigenvalues of K below those of `shift` M [1/s2], by the signs of the pivots of K - shift M.
int assumedModesBelow(const RestShape& shape, double shift)
{
    Eigen::SparseMatrix<double> A = sparseStiffness(shape);
    for (int i = 0; i < shape.m_mesh.nodeCount(); ++i)
        for (int c = 0; c < 3; ++c) A.coeffRef(3 * i + c, 3 * i + c) -= shift * shape.m_lumpedMass[i];
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(A);
    EXPECT_EQ(factor.info(), Eigen::Success);
    return static_cast<int>((factor.vectorD().array() < 0).count());
}

// A free block has exactly six zero-energy modes, and no further eigenvalue near zero.
TEST(ElasticityAccurateBending, HasSixModesWithoutStrainAndNoSpuriousOnes)
{
    const TetMesh five = makeBox({1, 1, 1}, {4, 4, 4}), kuhn = makeBox({1, 1, 1}, {4, 4, 4}, {}, CellSplit::kuhnSix);
    for (const TetMesh& mesh :
         {five, kuhn, makeLatticeBox({4, 4, 4}, .25), shuffledMesh(kuhn, .15, 1), shuffledMesh(five, .12, 2),
          shuffledMesh(makeLatticeBox({4, 4, 4}, .25), .15, 3), makeSphere(.5, 5), makeCylinder(.5, 1, 4, 5),
          makeBox({1, 1, 1}, {1, 1, 1}), makeBox({1, 1, .2}, {5, 5, 1}),
          TetMesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}})})
        for (const double nu : {0., .3, .49, .499})
        {
            SCOPED_TRACE(std::to_string(mesh.tetCount()) + " elements, nu " + std::to_string(nu));
            const RestShape shape(mesh, accurate(nu));
            const double scale = shape.m_material.lameMu() / shape.m_material.m_density;
            EXPECT_EQ(assumedModesBelow(shape, -1e-6 * scale), 0);
            EXPECT_EQ(assumedModesBelow(shape, 1e-6 * scale), 6);
            EXPECT_EQ(assumedModesBelow(shape, .1 * scale), 6);
        }
}

// The boundary is displaced by u = G X; the inner nodes take u = G X, too.
TEST(ElasticityAccurateBending, PassesThePatchTest)
{
    for (const double strain : {1e-4, .2})
    {
        const Mat3 G = strain * Mat3{{{1, .5, -.3}, {-.2, -.7, .6}, {.4, .1, .8}}};
        const TetMesh mesh = shuffledMesh(makeBox({1, 1, 1}, {4, 4, 4}, {}, CellSplit::kuhnSix), .15, 2);
        const auto outside = [](const Vec3& X)
        { return X.x == 0 || X.x == 1 || X.y == 0 || X.y == 1 || X.z == 0 || X.z == 1; };
        Body body = makeBody(mesh, accurate(.45, 1), outside, 1);
        std::vector<Vec3> exact = mesh.restPositions();
        for (Vec3& x : exact) x += G * x;
        for (std::size_t i = 0; i < exact.size(); ++i)
            if (body.m_state.m_fixed[i]) body.m_state.m_x[i] = exact[i];
        EXPECT_LE(relax(body, 1e-11 * strain), 1e-11 * strain);
        EXPECT_LE(largestDistance(body.m_state.m_x, exact), 1e-10 * strain);
        std::vector<Stress> stress;
        elementStresses(body, stress);
        for (const Stress& s : stress) EXPECT_NEAR(s.xy, stress[0].xy, 1e-6 * kBendYoung * strain);
    }
}

// Bars with both ends held at a multiple of their length: the inner nodes find the homogeneous state from another.
// Cells of 1 and 4 times their thickness, and askew ones. In frames of their own, elements have no equilibrium here.
TEST(ElasticityAccurateBending, PulledBarsKeepTheirShape)
{
    const auto isHeld = [](const Vec3& X) { return X.x < 1e-9 || X.x > 4 - 1e-9; };
    for (const CellSplit split : {CellSplit::kuhnSix, CellSplit::alternatingFive})
        for (const int length : {1, 2, 4})
            for (const double strain : {.2, .5, 1., 2.})
                for (const double nu : {0., .3})
                {
                    if (nu * strain > .5) continue;
                    SCOPED_TRACE("cells " + std::to_string(length) + ", strain " + std::to_string(strain) + ", nu " +
                                 std::to_string(nu));
                    const TetMesh mesh = shuffledMesh(makeBox({4, 1, 1}, {12 / length, 3, 3}, {}, split), .1, 1);
                    Body body = makeBody(mesh, accurate(nu, 1), isHeld, 1);
                    std::vector<Vec3> exact = mesh.restPositions();
                    for (Vec3& x : exact) x = {(1 + strain) * x.x, (1 - nu * strain) * x.y, (1 - nu * strain) * x.z};
                    RandomVectors random(3);
                    for (std::size_t i = 0; i < exact.size(); ++i)
                        body.m_state.m_x[i] = exact[i] + (body.m_state.m_fixed[i] ? 0 : .03) * random.next();
                    EXPECT_LE(relax(body, 1e-9), 1e-9);
                    EXPECT_LE(largestDistance(body.m_state.m_x, exact), 1e-7);
                }
}

// The energy is a sum of squares, from small strains to inverted elements.
TEST(ElasticityAccurateBending, EnergyIsNeverNegative)
{
    Body body = makeBody(shuffledMesh(makeBox({1, 1, 1}, {3, 3, 3}, {}, CellSplit::kuhnSix), .1, 1), accurate(.499));
    const std::vector<Vec3> rest = body.m_state.m_x;
    EXPECT_NEAR(mechanicalEnergy(body), 0, 1e-15 * kBendYoung);
    RandomVectors random(4);
    for (const double size : {1e-4, .01, .1, 1., 10.})
    {
        for (std::size_t i = 0; i < rest.size(); ++i) body.m_state.m_x[i] = rest[i] + size * random.next();
        EXPECT_GT(mechanicalEnergy(body), 1e-3 * kBendYoung * size * size) << size;
    }
}

// Elastic forces of a step from rest, M dv / h, are minus the gradient of the energy: also in elements strained by 20 %
// and rotated differently, and with initial stress. A step of 1e-6 s makes A equal the mass.
TEST(ElasticityAccurateBending, ForcesAreTheEnergysGradient)
{
    const TetMesh mesh = shuffledMesh(makeBox({1, 1, 1}, {3, 2, 2}, {}, CellSplit::kuhnSix), .1, 1);
    for (const bool isStressed : {false, true})
    {
        Body body = makeBody(mesh, accurate(.45), {}, 1e-6);
        std::vector<SymmetricTensor> stress(mesh.tets().size(), SymmetricTensor{1e4, -2e4, 3e4, 1e4, -1e4, 2e4});
        if (isStressed) setInitialStress(body, stress);
        RandomVectors random(4);
        for (Vec3& x : body.m_state.m_x)
            x = rotationAbout({1, 2, -1}, .7 + .5 * x.x) *
                (x + Vec3{.2 * x.y, 0, .1 * x.x * x.x} + .03 * random.next());
        const std::vector<Vec3> x = body.m_state.m_x;
        StepSettings settings;
        settings.m_step = 1e-6;
        settings.m_tolerance = 1e-10;
        settings.m_numericalDamping = 1;
        step(body, settings);
        std::vector<Vec3> force = body.m_state.m_v;
        double largest = 0;
        for (std::size_t i = 0; i < x.size(); ++i)
        {
            force[i] = (body.m_state.m_mass[i] / settings.m_step) * force[i];
            largest = std::max(largest, norm(force[i]));
        }
        body.m_state.m_x = x;
        for (Vec3& v : body.m_state.m_v) v = {};
        for (int node = 0; node < mesh.nodeCount(); node += 3)
            for (int c = 0; c < 3; ++c)
            {
                constexpr double kStep = 1e-5;
                double& at = body.m_state.m_x[node][c];
                at = x[node][c] + kStep;
                const double above = mechanicalEnergy(body);
                at = x[node][c] - kStep;
                const double below = mechanicalEnergy(body);
                at = x[node][c];
                EXPECT_NEAR(force[node][c], -(above - below) / (2 * kStep), 2e-5 * largest) << node << " " << c;
            }
    }
}

// Bending stress M z / I at the surface in the middle of the bar: plain elements give a fifth less.
TEST(ElasticityAccurateBending, StressIsThatOfTheBeam)
{
    const TetMesh mesh = bendingBar("five", 4);
    const std::vector<double> area = faceAreas(mesh, atEnd);
    Body body = makeBody(mesh, accurate(.3, 1), isClampedEnd, 1);
    for (std::size_t i = 0; i < area.size(); ++i) body.m_loads.m_force[i].z = -area[i];
    EXPECT_LE(relax(body, 1e-9), 1e-9);
    std::vector<Stress> perElement;
    elementStresses(body, perElement);
    double moment = 0;  // of sigma_xx about the middle, over the slice 4.5 < x < 5.5
    for (int e = 0; e < mesh.tetCount(); ++e)
    {
        Vec3 middle;
        for (const int node : mesh.tets()[e]) middle += .25 * mesh.restPositions()[node];
        EXPECT_EQ(elementStress(body, e).xx, perElement[e].xx);
        if (middle.x > 4.5 && middle.x < 5.5) moment += mesh.tetVolume(e) * perElement[e].xx * (middle.z - .5);
    }
    EXPECT_NEAR(moment, 5, .1 * 5);  // F (L - x); without the part that is linear within elements
}

TEST(ElasticityAccurateBending, KeepsMomentumAndTurnsFreely)
{
    Body body = makeBody(makeBox({1, .5, .5}, {4, 2, 2}), accurate(.49));
    for (std::size_t i = 0; i < body.m_state.m_x.size(); ++i)
        body.m_state.m_v[i] = cross({1, 2, 3}, body.m_state.m_x[i]) + Vec3{.1, .2, 0};
    const Vec3 p = linearMomentum(body.m_state), L = angularMomentum(body.m_state);
    const double energy = mechanicalEnergy(body);
    StepSettings settings;
    settings.m_numericalDamping = 0;
    for (int k = 0; k < 240; ++k) step(body, settings);
    EXPECT_LE(norm(linearMomentum(body.m_state) - p), 1e-10 * norm(p));
    EXPECT_LE(norm(angularMomentum(body.m_state) - L), 1e-10 * norm(L));
    EXPECT_NEAR(mechanicalEnergy(body), energy, .01 * energy);
}

double bendingIterations(double nu, bool isAccurate, double tolerance)
{
    Material material = accurate(nu);
    material.m_bending = isAccurate ? Bending::accurate : Bending::plain;
    Body body = makeBody(makeBox({4, 1, 1}, {16, 4, 4}), material, isClampedEnd);
    setGravity(body, {0, 0, -9.81});
    StepSettings settings;
    settings.m_tolerance = tolerance;
    int sum = 0;
    for (int k = 0; k < 60; ++k) sum += step(body, settings).m_iterations;
    EXPECT_GT(smallestVolumeRatio(body), 0);
    return sum / 60.0;
}

// The factor is that of the elements at rest: plain ones take as many iterations at nu .3.
TEST(ElasticityAccurateBending, TakesFewIterationsForAnyPoissonsRatio)
{
    for (const double nu : {.3, .45, .49, .499})
    {
        const double coarse = bendingIterations(nu, true, 1e-3), fine = bendingIterations(nu, true, 1e-6);
        RecordProperty("nu" + std::to_string(nu), std::to_string(coarse) + " / " + std::to_string(fine));
        EXPECT_LE(coarse, nu < .495 ? 2.5 : 4.5) << nu;
        EXPECT_LE(fine, nu < .495 ? 8 : 17) << nu;
    }
}

Body turningBeam(const TetMesh& mesh)
{
    Body body = makeBody(mesh, accurate(.45));
    for (std::size_t i = 0; i < body.m_state.m_x.size(); ++i)
    {
        const Vec3& X = body.m_state.m_x[i];
        body.m_state.m_v[i] = cross({0, 2, 1}, X) + Vec3{0, 0, X.x * X.x};
    }
    return body;
}

TEST(ElasticityAccurateBending, HasTheSameBitsOnAnyThreads)
{
    const TetMesh mesh = makeBox({8, 2, 2}, {24, 8, 8});
    for (const double tolerance : {1e-3, 1e-6})
    {
        std::vector<Vec3> first;
        for (const int count : {1, 2, 3, 8})
        {
            const Threads threads(count);
            Body body = turningBeam(mesh);
            StepSettings settings;
            settings.m_tolerance = tolerance;
            settings.m_threads = &threads;
            for (int k = 0; k < 5; ++k) step(body, settings);
            if (first.empty()) first = body.m_state.m_x;
            EXPECT_EQ(largestDistance(body.m_state.m_x, first), 0) << count;
        }
    }
}

TEST(ElasticityAccurateBending, GoesOnFromASnapshotToTheBit)
{
    Body body = turningBeam(makeBox({4, 1, 1}, {8, 2, 2}));
    for (int k = 0; k < 10; ++k) step(body, StepSettings());
    const BodySnapshot snapshot = snapshotOf(body);
    Body other = turningBeam(makeBox({4, 1, 1}, {8, 2, 2}));
    check(snapshot, *other.m_model);
    restore(snapshot, other);
    for (int k = 0; k < 10; ++k) step(body, StepSettings()), step(other, StepSettings());
    EXPECT_EQ(largestDistance(body.m_state.m_x, other.m_state.m_x), 0);
    Material plain = accurate(.45);
    plain.m_bending = Bending::plain;
    EXPECT_NE(markOf(ElementMaterials(plain)), markOf(ElementMaterials(accurate(.45))));
}

TEST(ElasticityAccurateBending, StepsDoNotAllocate)
{
    Body body = turningBeam(makeBox({4, 1, 1}, {8, 2, 2}));
    step(body, StepSettings());
    const AllocationCounter counter;
    for (int k = 0; k < 5; ++k) step(body, StepSettings());
    EXPECT_EQ(counter.count(), 0);
}

}  // namespace
}  // namespace bullet_fem
