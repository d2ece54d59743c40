// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/btFemHelpers.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body/soft_body_mesh.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/fem/baked/baked_body.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "fem/common/attempt.h"

using namespace bullet_fem;

namespace
{

constexpr double kWaterDensity = 1000;  // [kg/m3]

/// The data of a new body.
struct Solid
{
    const TetMesh& m_mesh;
    const std::vector<Vec3>& m_positions;  // node positions [m]
    std::vector<double> m_mass;            // node masses [kg]
    const std::vector<double>& m_filled;
    double m_massScale;
};

std::unique_ptr<btSoftBody> softBodyOf(btSoftBodyWorldInfo& worldInfo, const Solid& solid)
{
    const TetMesh& mesh = solid.m_mesh;
    btAlignedObjectArray<btVector3> positions;
    btAlignedObjectArray<btScalar> masses;
    for (int i = 0; i < mesh.nodeCount(); ++i)
    {
        positions.push_back(bulletVector(solid.m_positions[i]));
        masses.push_back(static_cast<btScalar>(solid.m_mass[i]));
    }
    auto body = std::make_unique<btSoftBody>(&worldInfo, mesh.nodeCount(), &positions[0], &masses[0]);
    makeTets(*body, mesh);
    for (std::size_t e = 0; e < solid.m_filled.size(); ++e)
        storeFill(*body, static_cast<int>(e), solid.m_filled[e], solid.m_massScale);
    body->m_cfg.collisions |= btSoftBody::fCollision::VF_SS;  // expected for solids; Bullet's default has neither
    return body;
}

std::unique_ptr<btSoftBody> softBodyOf(btSoftBodyWorldInfo& worldInfo, const TetMesh& mesh,
                                       const std::vector<double>& filled, double massScale)
{
    return softBodyOf(worldInfo, {mesh, mesh.restPositions(), lumpedMasses(mesh, filled, kWaterDensity * massScale),
                                  filled, massScale});
}

/// An embedded surface.
struct EmbeddedSurface
{
    const std::vector<Tet>& m_tets;
    const std::vector<Embedding>& m_vertices;
    const std::vector<Triangle>& m_triangles;
};

// Sets Bullet's fields for an embedded surface.
void embed(btSoftBody& body, const EmbeddedSurface& surface)
{
    const int vertexCount = static_cast<int>(surface.m_vertices.size());
    body.m_renderNodes.resize(vertexCount);
    body.m_renderNodesParents.resize(vertexCount);
    body.m_renderNodesInterpolationWeights.resize(vertexCount);
    for (int v = 0; v < vertexCount; ++v)
    {
        const Embedding& embedding = surface.m_vertices[v];
        const Tet& tet = surface.m_tets[embedding.m_tet];
        for (int a = 0; a < 4; ++a)
        {
            body.m_renderNodesParents[v].push_back(&body.m_nodes[tet[a]]);
            body.m_renderNodesInterpolationWeights[v][a] = static_cast<btScalar>(embedding.m_weights[a]);
        }
    }
    for (const Triangle& t : surface.m_triangles)
    {
        btSoftBody::RenderFace face;
        for (int a = 0; a < 3; ++a) face.m_n[a] = &body.m_renderNodes[t[a]];
        body.m_renderFaces.push_back(face);
    }
    btFemHelpers::updateEmbeddedSurface(&body);
}

}  // namespace

btSoftBody* btFemHelpers::createFromSurface(btSoftBodyWorldInfo& worldInfo, const SurfaceMesh& surface,
                                            const CageSettings& settings, std::string* why)
{
    CageReport report;
    return createFromSurface(worldInfo, surface, settings, report, why);
}

