// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/common/rotation.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>

namespace bullet_fem
{
namespace
{

constexpr int kMaxWarmIterations = 8;
constexpr double kConverged = 1e-9;  // last rotation increment [rad]; the next one would be its square

// R <- exp(w) R by the Cayley map, which is a rotation for every w.
Mat3 rotatedBy(const Vec3& w, const Mat3& R)
{
    const Vec3 c = 0.5 * w;
    const double s = 2 / (1 + dot(c, c));
    Mat3 result = R;
    for (int j = 0; j < 3; ++j)
    {
        const Vec3 r = R.column(j), cr = cross(c, r);
        const Vec3 turned = r + s * (cr + cross(c, cr));
        result(0, j) = turned.x, result(1, j) = turned.y, result(2, j) = turned.z;
    }
    return result;
}

// Gram-Schmidt: removes the drift of R^T R from accumulated increments.
Mat3 orthonormalised(const Mat3& R)
{
    Vec3 a = R.column(0);
    a *= 1 / norm(a);
    Vec3 b = R.column(1);
    b -= dot(a, b) * a;
    b *= 1 / norm(b);
    return Mat3::fromColumns(a, b, cross(a, b));
}

// Solves the symmetric H w = g if H is positive definite beyond rounding, by Cholesky on its three pivots.
bool solvePositiveDefinite(const Mat3& H, const Vec3& g, Vec3& w)
{
    const double tiny = 1e-10 * trace(H);
    if (!(tiny > 0)) return false;
    const double d0 = H(0, 0);
    if (!(d0 > tiny)) return false;
    const double l10 = H(1, 0) / d0, l20 = H(2, 0) / d0;
    const double d1 = H(1, 1) - l10 * H(1, 0);
    if (!(d1 > tiny)) return false;
    const double l21 = (H(2, 1) - l20 * H(1, 0)) / d1;
    const double d2 = H(2, 2) - l20 * H(2, 0) - l21 * l21 * d1;
    if (!(d2 > tiny)) return false;
    const double y1 = g.y - l10 * g.x, y2 = g.z - l20 * g.x - l21 * y1;
    w.z = y2 / d2;
    w.y = y1 / d1 - l21 * w.z;
    w.x = g.x / d0 - l10 * w.y - l20 * w.z;
    return true;
}

// Newton on the maximum of tr(R^T F) over rotations. With S = F R^T the gradient is g = axl(S - S^T) and minus the
// Hessian H = tr(S) I - sym(S); where H is positive definite and g = 0, R is the global maximum, that is, the polar
// rotation.
bool warmPolarRotation(const Mat3& F, Mat3& R)
{
    for (int k = 0; k < kMaxWarmIterations; ++k)
    {
        const Mat3 S = timesTranspose(F, R);
        const Vec3 g = {S(2, 1) - S(1, 2), S(0, 2) - S(2, 0), S(1, 0) - S(0, 1)};
        const double t = trace(S);
        const double h01 = -0.5 * (S(0, 1) + S(1, 0)), h02 = -0.5 * (S(0, 2) + S(2, 0)),
                     h12 = -0.5 * (S(1, 2) + S(2, 1));
        const Mat3 H = {{{t - S(0, 0), h01, h02}, {h01, t - S(1, 1), h12}, {h02, h12, t - S(2, 2)}}};
        Vec3 w;
        if (!solvePositiveDefinite(H, g, w)) return false;
        R = rotatedBy(w, R);
        if (dot(w, w) < kConverged * kConverged)
        {
            R = orthonormalised(R);
            return true;
        }
    }
    return false;
}

// Singular value decomposition; the sign of the smallest singular value makes det = +1. A small multiple of the guess
// resolves rotations that F leaves undetermined. Returns the guess on overflow, where Eigen leaves the vectors
// unwritten.
Mat3 coldPolarRotation(const Mat3& F, const Mat3& guess)
{
    Eigen::Matrix3d A;
    const double tie = 1e-12 * std::sqrt(squaredNorm(F)) + 1e-300;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) A(i, j) = F(i, j) + tie * guess(i, j);
    if (!A.allFinite()) return guess;
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(A / A.cwiseAbs().maxCoeff(), Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Matrix3d U = svd.matrixU();
    if (U.determinant() * svd.matrixV().determinant() < 0) U.col(2) *= -1;
    const Eigen::Matrix3d R = U * svd.matrixV().transpose();
    Mat3 result;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) result(i, j) = R(i, j);
    return orthonormalised(result);
}

}  // namespace

Mat3 polarRotation(const Mat3& F, const Mat3& guess)
{
    Mat3 R = guess;
    if (warmPolarRotation(F, R)) return R;
    R = coldPolarRotation(F, guess);
    Mat3 polished = R;
    return warmPolarRotation(F, polished) ? polished : R;
}

Mat3 exponential(const Vec3& w)
{
    const double angle = norm(w);
    if (!(angle > 0)) return Mat3::identity();
    const Vec3 axis = (1 / angle) * w;
    const double half = std::sin(0.5 * angle);
    const Mat3 K = crossMatrix(axis);
    return Mat3::identity() + std::sin(angle) * K + (2 * half * half) * (K * K);
}

}  // namespace bullet_fem
