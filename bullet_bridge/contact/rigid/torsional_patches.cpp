// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/contact/rigid/torsional_patches.h"

#include <algorithm>
#include <cmath>

#include "bullet_bridge/contact/friction.h"
#include "bullet_fem/bullet_bridge/vectors.h"

namespace bullet_fem
{
namespace
{

constexpr double kSameFace = 0.5;     // smallest cosine of the angle between normals of one patch
constexpr double kTouches = 0.01;     // maximum gap of a contact point without an impulse, over the mean edge
constexpr double kMinInertia = 1e-9;  // regularization of the inertia over its trace, so that collinear nodes have a
                                      // spin

double coefficient(double ofObject, double ofBody, const FemSoftBody& fem, const btCollisionObject& object)
{
    const double sum = double(fem.m_softBody->m_cfg.kDF) * ofObject + ofBody * double(object.getFriction());
    return sum > 0 ? std::min(sum, kLargestFriction) : 0;
}

bool touches(const ContactPoint& contact, const FemSoftBody& fem)
{
    return contact.m_gap < kTouches * fem.m_surface.meanEdge() || dot(contact.m_impulse, contact.m_normal) > 0;
}

// Scales of rolling friction along two tangents. If the object has anisotropic rolling friction, the tangents become
// the principal axes of its projection on the tangent plane.
Vec3 turnToPrincipal(const btCollisionObject& object, std::array<Vec3, 3>& axes)
{
    if (!object.hasAnisotropicFriction(btCollisionObject::CF_ANISOTROPIC_ROLLING_FRICTION)) return {1, 1, 1};
    const btMatrix3x3& basis = object.getWorldTransform().getBasis();
    const auto product = [&](const Vec3& a, const Vec3& b)
    {
        double sum = 0;
        for (int i = 0; i < 3; ++i)
        {
            const Vec3 own = vec3(basis.getColumn(i));
            sum += std::fabs(double(object.getAnisotropicFriction()[i])) * dot(a, own) * dot(b, own);
        }
        return sum;
    };
    const Vec3 t = axes[1], u = axes[2];
    const double angle = 0.5 * std::atan2(2 * product(t, u), product(t, t) - product(u, u));
    axes[1] = std::cos(angle) * t + std::sin(angle) * u;
    axes[2] = std::cos(angle) * u - std::sin(angle) * t;
    constexpr double kNone = 1e-3;  // as in Bullet
    const auto scale = [&](const Vec3& axis) { return product(axis, axis) > kNone ? product(axis, axis) : 0; };
    return {1, scale(axes[1]), scale(axes[2])};
}

}  // namespace

void TorsionalPatches::append(const std::vector<FemSoftBody*>& bodies, ContactProblem& problem)
{
    std::size_t offset = 0;
    for (std::size_t b = 0; b < bodies.size(); ++b)
    {
        const FemSoftBody& fem = *bodies[b];
        const std::size_t count = fem.m_memory.m_contacts.size();
        for (std::size_t begin = 0, end = 0; begin < count; begin = end)
        {
            const btCollisionObject* object = fem.m_memory.m_origins[begin].m_object;
            while (end < count && fem.m_memory.m_origins[end].m_object == object) ++end;
            const btSoftBody& soft = *fem.m_softBody;
            const double rolling = coefficient(object->getRollingFriction(), soft.getRollingFriction(), fem, *object);
            const double spinning =
                coefficient(object->getSpinningFriction(), soft.getSpinningFriction(), fem, *object);
            if (rolling > 0 || spinning > 0)
                appendPair(static_cast<int>(b), {fem, *object, begin, end, offset, rolling, spinning}, problem);
        }
        offset += count;
    }
}

void TorsionalPatches::appendPair(int body, const Pair& pair, ContactProblem& problem)
{
    gather(pair, problem);
    for (std::size_t p = 0; p < m_patches.size(); ++p)
        if (m_patches[p].m_touches) appendPatch(body, pair, static_cast<int>(p), problem);
    if (problem.m_torsions.empty()) return;
    problem.m_torsionOf.resize(problem.m_contacts.size(), -1);
    for (std::size_t k = pair.m_begin; k < pair.m_end; ++k)
        problem.m_torsionOf[pair.m_offset + k] = m_patches[m_patchOf[k - pair.m_begin]].m_torsion;
}

void TorsionalPatches::gather(const Pair& pair, const ContactProblem& problem)
{
    m_patches.clear();
    m_patchOf.clear();
    for (std::size_t k = pair.m_begin; k < pair.m_end; ++k)
    {
        const ContactPoint& contact = problem.m_contacts[pair.m_offset + k];
        const auto faces = [&](const Patch& patch) { return dot(patch.m_first, contact.m_normal) > kSameFace; };
        auto patch = std::find_if(m_patches.begin(), m_patches.end(), faces);
        if (patch == m_patches.end())
        {
            m_patches.push_back({contact.m_normal, {}, {}, false, -1});
            patch = m_patches.end() - 1;
        }
        m_patchOf.push_back(static_cast<int>(patch - m_patches.begin()));
        if (!touches(contact, pair.m_fem)) continue;
        patch->m_touches = true;
        patch->m_touchingNormal += contact.m_normal;
        patch->m_normal += std::max(dot(contact.m_impulse, contact.m_normal), 0.0) * contact.m_normal;
    }
}

// The spin of the patch is that of its nodes x_j about their centre, w = I^-1 sum d_j x v_j, exact for rigid rotation.
void TorsionalPatches::appendPatch(int body, const Pair& pair, int patch, ContactProblem& problem)
{
    collectNodes(pair, patch, problem);
    const std::vector<Vec3>& x = pair.m_fem.m_body.m_state.m_x;
    Vec3 center;
    for (int node : m_nodes) center += (1.0 / static_cast<double>(m_nodes.size())) * x[node];
    Mat3 inertia;
    for (int node : m_nodes)
    {
        const Vec3 d = x[node] - center;
        inertia += Mat3::diagonal(dot(d, d)) - outer(d, d);
    }
    if (!(trace(inertia) > 0)) return;
    const Mat3 inverseInertia = inverse(inertia + Mat3::diagonal(kMinInertia * trace(inertia)));
    TorsionalFriction torsion;
    torsion.m_body = body;
    torsion.m_first = static_cast<int>(problem.m_handleNodes.size());
    torsion.m_count = static_cast<int>(m_nodes.size());
    for (int node : m_nodes)
    {
        problem.m_handleNodes.push_back(node);
        problem.m_handleBlocks.push_back(inverseInertia * crossMatrix(x[node] - center));
    }
    const Patch& found = m_patches[patch];
    torsion.m_rigidProxy = problem.m_contacts[pair.m_offset + pair.m_begin].m_rigidProxy;
    Vec3& n = torsion.m_axes[0];
    n = unit(dot(found.m_normal, found.m_normal) > 0 ? found.m_normal : found.m_touchingNormal);
    torsion.m_axes[1] = unit(cross(std::fabs(n.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}, n));
    torsion.m_axes[2] = cross(n, torsion.m_axes[1]);
    const Vec3 scales = turnToPrincipal(pair.m_object, torsion.m_axes);
    torsion.m_friction = {pair.m_spinning, pair.m_rolling * scales.y, pair.m_rolling * scales.z};
    torsion.m_lever = pair.m_fem.m_surface.meanEdge();
    m_patches[patch].m_torsion = static_cast<int>(problem.m_torsions.size());
    problem.m_torsions.push_back(torsion);
}

void TorsionalPatches::collectNodes(const Pair& pair, int patch, const ContactProblem& problem)
{
    m_nodes.clear();
    for (std::size_t k = pair.m_begin; k < pair.m_end; ++k)
    {
        const ContactPoint& contact = problem.m_contacts[pair.m_offset + k];
        if (m_patchOf[k - pair.m_begin] == patch && touches(contact, pair.m_fem)) addNodes(pair.m_fem, contact.m_soft);
    }
    std::sort(m_nodes.begin(), m_nodes.end());
    m_nodes.erase(std::unique(m_nodes.begin(), m_nodes.end()), m_nodes.end());
}

// Adds the nodes that carry a point. A single node has no spin, so the triangles around it are added; a skin's points
// are embedded in tetrahedra, whose nodes suffice.
void TorsionalPatches::addNodes(const FemSoftBody& fem, const SurfacePoint& point)
{
    const SurfaceTopology& topology = fem.m_surface.topology();
    for (int a = 0; a < point.m_count; ++a)
    {
        const int node = point.m_nodes[a];
        if (point.m_weights[a] == 0) continue;
        if (fem.m_skin)
            m_nodes.push_back(node);
        else
            for (int t : topology.trianglesAt(node))
                for (int corner : topology.triangles()[t]) m_nodes.push_back(corner);
    }
}

}  // namespace bullet_fem
