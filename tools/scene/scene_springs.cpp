// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/scene_springs.h"

#include "BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h"
#include "BulletSoftBody/btSoftBody.h"
#include "bullet_fem/btFemVectors.h"

namespace bullet_fem
{
namespace
{

struct NearestPlace
{
    btSoftBody* m_body = nullptr;
    btScalar m_distance = SIMD_INFINITY;  // squared [m2]
    btFemSpring m_spring;                 // nodes and weights of the point
};

// Replaces the nearest point if the body's surface has one nearer to `place`.
void lookNearer(btSoftBody& body, const btVector3& place, NearestPlace& nearestPlace)
{
    for (int f = 0; f < body.m_faces.size(); ++f)
    {
        const btSoftBody::Node* const* corners = body.m_faces[f].m_n;
        btVoronoiSimplexSolver simplex;
        btSubSimplexClosestResult nearest;
        simplex.closestPtPointTriangle(place, corners[0]->m_x, corners[1]->m_x, corners[2]->m_x, nearest);
        const btScalar distance = (nearest.m_closestPointOnSimplex - place).length2();
        if (distance >= nearestPlace.m_distance) continue;
        nearestPlace.m_distance = distance;
        nearestPlace.m_body = &body;
        btFemSpring& spring = nearestPlace.m_spring;
        for (int k = 0; k < 3; ++k)
        {
            spring.m_nodes[k] = static_cast<int>(corners[k] - &body.m_nodes[0]);
            spring.m_weights[k] = nearest.m_barycentricCoords[k];
        }
    }
}

}  // namespace

void SceneSprings::add(const std::vector<btSoftBody*>& bodies, const SceneSpring& from)
{
    NearestPlace nearest;
    for (btSoftBody* body : bodies) lookNearer(*body, bulletVector(from.m_at), nearest);
    btFemSpring& spring = nearest.m_spring;
    spring.m_stiffness = btScalar(from.m_stiffness);
    spring.m_damping = btScalar(from.m_damping);
    spring.m_maxForce = btScalar(from.m_max);
    m_springs.push_back({&from, nearest.m_body, spring, 0, {}});
}

void SceneSprings::apply(btFemSoftBodySolver& fem, double time)
{
    for (Spring& spring : m_springs)
    {
        const SceneSpring& from = *spring.m_from;
        const bool holds = time >= from.m_from && time < from.m_to;
        const Vec3 target = from.m_target.at(time);
        if (holds == (spring.m_handle != 0) && (!holds || norm(target - spring.m_target) == 0)) continue;
        if (!holds)
        {
            fem.removeSpring(spring.m_body, spring.m_handle);
            spring.m_handle = 0;
        }
        else if (spring.m_handle == 0)
        {
            spring.m_spring.m_target = bulletVector(target);
            spring.m_handle = fem.addSpring(spring.m_body, spring.m_spring);
        }
        else
            fem.setSpringTarget(spring.m_body, spring.m_handle, bulletVector(target));
        spring.m_target = target;
        spring.m_body->activate();
    }
}

}  // namespace bullet_fem
