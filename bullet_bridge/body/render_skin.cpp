// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Makes a CollisionSkin from Bullet's render nodes and faces.
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body/collision_skin.h"
#include "fem/common/message.h"

namespace bullet_fem
{
namespace
{

constexpr double kOutside = 0.01;  // largest weight by which a vertex may be outside of its tetrahedron

constexpr const char* kRemedy =
    "; make the body with btFemHelpers::createFromSurface, or tie its surface with Bullet's "
    "interpolateBarycentricWeights, or take BT_FEM_RENDER_SURFACE out of m_cfg.collisions";

SkinVertex vertexOf(const btSoftBody& body, int v)
{
    const auto& parents = body.m_renderNodesParents[v];
    if (parents.size() != 4)
        reject("render node ", v, " follows ", parents.size(), " nodes, not the 4 of a tetrahedron", kRemedy);
    SkinVertex vertex;
    double sum = 0;
    for (int a = 0; a < 4; ++a)
    {
        const std::ptrdiff_t node = parents[a] - &body.m_nodes[0];
        const double weight = double(body.m_renderNodesInterpolationWeights[v][a]);
        if (node < 0 || node >= body.m_nodes.size())
            reject("render node ", v, " follows a node that is none of the body's", kRemedy);
        if (!(weight >= -kOutside && weight <= 1 + kOutside))
            reject("render node ", v, " has the weight ", weight, ", not in [", -kOutside, ", ", 1 + kOutside,
                   "]: it is outside of its tetrahedron", kRemedy);
        vertex.m_nodes[a] = static_cast<int>(node);
        vertex.m_weights[a] = weight;
        sum += weight;
    }
    if (!(std::fabs(sum - 1) <= kOutside))
        reject("the weights of render node ", v, " add up to ", sum, ", not 1", kRemedy);
    return vertex;
}

Triangle triangleOf(const btSoftBody& body, int f)
{
    Triangle triangle;
    for (int a = 0; a < 3; ++a)
    {
        const std::ptrdiff_t vertex = body.m_renderFaces[f].m_n[a] - &body.m_renderNodes[0];
        if (vertex < 0 || vertex >= body.m_renderNodes.size())
            reject("corner ", a, " of render face ", f, " is none of the body's ", body.m_renderNodes.size(),
                   " render nodes", kRemedy);
        triangle[a] = static_cast<int>(vertex);
    }
    return triangle;
}

}  // namespace

std::shared_ptr<const CollisionSkin> skinOf(const btSoftBody& body, const TetMesh& mesh)
{
    const int count = body.m_renderNodes.size();
    if (count == 0 || body.m_renderFaces.size() == 0)
        reject("the render surface is to collide, but it has ", count, " nodes and ", body.m_renderFaces.size(),
               " faces", kRemedy);
    if (body.m_z.size() > 0)
        reject("the render surface is to collide, but its nodes hang over faces at a distance (m_z)", kRemedy);
    if (body.m_renderNodesParents.size() != count || body.m_renderNodesInterpolationWeights.size() != count)
        reject("the render surface is to collide, but of its ", count, " nodes only ", body.m_renderNodesParents.size(),
               " follow the body with ", body.m_renderNodesInterpolationWeights.size(), " weights", kRemedy);
    std::vector<Triangle> triangles;
    std::vector<unsigned char> used(count, 0);
    for (int f = 0; f < body.m_renderFaces.size(); ++f)
    {
        triangles.push_back(triangleOf(body, f));
        for (int corner : triangles.back()) used[corner] = 1;
    }
    std::vector<SkinVertex> vertices(count, SkinVertex{{0, 0, 0, 0}, {1, 0, 0, 0}});
    for (int v = 0; v < count; ++v)
        if (used[v]) vertices[v] = vertexOf(body, v);
    return std::make_shared<const CollisionSkin>(mesh, vertices, std::move(triangles));
}

}  // namespace bullet_fem