btSoftBody* btFemHelpers::createFromSurface(btSoftBodyWorldInfo& worldInfo, const SurfaceMesh& surface,
                                            const CageSettings& settings, CageReport& report, std::string* why)
{
    const auto create = [&]
    {
        const Cage cage = makeCage(surface, settings);
        std::unique_ptr<btSoftBody> body = softBodyOf(worldInfo, cage.m_mesh, cage.m_filled, cage.m_massScale);
        embed(*body, {cage.m_mesh.tets(), cage.m_embedding, surface.m_triangles});
        if (cage.m_surfaceCollides) body->m_cfg.collisions |= BT_FEM_RENDER_SURFACE;
        report = cage.m_report;
        return body.release();
    };
    return attemptValue(why, create);
}

btSoftBody* btFemHelpers::createFromTetMesh(btSoftBodyWorldInfo& worldInfo, const TetMesh& mesh, std::string* why)
{
    const auto create = [&]
    {
        if (mesh.tetCount() == 0)
            throw std::invalid_argument("createFromTetMesh: the mesh is empty; build it from elements");
        return softBodyOf(worldInfo, mesh, {}, 1).release();
    };
    return attemptValue(why, create);
}

btSoftBody* btFemHelpers::createFromTetMesh(btSoftBodyWorldInfo& worldInfo, const btVector3* positions, int nodeCount,
                                            const int* tets, int tetCount, std::string* why)
{
    const auto create = [&]
    {
        if (!positions || !tets || nodeCount < 4 || tetCount < 1)
            throw std::invalid_argument("createFromTetMesh: " + std::to_string(nodeCount) + " nodes and " +
                                        std::to_string(tetCount) +
                                        " tets given; at least 4 and 1 are needed, neither null");
        std::vector<Vec3> X(nodeCount);
        for (int i = 0; i < nodeCount; ++i) X[i] = vec3(positions[i]);
        std::vector<Tet> elements(tetCount);
        for (int e = 0; e < tetCount; ++e) std::copy(tets + 4 * e, tets + 4 * e + 4, elements[e].begin());
        return createFromTetMesh(worldInfo, TetMesh(std::move(X), std::move(elements)));
    };
    return attemptValue(why, create);
}

btSoftBody* btFemHelpers::createBox(btSoftBodyWorldInfo& worldInfo, const btVector3& center,
                                    const btVector3& halfExtents, btScalar cellSize, std::string* why)
{
    const auto create = [&]
    {
        const Vec3 size = 2.0 * vec3(halfExtents);
        std::array<int, 3> cells;
        for (int c = 0; c < 3; ++c)
        {
            const double count = std::round(size[c] / double(cellSize));
            if (!(cellSize > 0) || !(size[c] > 0) || !(count <= 1000))
                throw std::invalid_argument("createBox: half extent " + std::to_string(size[c] / 2) +
                                            " m with cells of " + std::to_string(cellSize) +
                                            " m; both must be > 0 and give at most 1000 cells along each axis");
            cells[c] = std::max(1, static_cast<int>(count));
        }
        return createFromTetMesh(worldInfo, makeBox(size, cells, vec3(center) - 0.5 * size));
    };
    return attemptValue(why, create);
}

btSoftBody* btFemHelpers::createFromBaked(btSoftBodyWorldInfo& worldInfo, const BakedBody& baked, std::string* why)
{
    const auto create = [&]
    {
        if (!baked.m_model)
            throw std::invalid_argument("createFromBaked: the baked body is empty; read it with readBakedBody");
        const BodyModel& model = *baked.m_model;
        const std::vector<unsigned char>& fixed = model.factorInput().m_fixed;
        std::unique_ptr<btSoftBody> body = softBodyOf(
            worldInfo,
            {model.mesh(), baked.m_positions, model.factorInput().m_mass, baked.m_filled, baked.m_massScale});
        for (int i = 0; i < body->m_nodes.size(); ++i)
            body->m_nodes[i].m_im = fixed[i] ? btScalar(0) : static_cast<btScalar>(baked.m_inverseMass[i]);
        if (!baked.m_embedding.empty()) embed(*body, {model.mesh().tets(), baked.m_embedding, baked.m_triangles});
        if (baked.m_surfaceCollides) body->m_cfg.collisions |= BT_FEM_RENDER_SURFACE;
        return body.release();
    };
    return attemptValue(why, create);
}
