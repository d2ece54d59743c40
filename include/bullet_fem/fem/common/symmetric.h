// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// A symmetric 3x3 tensor in six numbers, in the order in which VTK writes them: a stress [Pa] or a strain [-], of
/// which the shears are not doubled.
struct SymmetricTensor
{
    double xx = 0;  ///< normal [Pa] or [-], and so on
    double yy = 0;  ///< normal
    double zz = 0;  ///< normal
    double xy = 0;  ///< shear
    double yz = 0;  ///< shear
    double xz = 0;  ///< shear

    /// Adds every component.
    SymmetricTensor& operator+=(const SymmetricTensor& b)
    {
        return xx += b.xx, yy += b.yy, zz += b.zz, xy += b.xy, yz += b.yz, xz += b.xz, *this;
    }
    /// Multiplies every component.
    SymmetricTensor& operator*=(double s) { return xx *= s, yy *= s, zz *= s, xy *= s, yz *= s, xz *= s, *this; }

    /// The same numbers.
    friend bool operator==(const SymmetricTensor& a, const SymmetricTensor& b)
    {
        return a.xx == b.xx && a.yy == b.yy && a.zz == b.zz && a.xy == b.xy && a.yz == b.yz && a.xz == b.xz;
    }
    /// Not so.
    friend bool operator!=(const SymmetricTensor& a, const SymmetricTensor& b) { return !(a == b); }
};

/// s a.
inline SymmetricTensor operator*(double s, SymmetricTensor a)
{
    return a *= s;
}
/// a + b.
inline SymmetricTensor operator+(SymmetricTensor a, const SymmetricTensor& b)
{
    return a += b;
}
/// The sum of the normal components.
inline double trace(const SymmetricTensor& a)
{
    return a.xx + a.yy + a.zz;
}
/// a : b, the sum over all nine entries.
inline double contraction(const SymmetricTensor& a, const SymmetricTensor& b)
{
    return a.xx * b.xx + a.yy * b.yy + a.zz * b.zz + 2 * (a.xy * b.xy + a.yz * b.yz + a.xz * b.xz);
}
/// a - tr(a) / 3 I.
inline SymmetricTensor deviator(SymmetricTensor a)
{
    const double mean = trace(a) / 3;
    return a.xx -= mean, a.yy -= mean, a.zz -= mean, a;
}
/// The same with all nine entries.
inline Mat3 toMatrix(const SymmetricTensor& a)
{
    return {{{a.xx, a.xy, a.xz}, {a.xy, a.yy, a.yz}, {a.xz, a.yz, a.zz}}};
}
/// (A + A^T) / 2.
inline SymmetricTensor symmetricPart(const Mat3& A)
{
    return {A(0, 0), A(1, 1), A(2, 2), 0.5 * (A(0, 1) + A(1, 0)), 0.5 * (A(1, 2) + A(2, 1)), 0.5 * (A(0, 2) + A(2, 0))};
}

}  // namespace bullet_fem
