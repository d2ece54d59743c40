// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/body/rigid_sums.h"

#include <Eigen/Eigenvalues>

namespace bullet_fem
{

Vec3 spinOf(const Mat3& inertia, const Vec3& L, double least)
{
    Eigen::Matrix3d I;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) I(i, j) = inertia(i, j);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(I);
    Vec3 spin;
    for (int k = 0; k < 3; ++k)
    {
        const double moment = axes.eigenvalues()(k);
        if (!(moment > least)) continue;
        const Vec3 axis = {axes.eigenvectors()(0, k), axes.eigenvectors()(1, k), axes.eigenvectors()(2, k)};
        spin += dot(axis, L) / moment * axis;
    }
    return spin;
}

}  // namespace bullet_fem
