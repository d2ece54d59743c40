// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/btFemRay.h"

#include <algorithm>
#include <cmath>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/btFemVectors.h"

using namespace bullet_fem;

namespace
{

struct Ray
{
    Vec3 m_from, m_way;
    double m_length2;
};

// Signed volumes of the ray with the edges: two triangles with a common edge compute bitwise equal values of opposite
// sign for it, so that no ray passes between them. [Woop, Benthin, Wald 2013]
class RayCaster
{
public:
    RayCaster(const btSoftBody& body, const Ray& ray) : m_body(body), m_ray(ray) {}

    void meet(const btSoftBody::Node* const nodes[3], int face)
    {
        Vec3 corner[3];
        for (int a = 0; a < 3; ++a) corner[a] = vec3(nodes[a]->m_x) - m_ray.m_from;
        double volume[3], sum = 0;
        for (int a = 0; a < 3; ++a)
        {
            const Vec3 &p = corner[(a + 1) % 3], &q = corner[(a + 2) % 3];
            volume[a] = dot(m_ray.m_way, cross(p, q));
            sum += volume[a];
        }
        const bool inside = (volume[0] >= 0 && volume[1] >= 0 && volume[2] >= 0) ||
                            (volume[0] <= 0 && volume[1] <= 0 && volume[2] <= 0);
        if (!inside || sum == 0) return;  // outside, or in the triangle's plane
        double fraction = 0;
        for (int a = 0; a < 3; ++a) fraction += volume[a] / sum * dot(corner[a], m_ray.m_way) / m_ray.m_length2;
        if (!(fraction >= 0 && fraction <= 1) || (m_hits && fraction >= m_fraction)) return;
        m_hits = true;
        m_fraction = fraction;
        m_hit.m_face = face;
        for (int a = 0; a < 3; ++a)
        {
            m_hit.m_nodes[a] = static_cast<int>(nodes[a] - &m_body.m_nodes[0]);
            m_hit.m_weights[a] = static_cast<btScalar>(volume[a] / sum);
            m_corner[a] = corner[a];
        }
    }

    bool hits() const { return m_hits; }

    btFemRayHit hit() const
    {
        btFemRayHit hit = m_hit;
        hit.m_fraction = static_cast<btScalar>(m_fraction);
        hit.m_point = bulletVector(m_ray.m_from + m_fraction * m_ray.m_way);
        Vec3 n = cross(m_corner[1] - m_corner[0], m_corner[2] - m_corner[0]);
        n *= (dot(n, m_ray.m_way) > 0 ? -1 : 1) / norm(n);
        hit.m_normal = bulletVector(n);
        return hit;
    }

private:
    const btSoftBody& m_body;
    const Ray& m_ray;
    bool m_hits = false;
    double m_fraction = 1;
    Vec3 m_corner[3];
    btFemRayHit m_hit;
};

constexpr int kTetSides[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};

}  // namespace

bool btFemRay::test(const btSoftBody* body, const btVector3& from, const btVector3& to, btFemRayHit* hit)
{
    if (!body) return false;
    Ray ray = {vec3(from), vec3(to) - vec3(from), 0};
    ray.m_length2 = dot(ray.m_way, ray.m_way);
    if (!isFinite(ray.m_from) || !std::isfinite(ray.m_length2) || ray.m_length2 == 0) return false;
    RayCaster caster(*body, ray);
    for (int f = 0; f < body->m_faces.size(); ++f) caster.meet(body->m_faces[f].m_n, f);
    for (int e = 0; body->m_faces.size() == 0 && e < body->m_tetras.size(); ++e)
        for (const auto& side : kTetSides)
        {
            const auto& n = body->m_tetras[e].m_n;
            const btSoftBody::Node* const nodes[3] = {n[side[0]], n[side[1]], n[side[2]]};
            caster.meet(nodes, -1);
        }
    if (caster.hits() && hit) *hit = caster.hit();
    return caster.hits();
}

btScalar btFemClosestRay::addSingleResult(btCollisionWorld::LocalRayResult& result, bool normalInWorldSpace)
{
    const btSoftBody* soft = btSoftBody::upcast(result.m_collisionObject);
    btFemRayHit hit;
    if (!soft)
    {
        m_hit = hit;
        return ClosestRayResultCallback::addSingleResult(result, normalInWorldSpace);
    }
    if (!btFemRay::test(soft, m_rayFromWorld, m_rayToWorld, &hit) || hit.m_fraction > m_closestHitFraction)
        return m_closestHitFraction;
    m_hit = hit;
    btCollisionWorld::LocalShapeInfo place = {0, hit.m_face};
    btCollisionWorld::LocalRayResult exact(result.m_collisionObject, &place, hit.m_normal, hit.m_fraction);
    return ClosestRayResultCallback::addSingleResult(exact, true);
}
