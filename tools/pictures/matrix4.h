// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>

#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// A 4x4 matrix as OpenGL takes it: m[4 j + i] is row i, column j.
using Matrix4 = std::array<float, 16>;

/// Builds a matrix from rows 0 to 3, as vectors for the point and constants: (r0 x + c0, r1 x + c1, r2 x + c2, r3 x +
/// c3).
struct Matrix4Rows
{
    Vec3 m_row[4];
    double m_constant[4] = {0, 0, 0, 1};
};

inline Matrix4 matrix4(const Matrix4Rows& rows)
{
    Matrix4 m{};
    for (int i = 0; i < 4; ++i)
    {
        for (int j = 0; j < 3; ++j) m[4 * j + i] = static_cast<float>(rows.m_row[i][j]);
        m[12 + i] = static_cast<float>(rows.m_constant[i]);
    }
    return m;
}

}  // namespace bullet_fem
