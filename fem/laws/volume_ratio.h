// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>
#include <cmath>

#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// Ratio J0 below which functions of J = det F go on as a parabola [-], so that flat and inverted elements have finite
/// stresses that drive them back.
constexpr double kMinVolumeRatio = 0.1;

/// Adjugate of a matrix.
inline Mat3 adjugateOf(const Mat3& A)
{
    const Vec3 a = A.column(0), b = A.column(1), c = A.column(2);
    return transpose(Mat3::fromColumns(cross(b, c), cross(c, a), cross(a, b)));
}

/// gamma(J) = (J^2 - 1 - 2 ln J) / 4 and its derivatives, for j = J - 1: lambda gamma is the energy of volume changes
/// in Ciarlet's form [Ciarlet 1988, 4.10]. Below J0 = kMinVolumeRatio a parabola of equal value, slope and curvature.
struct VolumeFunction
{
    explicit VolumeFunction(double j)
    {
        const double above = std::max(j, kMinVolumeRatio - 1), below = j - above, inverse = 1 / (1 + above);
        m_curvature = 0.5 * (1 + inverse * inverse);
        const double slope = above * (1 + 0.5 * above) * inverse;
        m_slope = slope + m_curvature * below;
        m_value = 0.5 * (above + 0.5 * above * above - std::log1p(above)) + (slope + 0.5 * m_curvature * below) * below;
    }

    double m_value, m_slope, m_curvature;
};

}  // namespace bullet_fem
