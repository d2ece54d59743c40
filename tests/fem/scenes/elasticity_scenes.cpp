// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/scenes/elasticity_scenes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "benchmarks/reference/warped_elements.h"
#include "fem/elements/model_elements.h"
#include "fem/factor/block_matrix.h"

namespace bullet_fem
{

std::vector<Mat3> elementRotations(const Body& body)
{
    std::vector<Mat3> R;
    for (const int lane : body.m_model->elements().m_lanes.m_lane)
        R.push_back(toMatrix(body.m_state.m_elementRotation[lane]));
    updateElementRotations(body.m_model->shape(), body.m_state.m_x, R);
    return R;
}

Material elasticMaterial(double young, double poisson, double density)
{
    Material material;
    material.m_youngModulus = young;
    material.m_poissonRatio = poisson;
    material.m_density = density;
    return material;
}

Body makeBody(const TetMesh& mesh, const ElementMaterials& materials, const NodePredicate& fixed, double step)
{
    const auto shape = std::make_shared<const RestShape>(mesh, materials);
    FactorInput input;
    input.m_mass = shape->m_lumpedMass;
    input.m_step = step;
    for (const Vec3& X : mesh.restPositions()) input.m_fixed.push_back(fixed && fixed(X));
    return Body(BodyModel::create(shape, std::move(input)));
}

void setGravity(Body& body, const Vec3& g)
{
    for (std::size_t i = 0; i < body.m_state.m_mass.size(); ++i) body.m_loads.m_force[i] = body.m_state.m_mass[i] * g;
}

std::vector<double> faceAreas(const TetMesh& mesh, const NodePredicate& onFace)
{
    const std::vector<Vec3>& X = mesh.restPositions();
    std::vector<double> areas(X.size());
    for (const Triangle& t : mesh.surface())
    {
        if (!onFace(X[t[0]]) || !onFace(X[t[1]]) || !onFace(X[t[2]])) continue;
        for (int node : t) areas[node] += norm(cross(X[t[1]] - X[t[0]], X[t[2]] - X[t[0]])) / 6;
    }
    return areas;
}

int nodeAt(const TetMesh& mesh, const Vec3& X)
{
    const auto& all = mesh.restPositions();
    const auto nearer = [&X](const Vec3& a, const Vec3& b) { return norm(a - X) < norm(b - X); };
    return static_cast<int>(std::min_element(all.begin(), all.end(), nearer) - all.begin());
}

double largestDistance(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
    {
        const double d = norm(a[i] - b[i]);
        if (!(d <= largest)) largest = d;  // NaN stays NaN
    }
    return largest;
}

Vec3 weightedMean(const std::vector<double>& weights, const std::vector<Vec3>& u)
{
    Vec3 sum;
    double total = 0;
    for (std::size_t i = 0; i < u.size(); ++i)
    {
        sum += weights[i] * u[i];
        total += weights[i];
    }
    return (1 / total) * sum;
}

// Rodrigues' formula.
Mat3 rotationAbout(const Vec3& axis, double angle)
{
    const Mat3 C = crossMatrix((1 / norm(axis)) * axis);
    return Mat3::identity() + std::sin(angle) * C + (1 - std::cos(angle)) * (C * C);
}

// Knuth's linear congruential generator: the standard's distributions differ between libraries.
double RandomVectors::number()
{
    m_state = m_state * 6364136223846793005ull + 1442695040888963407ull;
    return static_cast<double>(m_state >> 33) / static_cast<double>(1u << 30) - 1;
}

double kineticEnergy(const BodyState& state)
{
    double sum = 0;
    for (std::size_t i = 0; i < state.m_v.size(); ++i) sum += 0.5 * state.m_mass[i] * dot(state.m_v[i], state.m_v[i]);
    return sum;
}

double smallestVolumeRatio(const Body& body)
{
    const TetMesh& mesh = body.m_model->mesh();
    const std::vector<Vec3>& x = body.m_state.m_x;
    double smallest = 1e300;
    for (int e = 0; e < mesh.tetCount(); ++e)
    {
        const Tet& t = mesh.tets()[e];
        const double volume = dot(cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]]), x[t[3]] - x[t[0]]) / 6;
        smallest = std::min(smallest, volume / mesh.tetVolume(e));
    }
    return smallest;
}

