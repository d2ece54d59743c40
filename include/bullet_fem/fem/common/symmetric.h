// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// A symmetric 3x3 tensor as six components in VTK's order: a stress [Pa], or a strain [-] whose shear components are
/// not doubled.
struct SymmetricTensor
{
    double xx = 0;  ///< xx component [Pa] or [-]
    double yy = 0;  ///< yy component
    double zz = 0;  ///< zz component
    double xy = 0;  ///< xy component
    double yz = 0;  ///< yz component
    double xz = 0;  ///< xz component

    /// Adds every component.
    SymmetricTensor& operator+=(const SymmetricTensor& b)
    {
        return xx += b.xx, yy += b.yy, zz += b.zz, xy += b.xy, yz += b.yz, xz += b.xz, *this;
    }
    /// Multiplies every component.
    SymmetricTensor& operator*=(double s) { return xx *= s, yy *= s, zz *= s, xy *= s, yz *= s, xz *= s, *this; }

    /// True if all six components are equal.
    friend bool operator==(const SymmetricTensor& a, const SymmetricTensor& b)
    {
        return a.xx == b.xx && a.yy == b.yy && a.zz == b.zz && a.xy == b.xy && a.yz == b.yz && a.xz == b.xz;
    }
    /// True if any component differs.
    friend bool operator!=(const SymmetricTensor& a, const SymmetricTensor& b) { return !(a == b); }
};

/// Product s a.
inline SymmetricTensor operator*(double s, SymmetricTensor a)
{
    return a *= s;
}
/// Sum a + b.
inline SymmetricTensor operator+(SymmetricTensor a, const SymmetricTensor& b)
{
    return a += b;
}
/// Trace: the sum of the normal components.
inline double trace(const SymmetricTensor& a)
{
    return a.xx + a.yy + a.zz;
}
/// Double contraction a : b, the sum over all nine entries.
inline double contraction(const SymmetricTensor& a, const SymmetricTensor& b)
{
    return a.xx * b.xx + a.yy * b.yy + a.zz * b.zz + 2 * (a.xy * b.xy + a.yz * b.yz + a.xz * b.xz);
}
/// Deviator a - tr(a) / 3 I.
inline SymmetricTensor deviator(SymmetricTensor a)
{
    const double mean = trace(a) / 3;
    return a.xx -= mean, a.yy -= mean, a.zz -= mean, a;
}
/// The tensor as a full 3x3 matrix.
inline Mat3 toMatrix(const SymmetricTensor& a)
{
    return {{{a.xx, a.xy, a.xz}, {a.xy, a.yy, a.yz}, {a.xz, a.yz, a.zz}}};
}
/// Symmetric part (A + A^T) / 2.
inline SymmetricTensor symmetricPart(const Mat3& A)
{
    return {A(0, 0), A(1, 1), A(2, 2), 0.5 * (A(0, 1) + A(1, 0)), 0.5 * (A(1, 2) + A(2, 1)), 0.5 * (A(0, 2) + A(2, 0))};
}

}  // namespace bullet_fem
