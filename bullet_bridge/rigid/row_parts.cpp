// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/rigid/row_parts.h"

#include <utility>

namespace bullet_fem
{
namespace
{

constexpr double kBulletUnlimited = 1e30;  // Bullet writes no limit as FLT_MAX or DBL_MAX [N s]
constexpr double kIsotropic = 1e-4;        // deviation of directions of friction from unit vectors that is rounding [-]

double limitOf(double bullet)
{
    return std::fabs(bullet) >= kBulletUnlimited ? std::copysign(Joint::kUnlimited, bullet) : bullet;
}

}  // namespace

RigidContact contactOf(const RowSide& first, const RowSide& second, const Vec3& at, const Vec3& atSecond,
                       const Vec3& normal, double beyond)
{
    RigidContact contact;
    contact.m_rigidProxy = first.m_proxy;
    contact.m_other = second.m_proxy;
    contact.m_normal = normal;
    contact.m_arm = at - first.m_center;
    contact.m_otherArm = atSecond - second.m_center;
    const Vec3 ofSecond = second.velocityAt(contact.m_otherArm);
    contact.m_leastSpeed = beyond + dot(normal, first.velocityAt(contact.m_arm) - ofSecond);
    if (second.m_proxy < 0) contact.m_otherVelocity = ofSecond;
    contact.m_isSupport = second.m_proxy < 0 && dot(ofSecond, ofSecond) == 0;
    return contact;
}

void FrictionPlane::split(const Vec3& v, double& first, double& second) const
{
    const Vec3 &d = m_first, &e = m_second;
    const double a = dot(d, d), b = dot(d, e), c = dot(e, e), det = a * c - b * b;
    const bool isPlane = det > kIsotropic * a * c;
    first = isPlane ? (c * dot(v, d) - b * dot(v, e)) / det : a > 0 ? dot(v, d) / a : 0;
    second = isPlane ? (a * dot(v, e) - b * dot(v, d)) / det : !(a > 0) && c > 0 ? dot(v, e) / c : 0;
}

Vec3 FrictionPlane::withProducts(double first, double second) const
{
    const Vec3 &d = m_first, &e = m_second;
    const double a = dot(d, d), b = dot(d, e), c = dot(e, e), det = a * c - b * b;
    if (!(det > kIsotropic * a * c)) return {};
    return ((c * first - b * second) / det) * d + ((a * second - b * first) / det) * e;
}

// The axes of the ellipse are the eigenvectors of d d^T + e e^T.
void FrictionPlane::setCone(double coefficient, RigidContact& contact) const
{
    const Vec3 &d = m_first, &e = m_second;
    contact.m_friction = coefficient;
    const double a = dot(d, d), b = dot(d, e), c = dot(e, e);
    if (std::fabs(a - 1) < kIsotropic && std::fabs(c - 1) < kIsotropic && std::fabs(b) < kIsotropic) return;
    // Larger eigenvalue of the Gram matrix; its eigenvector combines d and e to the larger semi-axis.
    const double half = 0.5 * (a - c), most = 0.5 * (a + c) + std::hypot(half, b);
    const double least = std::max(0.0, a + c - most);
    const Vec3 axis = half >= 0 ? (most - c) * d + b * e : b * d + (most - a) * e;
    if (!(norm(axis) > 0))
    {
        contact.m_friction *= most > 0 ? std::sqrt(most) : 0;
        return;
    }
    contact.m_friction *= std::sqrt(most);
    contact.m_aspect = std::sqrt(least / most);
    contact.m_slipAxis = (1 / norm(axis)) * axis;
}

bool RollingFriction::set(const RigidContact& contact, TorsionalFriction& torsion) const
{
    const Vec3& normal = contact.m_normal;
    torsion.m_body = -1;
    torsion.m_firstRigidProxy = contact.m_rigidProxy;
    torsion.m_rigidProxy = contact.m_other;
    torsion.m_maxLoad = m_maxLoad;
    torsion.m_lever = m_lever;
    torsion.m_axes[0] = normal;
    torsion.m_friction.x = m_spinning;
    Vec3 tangent = cross(std::fabs(normal.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}, normal);
    if (m_count > 0) tangent = m_axes[0] - dot(m_axes[0], normal) * normal;
    for (int k = 0; k < m_count; ++k) torsion.m_friction[k + 1] = norm(m_axes[k]) * m_rolling[k];
    if (!(norm(tangent) > 0)) return false;
    torsion.m_axes[1] = (1 / norm(tangent)) * tangent;
    torsion.m_axes[2] = cross(torsion.m_axes[0], torsion.m_axes[1]);
    return true;
}

RowLimits::RowLimits(double lower, double upper) : m_lower(limitOf(lower)), m_upper(limitOf(upper)), m_sign(1)
{
    if (!(-m_lower > m_upper)) return;
    std::swap(m_lower, m_upper);
    m_lower = -m_lower;
    m_upper = -m_upper;
    m_sign = -1;
}

}  // namespace bullet_fem
