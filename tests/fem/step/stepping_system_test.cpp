// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The increment of a step against a dense solution of the system in stepping.h.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <numeric>

#include "fem/scenes/dense_system.h"
#include "fem/scenes/stepping_scenes.h"

namespace bullet_fem
{
namespace
{

struct SystemCase
{
    const char* m_name;
    bool m_clamped, m_tension;
    Warp m_warp;
};

void PrintTo(const SystemCase& systemCase, std::ostream* out)
{
    *out << systemCase.m_name;
}

// V_e (g_a . sigma+ g_b) I, from the textbook's stress.
Eigen::MatrixXd denseTension(const Body& body, const std::vector<Mat3>& R)
{
    const RestShape& shape = body.m_model->shape();
    const Material& material = shape.m_material;
    const std::vector<Vec3>& x = body.m_state.m_x;
    Eigen::MatrixXd T = Eigen::MatrixXd::Zero(3 * x.size(), 3 * x.size());
    for (int e = 0; e < shape.m_mesh.tetCount(); ++e)
    {
        const Tet& t = shape.m_mesh.tets()[e];
        const Eigen::Matrix3d G = dense(shape.m_elements[e].m_DmInverse);
        const Mat3 Ds = Mat3::fromColumns(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]], x[t[3]] - x[t[0]]);
        const Eigen::Matrix3d S = dense(R[e]).transpose() * dense(Ds) * G;
        const Eigen::Matrix3d strain = 0.5 * (S + S.transpose()) - Eigen::Matrix3d::Identity();
        const Eigen::Matrix3d stress =
            material.lameLambda() * strain.trace() * Eigen::Matrix3d::Identity() + 2 * material.lameMu() * strain;
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(stress);
        const Eigen::Matrix3d positive =
            eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).asDiagonal() * eigen.eigenvectors().transpose();
        Eigen::Matrix<double, 4, 3> g;
        g << -G.colwise().sum(), G;
        const Eigen::Matrix4d weights = shape.m_mesh.tetVolume(e) * g * positive * g.transpose();
        for (int a = 0; a < 4; ++a)
            for (int b = 0; b < 4; ++b)
                T.block<3, 3>(3 * t[a], 3 * t[b]) += weights(a, b) * Eigen::Matrix3d::Identity();
    }
    return T;
}

class DenseStep : public testing::TestWithParam<SystemCase>
{
protected:
    DenseStep()
    {
        disturb(m_body);
        m_body.m_loads.m_massDamping = 0.7;
        for (std::size_t i = 0; i < m_fixed.size(); ++i) m_body.m_loads.m_targetVelocity[i] = {0.1, -0.2, 0.3};
        m_settings.m_step = 0.02;  // differs from the factor's
        m_settings.m_tolerance = 1e-8;
        m_settings.m_maxIterations = 500;
        m_settings.m_warp = GetParam().m_warp;
        m_settings.m_tension = GetParam().m_tension;
    }

    // Requires the element rotations of the step.
    void assemble()
    {
        const Material& material = m_body.m_model->shape().m_material;
        const double h = m_settings.m_step, alpha = material.m_massDamping + 0.7, beta = material.m_stiffnessDamping;
        const TetMesh& mesh = m_body.m_model->mesh();
        const std::vector<Mat3> R = elementRotations(m_body);
        const Eigen::MatrixXd K = denseStiffness(mesh, material, R);
        Eigen::VectorXd M(K.rows());
        for (Eigen::Index i = 0; i < M.size(); ++i) M(i) = m_body.m_state.m_mass[i / 3];
        m_A = (h * h + h * beta) * K;
        m_A.diagonal() += (1 + h * alpha) * M;
        if (GetParam().m_tension) m_A += h * h * denseTension(m_body, R);

        // K' x - sum R K_e X: minus the elements' rotated rest shapes.
        Eigen::VectorXd elastic = -K * flat(m_body.m_state.m_x);
        for (int e = 0; e < mesh.tetCount(); ++e)
        {
            const Tet& t = mesh.tets()[e];
            const std::vector<Vec3>& X = mesh.restPositions();
            const std::array<Vec3, 4> corners = {X[t[0]], X[t[1]], X[t[2]], X[t[3]]};
            const Eigen::VectorXd f =
                textbookElementStiffness(corners, material) * flat({corners.begin(), corners.end()});
            for (int a = 0; a < 4; ++a) elastic.segment<3>(3 * t[a]) += dense(R[e]) * f.segment<3>(3 * a);
        }
        const Eigen::VectorXd v = flat(m_body.m_state.m_v);
        m_G = rigidModes(m_body.m_state.m_x, m_body.m_state.m_mass);
        if (GetParam().m_clamped) m_G.setZero();
        m_momentum = M.asDiagonal() * m_G;
        m_rigidFactor = 1 / (1 + h * alpha);
        const Eigen::VectorXd outside = flat(m_body.m_loads.m_force) - alpha * M.cwiseProduct(v);
        m_rigid = rigidResponse(h * outside);
        const Eigen::VectorXd strained = v - rigidPart(v);
        m_b = h * (outside + elastic - (h + beta) * K * strained) + massOf(centrifugalVelocity(alpha));
    }