double relax(Body& body, double tolerance)
{
    StepSettings settings;
    settings.m_step = body.m_model->factorInput().m_step;
    settings.m_tolerance = 1e-8;
    double moved = 1e300;
    for (int k = 0; k < 400 && !(moved <= tolerance); ++k)
    {
        std::fill(body.m_state.m_v.begin(), body.m_state.m_v.end(), Vec3());
        const std::vector<Vec3> before = body.m_state.m_x;
        step(body, settings);
        moved = largestDistance(before, body.m_state.m_x);
    }
    return moved;
}

LinearSystem::LinearSystem(const RestShape& shape, const NodePredicate& clamped)
{
    const std::vector<Vec3>& X = shape.m_mesh.restPositions();
    int count = 0;
    for (const Vec3& Xi : X) m_position.push_back(clamped(Xi) ? -1 : count++);
    m_mass.resize(3 * count);
    m_stiffness.resize(3 * count, 3 * count);
    const BlockMatrix K = assembleRestStiffness(shape);
    std::vector<Eigen::Triplet<double>> entries;
    for (int row = 0; row < K.nodeCount(); ++row)
    {
        if (m_position[row] < 0) continue;
        m_mass.segment<3>(3 * m_position[row]).setConstant(shape.m_lumpedMass[row]);
        for (int k = K.m_rowStart[row]; k < K.m_rowStart[row + 1]; ++k)
            for (int i = 0; i < 9 && m_position[K.m_column[k]] >= 0; ++i)
                entries.emplace_back(3 * m_position[row] + i / 3, 3 * m_position[K.m_column[k]] + i % 3,
                                     K.m_block[k](i / 3, i % 3));
    }
    m_stiffness.setFromTriplets(entries.begin(), entries.end());
    m_factor.compute(m_stiffness);
}

Eigen::VectorXd LinearSystem::gather(const std::vector<Vec3>& u) const
{
    Eigen::VectorXd result(m_mass.size());
    for (std::size_t i = 0; i < u.size(); ++i)
        for (int c = 0; c < 3 && m_position[i] >= 0; ++c) result[3 * m_position[i] + c] = u[i][c];
    return result;
}

std::vector<Vec3> LinearSystem::scatter(const Eigen::VectorXd& u) const
{
    std::vector<Vec3> result(m_position.size());
    for (std::size_t i = 0; i < result.size(); ++i)
        for (int c = 0; c < 3 && m_position[i] >= 0; ++c) result[i][c] = u[3 * m_position[i] + c];
    return result;
}

std::vector<Vec3> LinearSystem::displacement(const std::vector<Vec3>& force) const
{
    return scatter(m_factor.solve(gather(force)));
}

std::vector<Mode> LinearSystem::lowestModes(int count) const
{
    RandomVectors random(1);
    Eigen::MatrixXd basis(m_mass.size(), 2 * count);  // twice as many vectors, so that the last modes converge
    for (int j = 0; j < basis.cols(); ++j)
        for (int i = 0; i < basis.rows(); i += 3)
        {
            const Vec3 r = random.next();
            basis.col(j).segment<3>(i) << r.x, r.y, r.z;
        }
    Eigen::VectorXd squares;
    for (int k = 0; k < 30; ++k)
    {
        const Eigen::MatrixXd next = m_factor.solve(m_mass.asDiagonal() * basis);
        const Eigen::MatrixXd K = next.transpose() * (m_stiffness * next);
        const Eigen::MatrixXd M = next.transpose() * (m_mass.asDiagonal() * next);
        const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> ritz(K, M);
        basis = next * ritz.eigenvectors();
        squares = ritz.eigenvalues();
    }
    std::vector<Mode> modes(count);
    for (int j = 0; j < count; ++j)
    {
        modes[j].m_omega = std::sqrt(squares[j]);
        modes[j].m_shape = scatter(basis.col(j));
    }
    return modes;
}

}  // namespace bullet_fem
