// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/scenes/dense_system.h"

#include <Eigen/LU>

#include "fem/scenes/elasticity_scenes.h"

namespace bullet_fem
{

Eigen::VectorXd flat(const std::vector<Vec3>& u)
{
    Eigen::VectorXd result(3 * u.size());
    for (std::size_t i = 0; i < u.size(); ++i) result.segment<3>(3 * i) << u[i].x, u[i].y, u[i].z;
    return result;
}

std::vector<Vec3> nodes(const Eigen::VectorXd& u)
{
    std::vector<Vec3> result(u.size() / 3);
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = {u(3 * i), u(3 * i + 1), u(3 * i + 2)};
    return result;
}

Eigen::Matrix3d dense(const Mat3& a)
{
    Eigen::Matrix3d result;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) result(i, j) = a(i, j);
    return result;
}

Eigen::MatrixXd dense(const BlockMatrix& K)
{
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(3 * K.nodeCount(), 3 * K.nodeCount());
    for (int i = 0; i < K.nodeCount(); ++i)
        for (int k = K.m_rowStart[i]; k < K.m_rowStart[i + 1]; ++k)
            result.block<3, 3>(3 * i, 3 * K.m_column[k]) = dense(K.m_block[k]);
    return result;
}

Eigen::MatrixXd textbookElementStiffness(const std::array<Vec3, 4>& X, const Material& material)
{
    Eigen::Matrix4d P;  // N_a(X) = (P^-1)_0a + (P^-1)_1a X + (P^-1)_2a Y + (P^-1)_3a Z
    for (int a = 0; a < 4; ++a) P.row(a) << 1, X[a].x, X[a].y, X[a].z;
    const Eigen::Matrix4d N = P.inverse();
    Eigen::MatrixXd B = Eigen::MatrixXd::Zero(6, 12);
    for (int a = 0; a < 4; ++a)
    {
        const double x = N(1, a), y = N(2, a), z = N(3, a);
        B.block<6, 3>(0, 3 * a) << x, 0, 0, 0, y, 0, 0, 0, z, y, x, 0, 0, z, y, z, 0, x;
    }
    const double E = material.m_youngModulus, nu = material.m_poissonRatio;
    Eigen::MatrixXd C = Eigen::MatrixXd::Zero(6, 6);
    C.topLeftCorner<3, 3>() << 1 - nu, nu, nu, nu, 1 - nu, nu, nu, nu, 1 - nu;
    C.bottomRightCorner<3, 3>().diagonal().setConstant((1 - 2 * nu) / 2);
    C *= E / ((1 + nu) * (1 - 2 * nu));
    return std::abs(P.determinant()) / 6 * B.transpose() * C * B;
}

namespace
{

// K V (G G^T - the mean of g g^T) of each patch, where K is the bulk modulus, g p an element's volume change and G the
// mean of g.
void averageDilatations(const TetMesh& mesh, const Material& material, const std::vector<Mat3>& R, Eigen::MatrixXd& K)
{
    const ElementPatches patches(mesh);
    const double bulk = material.m_youngModulus / (3 * (1 - 2 * material.m_poissonRatio));
    const std::vector<Vec3>& X = mesh.restPositions();
    for (int p = 0; p < patches.count(); ++p)
    {
        Eigen::VectorXd G = Eigen::VectorXd::Zero(K.rows());
        double volume = 0;
        for (int k = patches.m_start[p]; k < patches.m_start[p + 1]; ++k)
        {
            const int e = patches.m_element[k];
            Eigen::VectorXd g = Eigen::VectorXd::Zero(K.rows());
            for (int a = 0; a < 4; ++a)
            {
                // Area vector of the face opposite a, pointing towards it, over three times the volume.
                const Tet& t = mesh.tets()[e];
                const Vec3 &b = X[t[(a + 1) % 4]], &c = X[t[(a + 2) % 4]], &d = X[t[(a + 3) % 4]];
                const Vec3 normal = cross(c - b, d - b);
                const Vec3 gradient = R[e] * ((1 / dot(normal, X[t[a]] - b)) * normal);
                for (int i = 0; i < 3; ++i) g(3 * t[a] + i) = gradient[i];
            }
            G += mesh.tetVolume(e) * g;
            volume += mesh.tetVolume(e);
            K -= bulk * mesh.tetVolume(e) * g * g.transpose();
        }
        K += bulk / volume * G * G.transpose();
    }
}

}  // namespace

