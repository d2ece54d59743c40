// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/geometry/surface/triangle_proximity.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bullet_fem
{
namespace
{

constexpr double kTimeRounding = 4e-16;  // relative rounding error of times

// The cubic a + b t + c t^2 + d t^3.
struct Cubic
{
    double a, b, c, d;
    double at(double t) const { return a + t * (b + t * (c + t * d)); }
    double slopeAt(double t) const { return b + t * (2 * c + t * 3 * d); }
};

double triple(const Vec3& u, const Vec3& v, const Vec3& w)
{
    return dot(u, cross(v, w));
}

Cubic tripleProduct(const std::array<MovingVector, 3>& m)
{
    const Vec3 &u = m[0].m_at, &v = m[1].m_at, &w = m[2].m_at;
    const Vec3 &du = m[0].m_change, &dv = m[1].m_change, &dw = m[2].m_change;
    return {triple(u, v, w), triple(du, v, w) + triple(u, dv, w) + triple(u, v, dw),
            triple(u, dv, dw) + triple(du, v, dw) + triple(du, dv, w), triple(du, dv, dw)};
}

// The Bernstein coefficients of the cubic on [0, T] enclose its values: there is no root if all have one sign.
bool hasNoRoot(const Cubic& f, double T)
{
    const double b0 = f.a, b1 = f.a + f.b * T / 3, b2 = f.a + (2 * f.b + f.c * T) * T / 3, b3 = f.at(T);
    return std::min({b0, b1, b2, b3}) > 0 || std::max({b0, b1, b2, b3}) < 0;
}

// Root between two times of different sign by Newton's method with bisection as a safeguard; 52 bisections exhaust a
// double.
double rootBetween(const Cubic& f, double low, double high)
{
    const bool rises = f.at(high) > 0;
    const double rounding = kTimeRounding * high;
    double time = 0.5 * (low + high);
    for (int k = 0; k < 52; ++k)
    {
        const double value = f.at(time);
        ((value > 0) == rises ? high : low) = time;
        double next = time - value / f.slopeAt(time);
        if (!(next > low && next < high)) next = 0.5 * (low + high);
        const double change = std::fabs(next - time);
        time = next;
        if (change <= rounding) break;
    }
    return time;
}

TrianglePoint pointOf(const Corners& t, const std::array<double, 3>& w, TriangleFeature feature, int number)
{
    return {w, w[0] * t[0] + w[1] * t[1] + w[2] * t[2], feature, number};
}

TrianglePoint nearestOnEdge(const Corners& t, int k, const Vec3& p)
{
    const int next = (k + 1) % 3;
    const Vec3 e = t[next] - t[k];
    const double length2 = dot(e, e);
    const double s = length2 > 0 ? dot(p - t[k], e) / length2 : 0;
    std::array<double, 3> w = {0, 0, 0};
    w[k] = s <= 0 ? 1 : s >= 1 ? 0 : 1 - s;
    w[next] = 1 - w[k];
    if (w[k] == 1) return pointOf(t, w, TriangleFeature::corner, k);
    if (w[next] == 1) return pointOf(t, w, TriangleFeature::corner, next);
    return pointOf(t, w, TriangleFeature::edge, k);
}

}  // namespace

bool projectOnPlane(const Corners& t, const Vec3& p, std::array<double, 3>& weights)
{
    const Vec3 e1 = t[1] - t[0], e2 = t[2] - t[0], n = cross(e1, e2);
    const double n2 = dot(n, n);
    if (!(n2 > 1e-24 * dot(e1, e1) * dot(e2, e2))) return false;
    const Vec3 r = p - t[0];
    weights[1] = dot(cross(r, e2), n) / n2;
    weights[2] = dot(cross(e1, r), n) / n2;
    weights[0] = 1 - weights[1] - weights[2];
    return true;
}

TrianglePoint nearestOnTriangle(const Corners& t, const Vec3& p)
{
    std::array<double, 3> w;
    const bool hasArea = projectOnPlane(t, p, w);
    if (hasArea && w[0] > 0 && w[1] > 0 && w[2] > 0) return pointOf(t, w, TriangleFeature::face, 0);
    TrianglePoint best;
    double least = 0;
    for (int k = 0; k < 3; ++k)
    {
        if (hasArea && w[(k + 2) % 3] > 0) continue;  // the point is on the inner side of this edge
        const TrianglePoint candidate = nearestOnEdge(t, k, p);
        const Vec3 r = p - candidate.m_point;
        if (least != 0 && dot(r, r) >= least) continue;
        least = dot(r, r);
        best = candidate;
        if (least == 0) return best;
    }
    return best;
}

bool nearestOfLines(const std::array<Vec3, 4>& ends, double minSine, LineParameters& at)
{
    const Vec3 a = ends[1] - ends[0], b = ends[3] - ends[2], r = ends[2] - ends[0], n = cross(a, b);
    const double n2 = dot(n, n);
    if (!(n2 > minSine * minSine * dot(a, a) * dot(b, b))) return false;
    at.m_a = triple(r, b, n) / n2;
    at.m_b = triple(r, a, n) / n2;
    return true;
}

int timesInOnePlane(const std::array<MovingVector, 3>& vectors, double last, std::array<double, 3>& times)
{
    const Cubic f = tripleProduct(vectors);
    if (hasNoRoot(f, last)) return 0;
    // The cubic is monotone between its extrema.
    std::array<double, 4> ends = {0, last, last, last};
    int intervals = 1;
    const double discriminant = f.c * f.c - 3 * f.b * f.d;
    if (discriminant > 0)
    {
        const double q = -(f.c + std::copysign(std::sqrt(discriminant), f.c));
        std::array<double, 2> extrema = {q / (3 * f.d), f.b / q};
        if (!(extrema[0] < extrema[1])) std::swap(extrema[0], extrema[1]);
        for (double t : extrema)
            if (t > 0 && t < last) ends[intervals++] = t;
        ends[intervals] = last;
    }
    int count = 0;
    for (int k = 0; k < intervals; ++k)
    {
        const double low = f.at(ends[k]), high = f.at(ends[k + 1]);
        if ((low > 0 && high <= 0) || (low < 0 && high >= 0)) times[count++] = rootBetween(f, ends[k], ends[k + 1]);
    }
    return count;
}

}  // namespace bullet_fem
