// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Orthotropic bodies against the formulas of linear elasticity (docs/materials.md, Orthotropic).
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numeric>
#include <utility>

#include "bullet_fem/fem/body/active_stress.h"
#include "bullet_fem/fem/step/stress.h"
#include "fem/common/rotation.h"
#include "fem/factor/block_matrix.h"
#include "fem/scenes/elasticity_scenes.h"
#include "fem/scenes/test_constants.h"

namespace bullet_fem
{
namespace
{

constexpr double kSmallStrain = 1e-5;  // of the bars: nonlinear terms are below its square

Orthotropic sprucelike()
{
    Orthotropic m;
    m.m_young = {1e6, 8e4, 5e4};
    m.m_poisson = {0.37, 0.47, 0.43};
    m.m_shear = {6.4e4, 6.1e4, 1e4};
    return m;
}

Material materialOf(const Orthotropic& constants, double density = 1000)
{
    Material material = elasticMaterial(1e5, 0.3, density);
    material.m_law = ElasticLaw::orthotropic;
    material.m_orthotropic = constants;
    return material;
}

// A free block loaded by the tractions of a homogeneous stress.
class StressedBlock
{
public:
    explicit StressedBlock(const Material& material)
        : m_body(makeBody(makeBox({1, 0.8, 0.6}, {3, 3, 2}, {}, CellSplit::kuhnSix), material, {}, 0.5))
    {
    }

    // The mean strain under that stress.
    Mat3 strainUnder(const Mat3& stress)
    {
        const TetMesh& mesh = m_body.m_model->mesh();
        const Vec3 size = {1, 0.8, 0.6};
        std::fill(m_body.m_loads.m_force.begin(), m_body.m_loads.m_force.end(), Vec3());
        Mat3 F;
        for (int axis = 0; axis < 3; ++axis)
            for (const double side : {0.0, 1.0})
            {
                const std::vector<double> area =
                    faceAreas(mesh, [&](const Vec3& X) { return std::fabs(X[axis] - side * size[axis]) < 1e-9; });
                for (std::size_t i = 0; i < area.size(); ++i)
                    m_body.m_loads.m_force[i] += (2 * side - 1) * area[i] * stress.column(axis);
            }
        // The remainder is a rigid rotation: a sheared bar turns until it is aligned with the traction, with almost no
        // restoring moment.
        EXPECT_LE(relax(m_body, 1e-12), 1e-3 * kSmallStrain);
        for (int axis = 0; axis < 3; ++axis)
        {
            const auto meanAt = [&](double side)
            {
                return weightedMean(
                    faceAreas(mesh, [&](const Vec3& X) { return std::fabs(X[axis] - side * size[axis]) < 1e-9; }),
                    m_body.m_state.m_x);
            };
            const Vec3 edge = (1 / size[axis]) * (meanAt(1) - meanAt(0));
            for (int c = 0; c < 3; ++c) F(c, axis) = edge[c];
        }
        const Mat3 S = transposeTimes(polarRotation(F, Mat3::identity()), F);
        return S - Mat3::identity();
    }