    Eigen::VectorXd massOf(Eigen::VectorXd v) const
    {
        for (Eigen::Index i = 0; i < v.size(); ++i) v(i) *= m_body.m_state.m_mass[i / 3];
        return v;
    }

    // The rigid motion of a velocity, and that by impulses.
    Eigen::VectorXd rigidPart(const Eigen::VectorXd& v) const
    {
        if (GetParam().m_clamped) return Eigen::VectorXd::Zero(v.size());
        return m_G * (m_momentum.transpose() * m_G).inverse() * (m_momentum.transpose() * v);
    }
    Eigen::VectorXd rigidResponse(const Eigen::VectorXd& impulses) const
    {
        if (GetParam().m_clamped) return Eigen::VectorXd::Zero(impulses.size());
        return m_rigidFactor * m_G * (m_momentum.transpose() * m_G).inverse() * (m_G.transpose() * impulses);
    }

    // The response to impulses: the rigid one, and the elastic one.
    Eigen::VectorXd response(const Eigen::VectorXd& impulses) const
    {
        if (GetParam().m_clamped) return constrained(m_A, m_fixed).llt().solve(impulses);
        return rigidResponse(impulses) + elasticSolution(m_A, impulses, m_momentum);
    }

    // The change of velocity by the centrifugal force in the step, with the angular velocity of a freely rotating body
    // after the loads.
    Eigen::VectorXd centrifugalVelocity(double alpha) const
    {
        const BodyState& s = m_body.m_state;
        const double mass = std::accumulate(s.m_mass.begin(), s.m_mass.end(), 0.0);
        std::vector<Vec3> turned(s.m_x.size());
        if (GetParam().m_clamped) return flat(turned);
        Vec3 center, momentum;
        for (std::size_t i = 0; i < s.m_x.size(); ++i) center += (s.m_mass[i] / mass) * s.m_x[i];
        Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
        for (std::size_t i = 0; i < s.m_x.size(); ++i)
        {
            const Vec3 r = s.m_x[i] - center;
            const double h = m_settings.m_step;
            momentum += (1 / (1 + h * alpha)) * cross(r, s.m_mass[i] * s.m_v[i] + h * m_body.m_loads.m_force[i]);
            inertia += s.m_mass[i] * dense(Mat3::diagonal(dot(r, r)) - outer(r, r));
        }
        const Eigen::Vector3d spin = inertia.inverse() * Eigen::Vector3d(momentum.x, momentum.y, momentum.z);
        const Vec3 omega = {spin(0), spin(1), spin(2)};
        const double h = m_settings.m_step;
        for (std::size_t i = 0; i < s.m_x.size(); ++i) turned[i] = -h * cross(omega, cross(omega, s.m_x[i] - center));
        return flat(turned);
    }

    Body m_body = GetParam().m_clamped ? clampedBeam() : freeBlock();
    const std::vector<unsigned char>& m_fixed = m_body.m_state.m_fixed;
    StepSettings m_settings;
    Eigen::MatrixXd m_A;
    Eigen::VectorXd m_b;
    Eigen::MatrixXd m_G, m_momentum;  // rigid modes, and M times these
    double m_rigidFactor = 1;
    Eigen::VectorXd m_rigid;  // rigid response to the loads
};

TEST_P(DenseStep, FreeMotionSolvesTheStatedSystem)
{
    const SolveReport report = solveFreeMotion(m_body, m_settings);
    EXPECT_EQ(report.m_stop, SolveStop::converged);
    assemble();
    Eigen::VectorXd prescribed = Eigen::VectorXd::Zero(m_b.size());
    const Eigen::VectorXd v = flat(m_body.m_state.m_v);
    for (std::size_t i = 0; i < m_fixed.size(); ++i)
        if (m_fixed[i]) prescribed.segment<3>(3 * i) = Eigen::Vector3d(0.1, -0.2, 0.3) - v.segment<3>(3 * i);
    Eigen::VectorXd right = m_b - m_A * prescribed;
    for (std::size_t i = 0; i < m_fixed.size(); ++i)
        if (m_fixed[i]) right.segment<3>(3 * i) = prescribed.segment<3>(3 * i);
    const Eigen::VectorXd dv = GetParam().m_clamped
                                   ? Eigen::VectorXd(constrained(m_A, m_fixed).llt().solve(right))
                                   : Eigen::VectorXd(m_rigid + elasticSolution(m_A, right, m_momentum));
    EXPECT_LE((flat(velocity(m_body)) - v - dv).norm(), 1e-6 * dv.norm());
    EXPECT_GT(dv.norm(), 0.1);
}

