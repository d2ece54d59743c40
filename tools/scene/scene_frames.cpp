// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/scene_frames.h"

#include "BulletSoftBody/btSoftBody.h"
#include "LinearMath/btTransformUtil.h"
#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemVectors.h"
#include "tools/scene/scene_shapes.h"

namespace bullet_fem
{
namespace
{

template <class Entry, class First>
int indexIn(const Entry* entry, const First& first)
{
    return static_cast<int>(entry - &first);
}

std::vector<Vec3> positionsOf(const btSoftBody& body)
{
    std::vector<Vec3> positions(body.m_nodes.size());
    for (int i = 0; i < body.m_nodes.size(); ++i) positions[i] = vec3(body.m_nodes[i].m_x);
    return positions;
}

std::vector<Tet> tetsOf(const btSoftBody& body)
{
    std::vector<Tet> tets(body.m_tetras.size());
    for (int e = 0; e < body.m_tetras.size(); ++e)
        for (int a = 0; a < 4; ++a) tets[e][a] = indexIn(body.m_tetras[e].m_n[a], body.m_nodes[0]);
    return tets;
}

bool isEmbedded(const btSoftBody& body)
{
    return body.m_renderFaces.size() > 0 && body.m_renderNodesParents.size() == body.m_renderNodes.size();
}

std::vector<Triangle> surfaceOf(const btSoftBody& body)
{
    std::vector<Triangle> triangles(isEmbedded(body) ? body.m_renderFaces.size() : body.m_faces.size());
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (int a = 0; a < 3; ++a)
            triangles[t][a] = isEmbedded(body) ? indexIn(body.m_renderFaces[int(t)].m_n[a], body.m_renderNodes[0])
                                               : indexIn(body.m_faces[int(t)].m_n[a], body.m_nodes[0]);
    return triangles;
}

// Omits inner nodes and unused vertices, whose stress is not visible.
SurfacePart drawnPart(const btSoftBody& body, int id)
{
    BodyFrame whole;
    whole.m_id = id;
    whole.m_positions.resize(isEmbedded(body) ? body.m_renderNodes.size() : body.m_nodes.size());
    whole.m_triangles = surfaceOf(body);
    return SurfacePart("SceneFrames", whole);
}

Stress stressOf(const btFemStress& s)
{
    return {s.m_xx, s.m_yy, s.m_zz, s.m_xy, s.m_yz, s.m_xz};
}

void take(const btAlignedObjectArray<btFemStress>& from, std::vector<Stress>& to)
{
    to.resize(from.size());
    for (int i = 0; i < from.size(); ++i) to[i] = stressOf(from[i]);
}

void take(const btAlignedObjectArray<btScalar>& from, std::vector<double>& to)
{
    to.resize(from.size());
    for (int i = 0; i < from.size(); ++i) to[i] = double(from[i]);
}

}  // namespace

SceneFrames::SceneFrames(const SceneWorld& world) : m_world(world)
{
    for (int i = 0; i < world.softCount(); ++i)
    {
        const btSoftBody& body = world.soft(i);
        m_rest.push_back(positionsOf(body));
        m_volumes.emplace_back();
        m_volumes.back().m_id = i;
        m_volumes.back().m_tetRegion = world.regionLabels(i);
        m_surfaces.emplace_back();
        m_surfaces.back().m_id = i;
        m_drawn.push_back(drawnPart(body, i));
        const SceneSplits* splits = world.fractures().find(body);
        m_splits.push_back(splits ? splits->m_count : 0);
        takeElements(i);
    }
    for (int i = 0; i < world.rigidCount(); ++i)
    {
        SurfaceMesh drawn = drawnShape(world.description().m_rigidBodies[i].m_shape);
        if (drawn.m_triangles.empty()) continue;
        m_rigidRest.push_back(std::move(drawn.m_vertices));
        m_surfaces.emplace_back();
        m_surfaces.back().m_id = world.softCount() + i;
        m_surfaces.back().m_triangles = std::move(drawn.m_triangles);
        m_surfaces.back().m_nodeStress.resize(m_rigidRest.back().size());  // zero: films with colours need it
    }
    update();
}

void SceneFrames::takeElements(int i)
{
    m_volumes[i].m_tets = tetsOf(m_world.soft(i));
    m_surfaces[i].m_triangles = m_drawn[i].m_triangles;
}

// Copies of nodes have the rest position of the original, and the crack adds faces to the surface.
void SceneFrames::followSplits(int i)
{
    const btSoftBody& body = m_world.soft(i);
    const SceneSplits* splits = m_world.fractures().find(body);
    if (!splits || splits->m_count == m_splits[i]) return;
    m_splits[i] = splits->m_count;
    m_drawn[i] = drawnPart(body, i);
    takeElements(i);
    for (int n = static_cast<int>(m_rest[i].size()); n < body.m_nodes.size(); ++n)
        m_rest[i].push_back(m_rest[i][splits->m_copyOf[n - splits->m_nodes]]);
}

void SceneFrames::update(double fraction)
{
    for (int i = 0; i < m_world.softCount(); ++i)
    {
        followSplits(i);
        updateVolume(i, fraction);
        updateSoftSurface(i);
    }
    for (int s = m_world.softCount(); s < static_cast<int>(m_surfaces.size()); ++s) updateRigidSurface(s, fraction);
}

void SceneFrames::updateVolume(int i, double fraction)
{
    const btSoftBody& body = m_world.soft(i);
    BodyFrame& frame = m_volumes[i];
    const int count = body.m_nodes.size();
    btFemHelpers::interpolateNodes(&body, btScalar(fraction), m_places);
    frame.m_positions.resize(count);
    frame.m_displacement.resize(count);
    frame.m_velocity.resize(count);
    frame.m_contactForce.assign(count, Vec3{});
    for (int n = 0; n < count; ++n)
    {
        frame.m_positions[n] = vec3(m_places[n]);
        frame.m_displacement[n] = frame.m_positions[n] - m_rest[i][n];
        frame.m_velocity[n] = vec3(body.m_nodes[n].m_v);
    }
    if (m_world.fem().getContactForces(&body, m_forces))
        for (int n = 0; n < count; ++n) frame.m_contactForce[n] = vec3(m_forces[n]);
    updateReactions(body, frame);
    if (m_world.fem().getStress(&body, m_stress)) take(m_stress, frame.m_tetStress);
    if (m_world.fem().getNodeStress(&body, m_stress)) take(m_stress, frame.m_nodeStress);
    m_world.fem().getPlasticStrain(&body, m_perElement);
    take(m_perElement, frame.m_tetPlasticStrain);
    m_world.fem().getActivation(&body, m_perElement);
    take(m_perElement, frame.m_tetActivation);
}

// Only bodies that are held have reactions.
void SceneFrames::updateReactions(const btSoftBody& body, BodyFrame& frame)
{
    frame.m_reactionForce.clear();
    if (m_world.fem().reaction(&body, {0, 0, 0}).m_count == 0) return;
    m_world.fem().getReactionForces(&body, m_forces);
    for (int n = 0; n < m_forces.size(); ++n) frame.m_reactionForce.push_back(vec3(m_forces[n]));
}

void SceneFrames::updateSoftSurface(int i)
{
    const btSoftBody& body = m_world.soft(i);
    const BodyFrame& volume = m_volumes[i];
    BodyFrame& frame = m_surfaces[i];
    const std::vector<int>& drawn = m_drawn[i].m_node;
    frame.m_positions.assign(drawn.size(), Vec3{});
    frame.m_nodeStress.assign(volume.m_nodeStress.empty() ? 0 : drawn.size(), Stress{});
    const auto add = [&](std::size_t v, int node, double weight)
    {
        frame.m_positions[v] += weight * volume.m_positions[node];
        if (frame.m_nodeStress.empty()) return;
        Stress part = volume.m_nodeStress[node];
        frame.m_nodeStress[v] += part *= weight;
    };
    for (std::size_t v = 0; v < drawn.size(); ++v)
    {
        if (!isEmbedded(body))
        {
            add(v, drawn[v], 1);
            continue;
        }
        // Bullet updates rendered vertices only in its steps, so they are not valid before the first one.
        const auto& parents = body.m_renderNodesParents[drawn[v]];
        for (int a = 0; a < parents.size(); ++a)
            add(v, indexIn(parents[a], body.m_nodes[0]), double(body.m_renderNodesInterpolationWeights[drawn[v]][a]));
    }
}

// Extrapolates as Bullet does for motion states, which these bodies lack.
void SceneFrames::updateRigidSurface(int surface, double fraction)
{
    const btRigidBody& body = m_world.rigid(bodyOf(surface) - m_world.softCount());
    btTransform pose = body.getWorldTransform();
    if (fraction != 0 && body.isActive())
        btTransformUtil::integrateTransform(body.getWorldTransform(), body.getLinearVelocity(),
                                            body.getAngularVelocity(),
                                            btScalar(fraction * m_world.description().m_step), pose);
    const std::vector<Vec3>& rest = m_rigidRest[surface - m_world.softCount()];
    BodyFrame& frame = m_surfaces[surface];
    frame.m_positions.resize(rest.size());
    for (std::size_t v = 0; v < rest.size(); ++v) frame.m_positions[v] = vec3(pose * bulletVector(rest[v]));
}

}  // namespace bullet_fem
