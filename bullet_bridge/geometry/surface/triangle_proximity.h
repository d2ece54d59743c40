// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <array>

#include "bullet_fem/fem/common/vec3.h"

namespace bullet_fem
{

/// Which part of a triangle a point lies on.
enum class TriangleFeature
{
    face,
    edge,   ///< number k runs from corner k to corner (k + 1) % 3
    corner  ///< number k
};

/// A point of a triangle.
struct TrianglePoint
{
    std::array<double, 3> m_weights = {1, 0, 0};  ///< barycentric, >= 0, sum 1 [-]
    Vec3 m_point;                                 ///< [m]
    TriangleFeature m_feature = TriangleFeature::corner;
    int m_number = 0;  ///< of the edge or corner, in [0, 3)
};

using Corners = std::array<Vec3, 3>;  ///< of a triangle [m]

/// Where a triangle is nearest to a point; for triangles that are a line or a point, too.
TrianglePoint nearestOnTriangle(const Corners& t, const Vec3& p);

/// Barycentric coordinates of a point's projection onto a triangle's plane, sum 1, negative outside. False if the
/// triangle has no area.
bool projectOnPlane(const Corners& t, const Vec3& p, std::array<double, 3>& weights);

/// Where two lines a0-a1 and b0-b1 are nearest to each other: a0 + m_a (a1 - a0) and b0 + m_b (b1 - b0).
struct LineParameters
{
    double m_a = 0, m_b = 0;  ///< [-]; in [0, 1] between the end points
};

/// False if the lines are parallel within the angle of this sine, or one has no length.
bool nearestOfLines(const std::array<Vec3, 4>& ends, double leastSine, LineParameters& at);

/// A vector that changes linearly with time.
struct MovingVector
{
    Vec3 m_at, m_change;
    Vec3 at(double t) const { return m_at + t * m_change; }
};

/// Times in (0, last] at which three moving vectors lie in a plane (their triple product changes its sign), ascending.
/// Four moving points are coplanar where the vectors from one of them to the others are. Returns their number, at most
/// 3.
int timesInOnePlane(const std::array<MovingVector, 3>& vectors, double last, std::array<double, 3>& times);

}  // namespace bullet_fem