Eigen::MatrixXd denseStiffness(const TetMesh& mesh, const Material& material, const std::vector<Mat3>& R)
{
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(3 * mesh.nodeCount(), 3 * mesh.nodeCount());
    for (int e = 0; e < mesh.tetCount(); ++e)
    {
        const Tet& tet = mesh.tets()[e];
        const std::vector<Vec3>& X = mesh.restPositions();
        const Eigen::MatrixXd K_e = textbookElementStiffness({X[tet[0]], X[tet[1]], X[tet[2]], X[tet[3]]}, material);
        const Eigen::Matrix3d R_e = dense(R[e]);
        for (int a = 0; a < 4; ++a)
            for (int b = 0; b < 4; ++b)
                K.block<3, 3>(3 * tet[a], 3 * tet[b]) += R_e * K_e.block<3, 3>(3 * a, 3 * b) * R_e.transpose();
    }
    if (material.usesMeanDilatation()) averageDilatations(mesh, material, R, K);
    return K;
}

Eigen::MatrixXd denseRestSystem(const RestShape& shape, const FactorInput& input)
{
    const double h = input.m_step;
    const std::vector<Mat3> R(shape.m_mesh.tetCount(), Mat3::identity());
    Eigen::MatrixXd A =
        (h * h + h * shape.m_material.m_stiffnessDamping) * denseStiffness(shape.m_mesh, shape.m_material, R);
    for (Eigen::Index i = 0; i < A.rows(); ++i)
        A(i, i) += (1 + h * shape.m_material.m_massDamping) * input.m_mass[i / 3];
    return A;
}

Eigen::MatrixXd constrained(Eigen::MatrixXd A, const std::vector<unsigned char>& fixed)
{
    for (Eigen::Index i = 0; i < A.rows(); ++i)
    {
        if (!fixed[i / 3]) continue;
        A.row(i).setZero();
        A.col(i).setZero();
        A(i, i) = 1;
    }
    return A;
}

SparsePattern sparsePattern(const Eigen::MatrixXd& A)
{
    SparsePattern lower;
    lower.m_size = static_cast<int>(A.rows());
    lower.m_columnStart.push_back(0);
    for (int j = 0; j < lower.m_size; ++j)
    {
        for (int i = j; i < lower.m_size; ++i)
            if (i == j || A(i, j) != 0) lower.m_rowIndex.push_back(i);
        lower.m_columnStart.push_back(static_cast<int>(lower.m_rowIndex.size()));
    }
    return lower;
}

namespace
{

// A symmetric diagonally dominant matrix with random entries at the pairs for which `coupled` is true.
template <typename Coupled>
Eigen::MatrixXd dominantMatrix(int n, Coupled coupled)
{
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
    RandomVectors random(11);
    for (int j = 0; j < n; ++j)
        for (int i = j + 1; i < n; ++i)
        {
            const double value = random.next().x;
            if (coupled(i, j)) A(i, j) = A(j, i) = value;
        }
    for (int i = 0; i < n; ++i) A(i, i) = 1 + 1.2 * A.row(i).cwiseAbs().sum();
    return A;
}

}  // namespace

Eigen::MatrixXd diagonalMatrix(int n)
{
    return Eigen::VectorXd::LinSpaced(n, 1, 9).asDiagonal();
}

Eigen::MatrixXd fullMatrix(int n)
{
    return dominantMatrix(n, [](int, int) { return true; });
}

Eigen::MatrixXd tridiagonalMatrix(int n)
{
    return dominantMatrix(n, [](int i, int j) { return i == j + 1; });
}

Eigen::MatrixXd arrowMatrix(int n)
{
    return dominantMatrix(n, [](int, int j) { return j == 0; });
}

Eigen::MatrixXd gridMatrix(int side)
{
    return dominantMatrix(3 * side * side,
                          [side](int i, int j)
                          {
                              const int p = i / 3, q = j / 3;
                              return std::abs(p / side - q / side) <= 1 && std::abs(p % side - q % side) <= 1;
                          });
}

Eigen::MatrixXd rigidModes(const std::vector<Vec3>& x, const std::vector<double>& mass)
{
    Vec3 center;
    double total = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
    {
        center += mass[i] * x[i];
        total += mass[i];
    }
    Eigen::MatrixXd G(3 * x.size(), 6);
    for (std::size_t i = 0; i < x.size(); ++i)
    {
        const Vec3 r = x[i] - (1 / total) * center;
        G.block<3, 3>(3 * i, 0).setIdentity();
        G.block<3, 3>(3 * i, 3) << 0, r.z, -r.y, -r.z, 0, r.x, r.y, -r.x, 0;
    }
    return G;
}

Eigen::VectorXd elasticSolution(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, const Eigen::MatrixXd& momentum)
{
    const Eigen::Index n = A.rows(), k = momentum.cols();
    Eigen::MatrixXd bordered = Eigen::MatrixXd::Zero(n + k, n + k);
    bordered << A, momentum, momentum.transpose(), Eigen::MatrixXd::Zero(k, k);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(n + k);
    right.head(n) = b;
    return bordered.fullPivLu().solve(right).head(n);
}

}  // namespace bullet_fem
