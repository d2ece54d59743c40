// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/contact/contact_row.h"

#include <algorithm>

namespace bullet_fem
{
namespace
{

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
    const double radius = row.m_friction * normal, length = norm(tangential);
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
            wanted = std::clamp(old + step * missing / (w + yield), -row.m_limit[i], row.m_limit[i]);
        }
        result += wanted * axis;
        if (step == 1) v += row.m_compliance * ((wanted - old) * axis);
    }
    const double length = norm(result);
    if (length > row.m_most) result *= row.m_most / length;
    return result;
}

}  // namespace

Vec3 wantedImpulse(const ContactRow& row, const Vec3& impulse, const Vec3& v, double step)
{
    if (row.m_idle) return impulse;
    return row.m_joint ? impulseOfJoint(row, impulse, v, step) : impulseOfContact(row, impulse, v, step);
}

double speedOf(const ContactRow& row, const Vec3& difference)
{
    const Vec3& w = row.m_rowCompliance;
    return (row.m_joint ? std::max({w.x, w.y, w.z}) : w.x) * norm(difference);
}

}  // namespace bullet_fem