    const Body& body() const { return m_body; }

private:
    Body m_body;
};

Mat3 entry(int i, int j, double value)
{
    Mat3 stress;
    stress(i, j) = stress(j, i) = value;
    return stress;
}

TEST(ElasticityOrthotropic, BarsStretchAndNarrowByTheirNineConstants)
{
    const Orthotropic m = sprucelike();
    StressedBlock block(materialOf(m));
    const double nu[3][3] = {{0, 0.37, 0.47},
                             {0.37 * m.m_young[1] / m.m_young[0], 0, 0.43},
                             {0.47 * m.m_young[2] / m.m_young[0], 0.43 * m.m_young[2] / m.m_young[1], 0}};
    for (int i = 0; i < 3; ++i)
    {
        const Mat3 strain = block.strainUnder(entry(i, i, kSmallStrain * m.m_young[i]));
        for (int j = 0; j < 3; ++j)
            EXPECT_NEAR(strain(j, j), (i == j ? 1 : -nu[i][j]) * kSmallStrain, 1e-4 * kSmallStrain) << i << ", " << j;
    }
    constexpr int kShears[3][2] = {{0, 1}, {0, 2}, {1, 2}};
    for (int k = 0; k < 3; ++k)
    {
        const auto [i, j] = kShears[k];
        const Mat3 strain = block.strainUnder(entry(i, j, kSmallStrain * m.m_shear[k]));
        EXPECT_NEAR(2 * strain(i, j), kSmallStrain, 1e-4 * kSmallStrain) << k;
        EXPECT_NEAR(strain(0, 0) + strain(1, 1) + strain(2, 2), 0, 1e-4 * kSmallStrain);
    }
}

// In off-axis tension 1 / E = c^4 / E1 + (1 / G12 - 2 nu12 / E1) s^2 c^2 + s^4 / E2, and the bar shears.
TEST(ElasticityOrthotropic, OffAxisBarsFollowTheTransformedCompliance)
{
    Orthotropic m = sprucelike();
    for (const double degrees : {15.0, 30.0, 45.0, 60.0, 75.0})
    {
        const double c = std::cos(degrees * kPi / 180), s = std::sin(degrees * kPi / 180);
        m.m_along = {c, s, 0};
        m.m_across = {-s, c, 0};
        const double E1 = m.m_young[0], E2 = m.m_young[1], nu = m.m_poisson[0], G = m.m_shear[0];
        const double perYoung = c * c * c * c / E1 + (1 / G - 2 * nu / E1) * s * s * c * c + s * s * s * s / E2;
        const double perShear =
            (2 * (1 + nu) / E1 - 1 / G) * s * c * c * c - (2 / E2 + 2 * nu / E1 - 1 / G) * s * s * s * c;
        StressedBlock block(materialOf(m));
        const double stress = kSmallStrain / perYoung;
        const Mat3 strain = block.strainUnder(entry(0, 0, stress));
        EXPECT_NEAR(strain(0, 0), kSmallStrain, 1e-4 * kSmallStrain) << degrees;
        EXPECT_NEAR(strain(0, 1) + strain(1, 0), stress * perShear, 2e-4 * stress * std::fabs(perShear)) << degrees;
    }
}

// A thin ring with circumferential fibres under internal pressure p [Lekhnitskii 1968]: with k^2 = E1 / E2,
//     sigma_r = A r^(k-1) + B r^(-k-1),   u = r (sigma_theta / E1 - nu12 sigma_r / E1).
class FibreRing
{
public:
    static constexpr double kInner = 1, kOuter = 1.5, kHeight = 0.04;
    static constexpr int kRings = 12, kAround = 96;

    FibreRing(const Orthotropic& constants, bool turns) : m_mesh(ringMesh())
    {
        std::vector<Material> perElement;
        for (const Tet& tet : m_mesh.tets())
        {
            Vec3 c;
            for (const int node : tet) c += 0.25 * m_mesh.restPositions()[node];
            Orthotropic here = constants;
            if (turns) here.m_along = {-c.y, c.x, 0}, here.m_across = {c.x, c.y, 0};
            perElement.push_back(materialOf(here));
        }
        m_body = std::make_unique<Body>(makeBody(m_mesh, ElementMaterials::ofElements(perElement), {}, 0.5));
    }

    // Mean radial displacement of the inner and of the outer rim.
    std::pair<double, double> widen(double pressure)
    {
        const auto onRim = [](double r)
        { return [r](const Vec3& X) { return std::fabs(std::hypot(X.x, X.y) - r) < 1e-6; }; };
        const std::vector<double> area = faceAreas(m_mesh, onRim(kInner));
        for (std::size_t i = 0; i < area.size(); ++i)
        {
            const Vec3& X = m_mesh.restPositions()[i];
            const Vec3 outward = {X.x, X.y, 0};
            m_body->m_loads.m_force[i] = pressure * area[i] / norm(outward) * outward;
        }
        EXPECT_LE(relax(*m_body, 1e-10), 1e-10);
        return {movement(onRim(kInner)), movement(onRim(kOuter))};
    }

private:
    double movement(const NodePredicate& onRim) const
    {
        double sum = 0;
        int count = 0;
        for (std::size_t i = 0; i < m_mesh.restPositions().size(); ++i)
        {
            const Vec3 &X = m_mesh.restPositions()[i], &x = m_body->m_state.m_x[i];
            if (!onRim(X)) continue;
            sum += std::hypot(x.x, x.y) - std::hypot(X.x, X.y);
            ++count;
        }
        return sum / count;
    }

