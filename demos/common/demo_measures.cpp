// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "demos/common/demo_measures.h"

#include <algorithm>

#include "bullet_fem/btFemVectors.h"

namespace bullet_fem
{
namespace
{

/// Sum of mass times a vector over the free nodes.
btVector3 weighted(const btSoftBody& body, btVector3 btSoftBody::Node::*vector)
{
    btVector3 sum(0, 0, 0);
    for (int i = 0; i < body.m_nodes.size(); ++i)
        if (body.m_nodes[i].m_im > 0) sum += body.m_nodes[i].*vector / body.m_nodes[i].m_im;
    return sum;
}

}  // namespace

double massOf(const btSoftBody& body)
{
    double mass = 0;
    for (int i = 0; i < body.m_nodes.size(); ++i)
        if (body.m_nodes[i].m_im > 0) mass += 1 / double(body.m_nodes[i].m_im);
    return mass;
}

btVector3 centreOf(const btSoftBody& body)
{
    return weighted(body, &btSoftBody::Node::m_x) / btScalar(massOf(body));
}

btVector3 velocityOf(const btSoftBody& body)
{
    return weighted(body, &btSoftBody::Node::m_v) / btScalar(massOf(body));
}

btVector3 lowestOf(const btSoftBody& body)
{
    btVector3 low = body.m_nodes[0].m_x;
    for (int i = 1; i < body.m_nodes.size(); ++i) low.setMin(body.m_nodes[i].m_x);
    return low;
}

btVector3 highestOf(const btSoftBody& body)
{
    btVector3 high = body.m_nodes[0].m_x;
    for (int i = 1; i < body.m_nodes.size(); ++i) high.setMax(body.m_nodes[i].m_x);
    return high;
}

std::vector<double> volumesOf(const btSoftBody& body)
{
    std::vector<double> volumes;
    for (int t = 0; t < body.m_tetras.size(); ++t)
    {
        btVector3 edges[3];
        for (int a = 0; a < 3; ++a) edges[a] = body.m_tetras[t].m_n[a + 1]->m_x - body.m_tetras[t].m_n[0]->m_x;
        volumes.push_back(double(edges[0].dot(edges[1].cross(edges[2]))) / 6);
    }
    return volumes;
}

SurfaceMesh lyingDown(SurfaceMesh surface, double length)
{
    Vec3 low = surface.m_vertices[0], high = low;
    for (const Vec3& v : surface.m_vertices)
        for (int c = 0; c < 3; ++c)
        {
            low[c] = std::min(low[c], v[c]);
            high[c] = std::max(high[c], v[c]);
        }
    const Vec3 size = high - low;
    int axes[3] = {0, 1, 2};
    std::sort(axes, axes + 3, [&](int a, int b) { return size[a] > size[b]; });
    std::swap(axes[1], axes[2]);
    const bool mirrors = (axes[1] - axes[0] + 3) % 3 != 1;  // an odd permutation of axes
    const double scale = length / size[axes[0]];
    for (Vec3& v : surface.m_vertices)
    {
        const Vec3 r = scale * (v - 0.5 * (low + high));
        v = {r[axes[0]], r[axes[1]], mirrors ? -r[axes[2]] : r[axes[2]]};
    }
    return surface;
}

bool isIn(const std::vector<Block>& blocks, const Vec3& place)
{
    for (const Block& block : blocks)
    {
        bool inside = true;
        for (int c = 0; c < 3; ++c) inside = inside && place[c] >= block.m_low[c] && place[c] <= block.m_high[c];
        if (inside) return true;
    }
    return false;
}

TetMesh carved(const TetMesh& mesh, const std::vector<Block>& holes)
{
    const std::vector<Vec3>& X = mesh.restPositions();
    std::vector<int> number(X.size(), -1);
    std::vector<Vec3> kept;
    std::vector<Tet> tets;
    for (Tet tet : mesh.tets())
    {
        if (isIn(holes, 0.25 * (X[tet[0]] + X[tet[1]] + X[tet[2]] + X[tet[3]]))) continue;
        for (int& node : tet)
        {
            if (number[node] < 0)
            {
                number[node] = static_cast<int>(kept.size());
                kept.push_back(X[node]);
            }
            node = number[node];
        }
        tets.push_back(tet);
    }
    return TetMesh(kept, tets);
}

std::vector<int> elementsIn(const btSoftBody& body, const Block& block)
{
    std::vector<int> elements;
    for (int e = 0; e < body.m_tetras.size(); ++e)
    {
        btVector3 middle(0, 0, 0);
        for (const btSoftBody::Node* node : body.m_tetras[e].m_n) middle += node->m_x / 4;
        if (isIn({block}, vec3(middle))) elements.push_back(e);
    }
    return elements;
}

}  // namespace bullet_fem
