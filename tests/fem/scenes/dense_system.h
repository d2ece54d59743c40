// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <Eigen/Core>
#include <vector>

#include "bullet_fem/fem/factor/body_model.h"
#include "fem/factor/block_matrix.h"
#include "fem/factor/fill_order.h"

namespace bullet_fem
{

// The method's matrices, dense and from textbook formulas: nothing here calls the code under test.

/// The entries of node vectors one after the other.
Eigen::VectorXd flat(const std::vector<Vec3>& u);
std::vector<Vec3> nodes(const Eigen::VectorXd& u);
Eigen::Matrix3d dense(const Mat3& a);
Eigen::MatrixXd dense(const BlockMatrix& K);

/// K_e = V B^T C B [N/m] with the 6x12 strain-displacement matrix B of engineering strains.
Eigen::MatrixXd textbookElementStiffness(const std::array<Vec3, 4>& X, const Material& material);

/// Sum over e of R_e K_e R_e^T [N/m], by assembly.
Eigen::MatrixXd denseStiffness(const TetMesh& mesh, const Material& material, const std::vector<Mat3>& R);

/// A0 = (1 + h alpha) M + (h^2 + h beta) K over all nodes [kg].
Eigen::MatrixXd denseRestSystem(const RestShape& shape, const FactorInput& input);

/// The six rigid modes about the centre of mass, one per column.
Eigen::MatrixXd rigidModes(const std::vector<Vec3>& x, const std::vector<double>& mass);

/// The vector e without momentum, G^T M e = 0, that minimizes e . A e / 2 - b . e, for the modes G.
Eigen::VectorXd elasticSolution(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, const Eigen::MatrixXd& momentum);

/// A without the rows and columns of the fixed nodes, which get ones on the diagonal.
Eigen::MatrixXd constrained(Eigen::MatrixXd A, const std::vector<unsigned char>& fixed);

/// The pattern of nonzero entries of A; exact zeros are left out except on the diagonal.
SparsePattern sparsePattern(const Eigen::MatrixXd& A);

/// Matrices with typical patterns of factorizations. Symmetric, positive definite, condition below 100.
Eigen::MatrixXd diagonalMatrix(int n);
Eigen::MatrixXd fullMatrix(int n);
Eigen::MatrixXd tridiagonalMatrix(int n);
Eigen::MatrixXd arrowMatrix(int n);    ///< first row, first column and diagonal
Eigen::MatrixXd gridMatrix(int side);  ///< 3x3 blocks on a square grid of side^2 nodes, the pattern of a mesh

}  // namespace bullet_fem