TEST_P(DenseStep, ImpulsesAddTheirResponse)
{
    solveFreeMotion(m_body, m_settings);
    assemble();
    const Eigen::VectorXd before = flat(velocity(m_body));
    std::vector<Vec3> impulses(m_fixed.size());
    RandomVectors random(2);
    for (Vec3& J : impulses) J = random.next();
    EXPECT_EQ(applyImpulses(m_body, impulses, m_settings).m_stop, SolveStop::converged);
    Eigen::VectorXd right = flat(impulses);
    for (std::size_t i = 0; i < m_fixed.size(); ++i)
        if (m_fixed[i]) right.segment<3>(3 * i).setZero();
    const Eigen::VectorXd expected = response(right);
    EXPECT_LE((flat(velocity(m_body)) - before - expected).norm(), 1e-6 * expected.norm());
}

// Ten responses that are solved loosely or not at all, and a last one that is solved: it includes the residuals of the
// ten.
TEST_P(DenseStep, LaterResponsesCorrectEarlierResiduals)
{
    solveFreeMotion(m_body, m_settings);
    assemble();
    const Eigen::VectorXd before = flat(velocity(m_body));
    Eigen::VectorXd right = Eigen::VectorXd::Zero(before.size());
    std::vector<Vec3> impulses(m_fixed.size());
    RandomVectors random(2);
    for (int k = 0; k <= 10; ++k)
    {
        for (Vec3& J : impulses) J = random.next();
        const Eigen::VectorXd J = flat(impulses);
        StepSettings settings = m_settings;
        if (k < 10) settings.m_tolerance = 0.3;
        const SolveReport report = applyImpulses(m_body, impulses, settings, k % 2 == 0 && k < 10 ? 10 * J.norm() : 0);
        EXPECT_EQ(report.m_stop, SolveStop::converged);
        EXPECT_EQ(report.m_iterations == 0, k % 2 == 0 && k < 10) << k;
        right += J;
    }
    for (std::size_t i = 0; i < m_fixed.size(); ++i)
        if (m_fixed[i]) right.segment<3>(3 * i).setZero();
    const Eigen::VectorXd expected = response(right);
    EXPECT_LE((flat(velocity(m_body)) - before - expected).norm(), 1e-6 * expected.norm());
}

// Loads in equilibrium: the warm start is the solution, to rounding.
TEST_P(DenseStep, SteadyGuessSavesTheSolve)
{
    for (Vec3& v : m_body.m_state.m_v) v = {};
    for (Vec3& v : m_body.m_loads.m_targetVelocity) v = {};
    solveFreeMotion(m_body, m_settings);
    assemble();
    const Eigen::VectorXd v = flat(velocity(m_body)), rigid = rigidPart(v);
    const Eigen::VectorXd elastic = -constrained(m_A, m_fixed) * (v - rigid);
    const Eigen::VectorXd holding = elastic - (1 / m_rigidFactor) * massOf(rigidResponse(elastic) + rigid);
    std::vector<Vec3> impulses(m_fixed.size());
    for (std::size_t i = 0; i < impulses.size(); ++i)
        impulses[i] = {holding(3 * i), holding(3 * i + 1), holding(3 * i + 2)};
    ImpulseResponse response = {&m_body, &impulses, m_settings, 0, true, {}};
    response.m_settings.m_tolerance = 1e-3;
    applyImpulses(&response, 1);
    EXPECT_EQ(response.m_report.m_stop, SolveStop::converged);
    EXPECT_EQ(response.m_report.m_iterations, 0);
    EXPECT_LE(largestDistance(velocity(m_body), m_body.m_state.m_v), 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Systems, DenseStep,
                         testing::Values(SystemCase{"FreeNodal", false, false, Warp::nodal},
                                         SystemCase{"FreeTensionNodal", false, true, Warp::nodal},
                                         SystemCase{"FreeTensionGlobal", false, true, Warp::global},
                                         SystemCase{"ClampedNodal", true, false, Warp::nodal},
                                         SystemCase{"ClampedTensionNodal", true, true, Warp::nodal},
                                         SystemCase{"ClampedTensionGlobal", true, true, Warp::global}),
                         [](const auto& suite) { return std::string(suite.param.m_name); });

}  // namespace
}  // namespace bullet_fem
