// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/scenes/skin_bodies.h"

#include "bullet_fem/btFemHelpers.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "fem/scenes/test_surfaces.h"

namespace bullet_fem
{

SkinBody skinBall(const Vec3& centre)
{
    SkinBody body;
    body.m_surface = sphereSurface(0.5, centre, 3);
    body.m_cell = 0.14;
    return body;
}

SkinBody skinBox(const Vec3& size, const Vec3& centre, double square)
{
    std::array<int, 3> cells;
    for (int c = 0; c < 3; ++c) cells[c] = static_cast<int>(std::round(size[c] / square));
    const TetMesh mesh = makeBox(size, cells, centre - 0.5 * size);
    SkinBody body;
    body.m_surface = {mesh.restPositions(), mesh.surface()};
    return body;
}

btSoftBody* makeSkinBody(SoftWorld& world, btFemSoftBodySolver& fem, const SkinBody& body)
{
    CageSettings settings;
    settings.m_cellSize = body.m_cell;
    settings.m_surfaceCollides = body.m_surfaceCollides;
    btSoftBody* soft = btFemHelpers::createFromSurface(world.info(), body.m_surface, settings);
    btFemMaterial material;
    material.m_youngModulus = body.m_youngModulus;
    material.m_density = 1000;
    fem.setMaterial(soft, material);
    soft->m_cfg.kDF = body.m_friction;
    return soft;
}

btSoftBody& addSkinBody(SoftWorld& world, btFemSoftBodySolver& fem, const SkinBody& body)
{
    return world.addSoft(makeSkinBody(world, fem, body));
}

void drawBoundary(btSoftBody& body)
{
    const int count = body.m_nodes.size();
    body.m_renderNodes.resize(count);
    body.m_renderNodesParents.resize(count);
    body.m_renderNodesInterpolationWeights.resize(count);
    for (int e = 0; e < body.m_tetras.size(); ++e)
        for (int a = 0; a < 4; ++a)
        {
            const int node = static_cast<int>(body.m_tetras[e].m_n[a] - &body.m_nodes[0]);
            body.m_renderNodesParents[node].resize(0);
            for (btSoftBody::Node* corner : body.m_tetras[e].m_n) body.m_renderNodesParents[node].push_back(corner);
            body.m_renderNodesInterpolationWeights[node] = btVector4(a == 0, a == 1, a == 2, a == 3);
        }
    body.m_renderFaces.resize(0);
    for (int f = 0; f < body.m_faces.size(); ++f)
    {
        btSoftBody::RenderFace face;
        for (int a = 0; a < 3; ++a) face.m_n[a] = &body.m_renderNodes[int(body.m_faces[f].m_n[a] - &body.m_nodes[0])];
        body.m_renderFaces.push_back(face);
    }
    btFemHelpers::updateEmbeddedSurface(&body);
}

double lowestVertex(const btSoftBody& body, const Vec3& normal)
{
    double lowest = HUGE_VAL;
    for (int f = 0; f < body.m_renderFaces.size(); ++f)
        for (const btSoftBody::RenderNode* node : body.m_renderFaces[f].m_n)
            lowest = std::min(lowest, dot(normal, vec3(node->m_x)));
    return lowest;
}

}  // namespace bullet_fem
