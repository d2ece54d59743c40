// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/constraints/contact_row.h"

#include <algorithm>
#include <cmath>

namespace bullet_fem
{
namespace
{

constexpr int kEllipseIterations = 20;       // maximum number; some six suffice unless a point is near an axis
constexpr double kEllipseTolerance = 1e-10;  // of the squared distance from the centre relative to the ellipse's

// Point of the ellipse of anisotropic friction that is closest to a tangential impulse outside of it, as the projection
// to a disc: friction dissipates most. The larger semi-axis, `radius`, is along the first tangent. With the semi-axes a
// and b the point is (a^2 x / (a^2 + t), b^2 y / (b^2 + t)); its equation in t is convex, so Newton's iterations
// approach the root from below.
Vec3 onEllipse(const ContactRow& row, const Vec3& tangential, double radius)
{
    const double x = dot(tangential, row.m_axes[1]), y = dot(tangential, row.m_axes[2]);
    const double a = radius, b = row.m_aspect * radius;
    if (!(b > 0)) return std::clamp(x, -a, a) * row.m_axes[1];
    if (std::hypot(x / a, y / b) <= 1) return tangential;
    double t = std::max({0.0, a * std::fabs(x) - a * a, b * std::fabs(y) - b * b});
    for (int k = 0; k < kEllipseIterations; ++k)
    {
        const double p = a * x / (a * a + t), q = b * y / (b * b + t), beyond = p * p + q * q - 1;
        if (!(beyond > kEllipseTolerance)) break;
        t += 0.5 * beyond / (p * p / (a * a + t) + q * q / (b * b + t));
    }
    const double first = a * a * x / (a * a + t), second = b * b * y / (b * b + t);
    const double share = 1 / std::max(1.0, std::hypot(first / a, second / b));
    return share * (first * row.m_axes[1] + second * row.m_axes[2]);
}

Vec3 impulseOfContact(const ContactRow& row, const Vec3& impulse, Vec3 v, double step)
{
    // Normal: n . v + yield lambda >= target.
    const Vec3 n = row.m_axes[0];
    const double old = dot(impulse, n);
    const double missing = row.m_target.x - dot(n, v) - row.m_yield.x * old;
    if (!(old > 0 || missing > 0)) return {};
    const double normal = std::max(0.0, old + step * missing / (row.m_rowCompliance.x + row.m_yield.x));
    if (!(normal > 0)) return {};
    if (step == 1) v += row.m_compliance * ((normal - old) * n);

    // Friction: a step along the sliding velocity, projected to the disc of radius mu lambda_n.
    Vec3 tangential;
    for (int i = 1; i < 3; ++i)
        tangential +=
            (dot(impulse, row.m_axes[i]) + step * (row.m_target[i] - dot(v, row.m_axes[i])) / row.m_rowCompliance[i]) *
            row.m_axes[i];
    const double radius = row.m_friction * normal;
    if (row.m_aspect != 1) return normal * n + onEllipse(row, tangential, radius);
    const double length = norm(tangential);
    if (length > radius) tangential *= length > 0 ? radius / length : 0;
    return normal * n + tangential;
}

Vec3 impulseOfJoint(const ContactRow& row, const Vec3& impulse, Vec3 v, double step)
{
    Vec3 result;
    for (int i = 0; i < 3; ++i)
    {
        const Vec3& axis = row.m_axes[i];
        const double w = row.m_rowCompliance[i], old = dot(impulse, axis), yield = row.m_yield[i];
        double wanted = 0;
        if (w > 0)
        {
            const double missing = row.m_target[i] - dot(axis, v) - yield * old;
            wanted = std::clamp(old + step * missing / (w + yield), row.m_lower[i], row.m_limit[i]);
        }
        result += wanted * axis;
        if (step == 1) v += row.m_compliance * ((wanted - old) * axis);
    }
    const double length = norm(result);
    if (length > row.m_maxImpulse) result *= row.m_maxImpulse / length;
    return result;
}

// Clamps the couple about the normal to spinning friction, and about the tangents to the ellipse of rolling friction;
// m_limit holds the coefficients.
Vec3 impulseOfTorsion(const ContactRow& row, const Vec3& impulse, Vec3 v, double step)
{
    const double load = std::clamp(row.m_load, 0.0, row.m_maxLoad);
    Vec3 wanted;
    double beyond = 0;  // squared utilisation of rolling friction
    for (int i = 0; i < 3; ++i)
    {
        const double w = row.m_rowCompliance[i], old = dot(impulse, row.m_axes[i]), most = row.m_limit[i] * load;
        if (!(w > 0 && most > 0)) continue;
        wanted[i] = old + step * (row.m_target[i] - dot(row.m_axes[i], v)) / w;
        if (i == 0) wanted[i] = std::clamp(wanted[i], -most, most);
        if (step == 1) v += row.m_compliance * ((wanted[i] - old) * row.m_axes[i]);
        if (i > 0) beyond += wanted[i] * wanted[i] / (most * most);
    }
    const double share = beyond > 1 ? 1 / std::sqrt(beyond) : 1;
    return wanted.x * row.m_axes[0] + share * (wanted.y * row.m_axes[1] + wanted.z * row.m_axes[2]);
}

}  // namespace

bool sticks(const ContactRow& row)
{
    constexpr double kSticks = 0.999;  // share of the maximum friction
    const double normal = dot(row.m_impulse, row.m_axes[0]);
    return norm(row.m_impulse - normal * row.m_axes[0]) < kSticks * row.m_friction * normal;
}

Vec3 wantedImpulse(const ContactRow& row, const Vec3& impulse, const Vec3& v, double step)
{
    if (row.m_idle) return impulse;
    if (row.m_torsion) return impulseOfTorsion(row, impulse, v, step);
    return row.m_joint ? impulseOfJoint(row, impulse, v, step) : impulseOfContact(row, impulse, v, step);
}

double speedOf(const ContactRow& row, const Vec3& difference)
{
    const Vec3& w = row.m_rowCompliance;
    if (row.m_torsion) return row.m_lever * std::max({w.x, w.y, w.z}) * norm(difference);
    return (row.m_joint ? std::max({w.x, w.y, w.z}) : w.x) * norm(difference);
}

}  // namespace bullet_fem