    static TetMesh ringMesh()
    {
        // A box with that many cells, whose last column of nodes is identified with the first.
        const TetMesh box = makeBox({kAround, kRings, 1}, {kAround, kRings, 1}, {}, CellSplit::kuhnSix);
        std::vector<Vec3> X;
        std::vector<int> place;
        for (const Vec3& P : box.restPositions())
        {
            const bool isLast = P.x > kAround - 0.5;
            place.push_back(isLast ? place[place.size() - kAround] : static_cast<int>(X.size()));
            if (isLast) continue;
            const double angle = 2 * kPi * P.x / kAround, r = kInner + (kOuter - kInner) * P.y / kRings;
            X.push_back({r * std::cos(angle), r * std::sin(angle), kHeight * P.z});
        }
        std::vector<Tet> tets = box.tets();
        for (Tet& tet : tets)
            for (int& node : tet) node = place[node];
        return TetMesh(X, tets);
    }

    TetMesh m_mesh;
    std::unique_ptr<Body> m_body;
};

TEST(ElasticityOrthotropic, HoopFibresHoldThePressureOfARing)
{
    const Orthotropic m = Orthotropic::transverselyIsotropic(9e6, 1e6, 0.3, 0.3, 4e5);
    constexpr double p = 10, a = FibreRing::kInner, b = FibreRing::kOuter, k = 3;  // E1 / E2 = k^2
    // Boundary conditions: sigma_r = -p at a and 0 at b.
    const double B = -p / (std::pow(a, -k - 1) - std::pow(b, -2 * k) * std::pow(a, k - 1)),
                 A = -B * std::pow(b, -2 * k);
    const auto movement = [&](double r)
    {
        const double inner = A * std::pow(r, k - 1), outer = B * std::pow(r, -k - 1);
        return r * (k * (inner - outer) - 0.3 * (inner + outer)) / m.m_young[0];
    };
    const auto [inner, outer] = FibreRing(m, true).widen(p);
    EXPECT_NEAR(inner, movement(a), 0.01 * movement(a));
    EXPECT_NEAR(outer, movement(b), 0.01 * movement(b));
    // Straight fibres of equal stiffness resist a third as well: the ring widens more than twice as far.
    EXPECT_GT(FibreRing(m, false).widen(p).first, 2 * movement(a));
}

// Isotropic constants reproduce Hooke's law in each step of a vibrating, rotating body.
TEST(ElasticityOrthotropic, IsotropicConstantsMoveAsHookesLaw)
{
    Material hooke = elasticMaterial(1e5, 0.3);
    hooke.m_stiffnessDamping = 0.002;
    Orthotropic constants = Orthotropic::transverselyIsotropic(1e5, 1e5, 0.3, 0.3, hooke.lameMu());
    constants.m_along = {1, 1, 0.3};
    Material same = hooke;
    same.m_law = ElasticLaw::orthotropic;
    same.m_orthotropic = constants;
    for (const double tolerance : {1e-3, 1e-9})
    {
        const TetMesh mesh = makeBox({1, 0.4, 0.4}, {6, 3, 3});
        const auto clamped = [](const Vec3& X) { return X.x == 0; };
        Body a = makeBody(mesh, hooke, clamped), b = makeBody(mesh, same, clamped);
        StepSettings settings;
        settings.m_tolerance = tolerance;
        setGravity(a, {0, 3, -9.81}), setGravity(b, {0, 3, -9.81});
        double moved = 0;
        for (int k = 0; k < 60; ++k)
        {
            step(a, settings), step(b, settings);
            moved = std::max(moved, largestDistance(a.m_state.m_x, mesh.restPositions()));
        }
        EXPECT_GT(moved, 0.3);
        EXPECT_LT(largestDistance(a.m_state.m_x, b.m_state.m_x), tolerance > 1e-4 ? 2e-5 : 1e-7) << tolerance;
        EXPECT_NEAR(mechanicalEnergy(a), mechanicalEnergy(b), 1e-4 * mechanicalEnergy(a));
    }
}

// A free block has exactly six zero-energy modes.
TEST(ElasticityOrthotropic, AFreeBodyHasSixZeroModes)
{
    for (const double askew : {0.0, 0.7})
    {
        Orthotropic m = sprucelike();
        m.m_along = {1, askew, 0.5 * askew};
        const RestShape shape(makeBox({1, 0.8, 0.6}, {2, 2, 2}), materialOf(m));
        const BlockMatrix K = assembleRestStiffness(shape);
        Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(3 * K.nodeCount(), 3 * K.nodeCount());
        for (int row = 0; row < K.nodeCount(); ++row)
            for (int k = K.m_rowStart[row]; k < K.m_rowStart[row + 1]; ++k)
                for (int i = 0; i < 3; ++i)
                    for (int j = 0; j < 3; ++j) dense(3 * row + i, 3 * K.m_column[k] + j) = K.m_block[k](i, j);
        EXPECT_LT((dense - dense.transpose()).cwiseAbs().maxCoeff(), 1e-12 * dense.maxCoeff());
        const Eigen::VectorXd modes = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dense).eigenvalues();
        EXPECT_LT(std::fabs(modes(0)), 1e-12 * modes(modes.size() - 1));
        EXPECT_LT(modes(5), 1e-12 * modes(modes.size() - 1));
        EXPECT_GT(modes(6), 1e-4 * modes(modes.size() - 1));
    }
}

struct FlightCase
{
    double m_strain, m_kick;  // [-], [m/s]
};

// True if a rotation jumps in a body with inverted elements: another of an element's axes then counts as mirrored. With
// other moduli along this axis its energy jumps, too.
bool anyFlips(const Body& body, const std::vector<Mat3>& before, const std::vector<Mat3>& after)
{
    const auto isFlip = [](const Mat3& from, const Mat3& to)
    { return trace(transposeTimes(from, to)) < 1; };  // > 90 deg
    return smallestVolumeRatio(body) < 0 &&
           std::inner_product(after.begin(), after.end(), before.begin(), false, std::logical_or<>(), isFlip);
}

// Stretched, compressed and twisted, spinning, with initial velocities, undamped: the energy is never negative, never
// exceeds its initial value, and momenta are constant. With sym(R^T dF) in place of dS in A the second case would have
// 500 times its energy after 600 steps.
TEST(ElasticityOrthotropic, EnergyIsNeverNegativeAndNeverGrows)
{
    Orthotropic m = sprucelike();
    m.m_along = {1, 0.5, -0.3};
    for (const FlightCase& flight : {FlightCase{0.2, 2}, FlightCase{0.5, 0}, FlightCase{0.5, 5}})
    {
        const double strain = flight.m_strain;
        Body body = makeBody(makeBox({1, 0.6, 0.5}, {4, 3, 3}), materialOf(m));
        RandomVectors random(5);
        for (std::size_t i = 0; i < body.m_state.m_x.size(); ++i)
        {
            Vec3& x = body.m_state.m_x[i];
            x = rotationAbout({1, 2, 0}, 7.5 * strain * x.x) * Vec3{(1 + strain) * x.x, x.y, (1 - strain) * x.z} +
                0.05 * strain * random.next();
            body.m_state.m_v[i] = flight.m_kick * random.next() + cross({0, 3, 1}, x);
        }
        const double start = mechanicalEnergy(body);
        const Vec3 P = linearMomentum(body.m_state), L = angularMomentum(body.m_state);
        double before = start;
        std::vector<Mat3> rotations = elementRotations(body);
        for (int k = 0; k < 600; ++k)
        {
            step(body, StepSettings());
            const double energy = mechanicalEnergy(body);
            ASSERT_GE(energy, 0) << k;
            const std::vector<Mat3> now = elementRotations(body);
            const double most = anyFlips(body, rotations, now) ? start : before + 1e-5 * start;
            ASSERT_LE(energy, most) << strain << ", " << k;
            rotations = now;
            ASSERT_LE(energy, start);
            before = energy;
        }
        EXPECT_LT(before, 0.05 * start);  // implicit Euler damps
        EXPECT_LT(norm(linearMomentum(body.m_state) - P), 1e-9 * (norm(P) + 1));
        EXPECT_LT(norm(angularMomentum(body.m_state) - L), 1e-8 * norm(L));
    }
}

// Rotating a body rotates its stress and its material axes.
TEST(ElasticityOrthotropic, StressesTurnWithTheBody)
{
    Orthotropic m = sprucelike();
    m.m_along = {1, 0.5, -0.3};
    const Mat3 Q = rotationAbout({2, -1, 1}, 2.1);
    const TetMesh mesh = makeBox({1, 1, 1}, {2, 2, 2});
    Body straight = makeBody(mesh, materialOf(m)), turned = makeBody(mesh, materialOf(m));
    const Mat3 F = {{{1.02, 0.01, -0.03}, {0.02, 0.97, 0.01}, {0, 0.04, 1.01}}};
    for (std::size_t i = 0; i < straight.m_state.m_x.size(); ++i)
    {
        straight.m_state.m_x[i] = F * straight.m_state.m_x[i];
        turned.m_state.m_x[i] = Q * straight.m_state.m_x[i];
    }
    const Mat3 R = polarRotation(F, Mat3::identity());
    const SymmetricTensor strain = symmetricPart(transposeTimes(R, F) - Mat3::identity());
    const Mat3 expected = R * timesTranspose(toMatrix(stressOf(m.stiffness(), strain)), R);
    std::vector<Stress> found, foundTurned;
    elementStresses(straight, found);
    elementStresses(turned, foundTurned);
    for (std::size_t e = 0; e < found.size(); ++e)
    {
        EXPECT_LT(squaredNorm(toMatrix(found[e]) - expected), 1e-20 * squaredNorm(expected));
        EXPECT_LT(squaredNorm(toMatrix(foundTurned[e]) - Q * timesTranspose(expected, Q)),
                  1e-12 * squaredNorm(expected));
    }
    EXPECT_NEAR(mechanicalEnergy(straight), 0.5 * contraction(strain, stressOf(m.stiffness(), strain)), 1e-9 * 1e6);
}

// Equal thermal strain in all directions gives no stress in a free body, for any stiffness.
TEST(ElasticityOrthotropic, HeatExpandsItFreely)
{
    Body body = makeBody(makeBox({1, 0.8, 0.6}, {2, 2, 2}), materialOf(sprucelike()), {}, 0.5);
    Expansion expansion;
    expansion.m_strain = 1e-4;
    body.m_actuators.m_expansions.push_back(expansion);
    applyActiveStress(body);
    EXPECT_LE(relax(body, 1e-12), 1e-12);
    const std::vector<Vec3>&x = body.m_state.m_x, &X = body.m_model->mesh().restPositions();
    for (std::size_t i = 0; i < X.size(); ++i) EXPECT_LT(norm((x[i] - x[0]) - 1.0001 * (X[i] - X[0])), 1e-9) << i;
}

// An orthotropic half and an isotropic one in series, in tension: Reuss.
TEST(ElasticityOrthotropic, RegionsMayBeIsotropic)
{
    const TetMesh mesh = makeBox({2, 0.3, 0.3}, {16, 3, 3}, {}, CellSplit::kuhnSix);
    Orthotropic m = sprucelike();
    m.m_poisson = {0, 0, 0};  // so that both halves contract equally
    std::vector<int> labels;
    for (const Tet& tet : mesh.tets())
    {
        double x = 0;
        for (const int node : tet) x += 0.25 * mesh.restPositions()[node].x;
        labels.push_back(x < 1 ? 1 : 2);
    }
    const ElementMaterials materials =
        ElementMaterials::ofLabels(labels, {{1, materialOf(m)}, {2, elasticMaterial(2e5, 0)}});
    Body body = makeBody(mesh, materials, {}, 0.5);
    for (const double side : {0.0, 2.0})
    {
        const std::vector<double> area = faceAreas(mesh, [=](const Vec3& X) { return std::fabs(X.x - side) < 1e-9; });
        for (std::size_t i = 0; i < area.size(); ++i) body.m_loads.m_force[i].x += (side - 1) * area[i];
    }
    EXPECT_LE(relax(body, 1e-11), 1e-11);
    const std::vector<Vec3>& x = body.m_state.m_x;
    const double stretch = x[nodeAt(mesh, {2, 0, 0})].x - x[nodeAt(mesh, {0, 0, 0})].x - 2;
    EXPECT_NEAR(stretch, 1 / 1e6 + 1 / 2e5, 1e-9);
}

}  // namespace
}  // namespace bullet_fem
