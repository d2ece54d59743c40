// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/reference/positive_part.h"

#include <Eigen/Eigenvalues>

namespace bullet_fem
{
namespace
{

// True if sign A has positive pivots.
bool isPositive(const Mat3& A, double sign)
{
    const double a = sign * A(0, 0);
    if (!(a > 0)) return false;
    const double l1 = sign * A(1, 0) / a, l2 = sign * A(2, 0) / a;
    const double b = sign * A(1, 1) - l1 * sign * A(1, 0);
    if (!(b > 0)) return false;
    const double c = sign * A(2, 1) - l2 * sign * A(1, 0);
    return sign * A(2, 2) - l2 * sign * A(2, 0) - c * c / b > 0;
}

}  // namespace

Mat3 positivePart(const Mat3& symmetric)
{
    if (isPositive(symmetric, 1)) return symmetric;
    if (isPositive(symmetric, -1)) return {};
    Eigen::Matrix3d A;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) A(i, j) = symmetric(i, j);
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
    eigen.computeDirect(A);
    Mat3 result;
    for (int k = 0; k < 3; ++k)
    {
        const Vec3 q = {eigen.eigenvectors()(0, k), eigen.eigenvectors()(1, k), eigen.eigenvectors()(2, k)};
        if (eigen.eigenvalues()(k) > 0) result += eigen.eigenvalues()(k) * outer(q, q);
    }
    return result;
}

}  // namespace bullet_fem
