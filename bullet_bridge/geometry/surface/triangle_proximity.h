// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>

#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// The feature of a triangle that a point lies on.
enum class TriangleFeature
{
    face,
    edge,   ///< edge k is from corner k to corner (k + 1) % 3
    corner  ///< corner k
};

/// A point of a triangle.
struct TrianglePoint
{
    std::array<double, 3> m_weights = {1, 0, 0};  ///< barycentric, >= 0, sum 1 [-]
    Vec3 m_point;                                 ///< [m]
    TriangleFeature m_feature = TriangleFeature::corner;
    int m_number = 0;  ///< of the edge or corner, in [0, 3)
};

using Corners = std::array<Vec3, 3>;  ///< corners of a triangle [m]

/// The unit vector of a; zero if a is zero.
inline Vec3 unit(const Vec3& a)
{
    const double length = norm(a);
    return length > 0 ? (1 / length) * a : Vec3();
}

/// The angle between two vectors [rad].
inline double angleBetween(const Vec3& a, const Vec3& b)
{
    return std::atan2(norm(cross(a, b)), dot(a, b));
}

/// The unit normal of a triangle; zero without area.
inline Vec3 normalOf(const Corners& t)
{
    return unit(cross(t[1] - t[0], t[2] - t[0]));
}

/// The point of a triangle that is nearest to p. The triangle may degenerate to a line or a point.
TrianglePoint nearestOnTriangle(const Corners& t, const Vec3& p);

/// Barycentric coordinates of the projection of a point onto a triangle's plane: sum 1, negative outside. False if the
/// triangle has no area.
bool projectOnPlane(const Corners& t, const Vec3& p, std::array<double, 3>& weights);

/// The nearest points of two lines a0-a1 and b0-b1: a0 + m_a (a1 - a0) and b0 + m_b (b1 - b0).
struct LineParameters
{
    double m_a = 0, m_b = 0;  ///< [-]; in [0, 1] between the ends
};

/// Finds the nearest points of the lines `ends` = a0, a1, b0, b1 [m]. False if the sine of the angle between them is at
/// most `minSine`, or one has no length.
bool nearestOfLines(const std::array<Vec3, 4>& ends, double minSine, LineParameters& at);

/// A vector that changes linearly with time.
struct MovingVector
{
    Vec3 m_at, m_change;
    Vec3 at(double t) const { return m_at + t * m_change; }
};

/// Times in (0, last] at which three linearly moving vectors are coplanar (their triple product changes sign),
/// ascending. Four moving points are coplanar when the vectors from one of them to the others are. Returns the number
/// of times, at most 3.
int timesInOnePlane(const std::array<MovingVector, 3>& vectors, double last, std::array<double, 3>& times);

}  // namespace bullet_fem
