// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/contact/contact_measures.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "bullet_fem/btFemVectors.h"

namespace bullet_fem
{
namespace
{

constexpr int kLattice = 4;  // intervals along a triangle's edge

using Corners = std::array<Vec3, 3>;

Corners cornersOf(const btSoftBody::Face& face)
{
    return {vec3(face.m_n[0]->m_x), vec3(face.m_n[1]->m_x), vec3(face.m_n[2]->m_x)};
}

double upwardArea(const Corners& t)
{
    return 0.5 * cross(t[1] - t[0], t[2] - t[0]).z;
}

/// Calls visit(point) for each lattice point of the triangle.
template <class Visit>
void forSamples(const Corners& t, Visit visit)
{
    for (int i = 0; i <= kLattice; ++i)
        for (int j = 0; i + j <= kLattice; ++j)
            visit(t[0] + (double(i) / kLattice) * (t[1] - t[0]) + (double(j) / kLattice) * (t[2] - t[0]));
}

/// Maximum that keeps NaN.
void keepLarger(double value, double& largest)
{
    if (!(value <= largest) && !std::isnan(largest)) largest = value;
}

/// Signed distance of a point to a box with half extents e, negative inside [m].
double boxDistance(const Vec3& p, const Vec3& e)
{
    const Vec3 q = {std::abs(p.x) - e.x, std::abs(p.y) - e.y, std::abs(p.z) - e.z};
    const Vec3 outside = {std::max(q.x, 0.0), std::max(q.y, 0.0), std::max(q.z, 0.0)};
    return norm(outside) + std::min(std::max({q.x, q.y, q.z}), 0.0);
}

double depthInBox(const btSoftBody& soft, const btRigidBody& rigid, double distance)
{
    const Vec3 halfExtents =
        vec3(static_cast<const btBoxShape*>(rigid.getCollisionShape())->getHalfExtentsWithMargin());
    const btMatrix3x3& R = rigid.getWorldTransform().getBasis();
    const std::array<Vec3, 3> axes = {vec3(R.getColumn(0)), vec3(R.getColumn(1)), vec3(R.getColumn(2))};
    const Vec3 center = vec3(rigid.getWorldTransform().getOrigin());
    double deepest = 0;
    for (int f = 0; f < soft.m_faces.size(); ++f)
        forSamples(cornersOf(soft.m_faces[f]),
                   [&](const Vec3& point)
                   {
                       const Vec3 r = point - center;
                       const Vec3 local = {dot(axes[0], r), dot(axes[1], r), dot(axes[2], r)};
                       keepLarger(distance - boxDistance(local, halfExtents), deepest);
                   });
    return deepest;
}

/// Height of the triangle's plane at (p.x, p.y); minus infinity if p is not above or below the triangle.
double heightUnder(const Corners& t, const Vec3& p)
{
    const double area = upwardArea(t);
    const Corners with0 = {p, t[1], t[2]}, with1 = {t[0], p, t[2]}, with2 = {t[0], t[1], p};
    const double w0 = upwardArea(with0) / area, w1 = upwardArea(with1) / area, w2 = upwardArea(with2) / area;
    return std::min({w0, w1, w2}) < 0 ? -HUGE_VAL : w0 * t[0].z + w1 * t[1].z + w2 * t[2].z;
}

/// Faces that point up (sign 1) or down (-1); steep faces are left out.
std::vector<Corners> facesLooking(const btSoftBody& body, double sign)
{
    std::vector<Corners> faces;
    for (int f = 0; f < body.m_faces.size(); ++f)
    {
        const Corners t = cornersOf(body.m_faces[f]);
        if (sign * upwardArea(t) > 0.25 * norm(cross(t[1] - t[0], t[2] - t[0]))) faces.push_back(t);
    }
    return faces;
}

/// Depth of `upper` in `lower` [m]. Depths beyond half of the lower body's height are ignored: they belong to its
/// opposite side.
double depthInSoft(const btSoftBody& upper, const btSoftBody& lower, double distance)
{
    const std::vector<Corners> undersides = facesLooking(upper, -1), tops = facesLooking(lower, 1);
    btVector3 low, high;
    lower.getAabb(low, high);
    const double thickness = 0.5 * double(high.z() - low.z());
    double deepest = 0;
    for (const Corners& under : undersides)
        forSamples(under,
                   [&](const Vec3& p)
                   {
                       for (const Corners& top : tops)
                       {
                           // skip the many triangles far from p
                           if (std::abs(p.x - top[0].x) + std::abs(p.y - top[0].y) > 4 * std::sqrt(upwardArea(top)))
                               continue;
                           const double depth = heightUnder(top, p) + distance - p.z;
                           if (depth < thickness) keepLarger(depth, deepest);
                       }
                   });
    return deepest;
}

bool isFinite(const btSoftBody& body)
{
    for (int i = 0; i < body.m_nodes.size(); ++i)
        if (!bullet_fem::isFinite(vec3(body.m_nodes[i].m_x))) return false;
    return true;
}

void add(Momentum& sum, const Vec3& center, const Vec3& linear, const Vec3& spin)
{
    sum.m_linear += linear;
    sum.m_angular += cross(center, linear) + spin;
}

}  // namespace

double deepestPenetration(const ContactWorld& world, double distance)
{
    double deepest = 0;
    for (const auto& soft : world.softBodies())
    {
        if (!isFinite(*soft)) return NAN;
        for (const auto& rigid : world.rigidBodies()) keepLarger(depthInBox(*soft, *rigid, distance), deepest);
        for (const auto& other : world.softBodies())
            if (other != soft) keepLarger(depthInSoft(*soft, *other, distance), deepest);
    }
    return deepest;
}

Momentum momentumOf(const ContactWorld& world)
{
    Momentum sum;
    for (const auto& soft : world.softBodies())
    {
        Vec3 linear;
        for (int i = 0; i < soft->m_nodes.size(); ++i)
        {
            const btSoftBody::Node& node = soft->m_nodes[i];
            if (node.m_im <= 0) continue;
            const Vec3 p = (1 / double(node.m_im)) * vec3(node.m_v);
            linear += p;
            add(sum, vec3(node.m_x), p, {});
        }
        sum.m_scale += norm(linear);
    }
    for (const auto& rigid : world.rigidBodies())
    {
        if (rigid->getInvMass() <= 0) continue;
        const btMatrix3x3& R = rigid->getWorldTransform().getBasis();
        const btVector3 spin = R * ((R.transpose() * rigid->getAngularVelocity()) / rigid->getInvInertiaDiagLocal());
        const Vec3 p = (1 / double(rigid->getInvMass())) * vec3(rigid->getLinearVelocity());
        add(sum, vec3(rigid->getCenterOfMassPosition()), p, vec3(spin));
        sum.m_scale += norm(p);
    }
    return sum;
}

std::vector<Vec3> centersOf(const ContactWorld& world)
{
    std::vector<Vec3> centers;
    for (const auto& soft : world.softBodies())
    {
        Vec3 sum;
        double mass = 0;
        for (int i = 0; i < soft->m_nodes.size(); ++i)
        {
            const btSoftBody::Node& node = soft->m_nodes[i];
            if (node.m_im <= 0) continue;
            sum += (1 / double(node.m_im)) * vec3(node.m_x);
            mass += 1 / double(node.m_im);
        }
        centers.push_back((1 / mass) * sum);
    }
    for (const auto& rigid : world.rigidBodies()) centers.push_back(vec3(rigid->getCenterOfMassPosition()));
    return centers;
}

}  // namespace bullet_fem
