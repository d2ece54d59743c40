// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>
#include <cmath>

/// The core of BulletFEM. It does not depend on Bullet; all quantities are in double precision and SI units.
namespace bullet_fem
{

/// A vector of three doubles, tightly packed: an array of n vectors is an array of 3n doubles.
struct Vec3
{
    double x = 0;  ///< first component
    double y = 0;  ///< second component
    double z = 0;  ///< third component

    /// Component i in [0, 3), writable.
    double& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
    /// Component i in [0, 3).
    double operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }

    /// Adds every component.
    Vec3& operator+=(const Vec3& b) { return x += b.x, y += b.y, z += b.z, *this; }
    /// Subtracts every component.
    Vec3& operator-=(const Vec3& b) { return x -= b.x, y -= b.y, z -= b.z, *this; }
    /// Multiplies every component.
    Vec3& operator*=(double s) { return x *= s, y *= s, z *= s, *this; }
};

/// Sum a + b.
inline Vec3 operator+(Vec3 a, const Vec3& b)
{
    return a += b;
}
/// Difference a - b.
inline Vec3 operator-(Vec3 a, const Vec3& b)
{
    return a -= b;
}
/// Negation -a.
inline Vec3 operator-(const Vec3& a)
{
    return {-a.x, -a.y, -a.z};
}
/// Product a s.
inline Vec3 operator*(Vec3 a, double s)
{
    return a *= s;
}
/// Product s a.
inline Vec3 operator*(double s, Vec3 a)
{
    return a *= s;
}
/// Dot product.
inline double dot(const Vec3& a, const Vec3& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
/// Component-wise product.
inline Vec3 scaled(const Vec3& a, const Vec3& b)
{
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}
/// Cross product.
inline Vec3 cross(const Vec3& a, const Vec3& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// Euclidean norm, >= 0.
inline double norm(const Vec3& a)
{
    return std::sqrt(dot(a, a));
}
/// True if every component is finite.
inline bool isFinite(const Vec3& a)
{
    return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

/// A 3x3 matrix, row-major: a(i, j) is row i, column j.
struct Mat3
{
    /// Rows.
    double m[3][3] = {};

    /// Entry in row i, column j, both in [0, 3), writable.
    double& operator()(int i, int j) { return m[i][j]; }
    /// Entry in row i, column j, both in [0, 3).
    double operator()(int i, int j) const { return m[i][j]; }

    /// The identity matrix.
    static Mat3 identity() { return diagonal(1); }
    /// The diagonal matrix s I.
    static Mat3 diagonal(double s)
    {
        Mat3 a;
        a.m[0][0] = a.m[1][1] = a.m[2][2] = s;
        return a;
    }
    /// The matrix whose columns are a, b, c.
    static Mat3 fromColumns(const Vec3& a, const Vec3& b, const Vec3& c)
    {
        return {{{a.x, b.x, c.x}, {a.y, b.y, c.y}, {a.z, b.z, c.z}}};
    }
    /// Column j in [0, 3).
    Vec3 column(int j) const { return {m[0][j], m[1][j], m[2][j]}; }

    /// Adds every entry.
    Mat3& operator+=(const Mat3& b)
    {
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) m[i][j] += b.m[i][j];
        return *this;
    }
    /// Subtracts every entry.
    Mat3& operator-=(const Mat3& b)
    {
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) m[i][j] -= b.m[i][j];
        return *this;
    }
    /// Multiplies every entry.
    Mat3& operator*=(double s)
    {
        for (auto& row : m)
            for (double& a : row) a *= s;
        return *this;
    }
};

/// Sum a + b.
inline Mat3 operator+(Mat3 a, const Mat3& b)
{
    return a += b;
}
/// Difference a - b.
inline Mat3 operator-(Mat3 a, const Mat3& b)
{
    return a -= b;
}
/// Product a s.
inline Mat3 operator*(Mat3 a, double s)
{
    return a *= s;
}
/// Product s a.
inline Mat3 operator*(double s, Mat3 a)
{
    return a *= s;
}

/// Matrix-vector product a v.
inline Vec3 operator*(const Mat3& a, const Vec3& v)
{
    return {a.m[0][0] * v.x + a.m[0][1] * v.y + a.m[0][2] * v.z, a.m[1][0] * v.x + a.m[1][1] * v.y + a.m[1][2] * v.z,
            a.m[2][0] * v.x + a.m[2][1] * v.y + a.m[2][2] * v.z};
}
/// Matrix-vector product a^T v.
inline Vec3 transposeTimes(const Mat3& a, const Vec3& v)
{
    return {a.m[0][0] * v.x + a.m[1][0] * v.y + a.m[2][0] * v.z, a.m[0][1] * v.x + a.m[1][1] * v.y + a.m[2][1] * v.z,
            a.m[0][2] * v.x + a.m[1][2] * v.y + a.m[2][2] * v.z};
}
/// Matrix product a b.
inline Mat3 operator*(const Mat3& a, const Mat3& b)
{
    Mat3 c;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) c.m[i][j] = a.m[i][0] * b.m[0][j] + a.m[i][1] * b.m[1][j] + a.m[i][2] * b.m[2][j];
    return c;
}
/// Matrix product a^T b.
inline Mat3 transposeTimes(const Mat3& a, const Mat3& b)
{
    Mat3 c;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) c.m[i][j] = a.m[0][i] * b.m[0][j] + a.m[1][i] * b.m[1][j] + a.m[2][i] * b.m[2][j];
    return c;
}
/// Matrix product a b^T.
inline Mat3 timesTranspose(const Mat3& a, const Mat3& b)
{
    Mat3 c;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) c.m[i][j] = a.m[i][0] * b.m[j][0] + a.m[i][1] * b.m[j][1] + a.m[i][2] * b.m[j][2];
    return c;
}
/// Transpose a^T.
inline Mat3 transpose(const Mat3& a)
{
    return {{{a.m[0][0], a.m[1][0], a.m[2][0]}, {a.m[0][1], a.m[1][1], a.m[2][1]}, {a.m[0][2], a.m[1][2], a.m[2][2]}}};
}
/// Outer product a b^T.
inline Mat3 outer(const Vec3& a, const Vec3& b)
{
    return {{{a.x * b.x, a.x * b.y, a.x * b.z}, {a.y * b.x, a.y * b.y, a.y * b.z}, {a.z * b.x, a.z * b.y, a.z * b.z}}};
}
/// The cross-product matrix of w: crossMatrix(w) v = w x v.
inline Mat3 crossMatrix(const Vec3& w)
{
    return {{{0, -w.z, w.y}, {w.z, 0, -w.x}, {-w.y, w.x, 0}}};
}
/// Trace: the sum of the diagonal.
inline double trace(const Mat3& a)
{
    return a.m[0][0] + a.m[1][1] + a.m[2][2];
}
/// Determinant of a.
inline double determinant(const Mat3& a)
{
    return dot(a.column(0), cross(a.column(1), a.column(2)));
}
/// Inverse by cofactors; the caller ensures det(a) != 0.
inline Mat3 inverse(const Mat3& a)
{
    const Vec3 r0 = cross(a.column(1), a.column(2)), r1 = cross(a.column(2), a.column(0)),
               r2 = cross(a.column(0), a.column(1));
    const double s = 1 / dot(a.column(0), r0);
    return {{{r0.x * s, r0.y * s, r0.z * s}, {r1.x * s, r1.y * s, r1.z * s}, {r2.x * s, r2.y * s, r2.z * s}}};
}
/// Squared Frobenius norm.
inline double squaredNorm(const Mat3& a)
{
    double s = 0;
    for (const auto& row : a.m)
        for (double v : row) s += v * v;
    return s;
}

}  // namespace bullet_fem
