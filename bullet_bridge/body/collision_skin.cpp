// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/body/collision_skin.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "bullet_fem/fem/cage/surface_repair.h"
#include "bullet_fem/fem/cage/winding_number.h"
#include "fem/common/disjoint_sets.h"
#include "fem/common/message.h"

namespace bullet_fem
{
namespace
{

constexpr double kNoWeight = 1e-6;  // weights below this are rounding errors of zero
constexpr double kThin = 1e-10;     // smallest ratio of twice a triangle's area and its longest edge squared

// Sets rounding errors to zero, so that a vertex on a node depends on that node only, and normalizes the sum to 1.
SkinVertex cleaned(SkinVertex vertex)
{
    double sum = 0;
    for (double& weight : vertex.m_weights)
    {
        if (std::fabs(weight) < kNoWeight) weight = 0;
        sum += weight;
    }
    for (double& weight : vertex.m_weights) weight /= sum;
    return vertex;
}

Vec3 placeOf(const SkinVertex& vertex, const std::vector<Vec3>& x)
{
    Vec3 sum;
    for (int a = 0; a < 4; ++a)
        if (vertex.m_weights[a] != 0) sum += vertex.m_weights[a] * x[vertex.m_nodes[a]];
    return sum;
}

bool hasArea(const std::vector<Vec3>& x, const Triangle& t)
{
    const Vec3 a = x[t[1]] - x[t[0]], b = x[t[2]] - x[t[0]], c = x[t[2]] - x[t[1]];
    const double longest = std::max({dot(a, a), dot(b, b), dot(c, c)});
    return norm(cross(a, b)) > kThin * longest;
}

// A point just behind a triangle: outside of the surface if the triangle faces inward.
Vec3 behind(const std::vector<Vec3>& x, const Triangle& t)
{
    const Vec3 area = cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]]);
    const double away = 1e-3 * std::sqrt(norm(area));
    return (1.0 / 3) * (x[t[0]] + x[t[1]] + x[t[2]]) - (away / norm(area)) * area;
}

double meanEdge(const SurfaceTopology& topology, const std::vector<Vec3>& x)
{
    double sum = 0;
    for (const auto& [a, b] : topology.edges()) sum += norm(x[b] - x[a]);
    return sum / topology.edgeCount();
}

}  // namespace

CollisionSkin::CollisionSkin(const TetMesh& mesh, const std::vector<SkinVertex>& vertices,
                             std::vector<Triangle> triangles)
{
    SurfaceMesh surface;
    surface.m_triangles = std::move(triangles);
    for (const SkinVertex& vertex : vertices)
        surface.m_vertices.push_back(placeOf(cleaned(vertex), mesh.restPositions()));
    const RepairedSurface repaired = repairSurface(surface);
    m_rest.m_positions = std::move(surface.m_vertices);
    for (Triangle t : repaired.m_surface.m_triangles)
    {
        for (int& corner : t) corner = repaired.m_welded[corner];
        if (hasArea(m_rest.m_positions, t)) m_rest.m_triangles.push_back(t);
    }
    if (m_rest.m_triangles.empty())
        reject("none of the ", surface.m_triangles.size(), " faces of the surface that is to collide has an area");
    takeVertices(vertices);
    turnOutward();
    measure(mesh);
}

// Keeps the vertices that triangles use, and renumbers them.
void CollisionSkin::takeVertices(const std::vector<SkinVertex>& vertices)
{
    std::vector<int> number(vertices.size(), -1);
    for (const Triangle& t : m_rest.m_triangles)
        for (int corner : t) number[corner] = 0;
    std::vector<Vec3> positions;
    for (std::size_t v = 0; v < vertices.size(); ++v)
    {
        if (number[v] < 0) continue;
        number[v] = static_cast<int>(m_vertices.size());
        m_vertices.push_back(cleaned(vertices[v]));
        positions.push_back(m_rest.m_positions[v]);
        const SkinVertex& vertex = m_vertices.back();
        for (int a = 0; a < 4; ++a)
            if (vertex.m_weights[a] != 0) m_nodes.push_back(vertex.m_nodes[a]);
        const auto heaviest = std::max_element(vertex.m_weights.begin(), vertex.m_weights.end());
        m_rest.m_nearestNode.push_back(vertex.m_nodes[heaviest - vertex.m_weights.begin()]);
    }
    for (Triangle& t : m_rest.m_triangles)
        for (int& corner : t) corner = number[corner];
    m_rest.m_positions = std::move(positions);
    std::sort(m_nodes.begin(), m_nodes.end());
    m_nodes.erase(std::unique(m_nodes.begin(), m_nodes.end()), m_nodes.end());
}

// Orients connected components. A component of negative volume that is in no other one is inverted; inside of another
// it may be the wall of a cavity.
void CollisionSkin::turnOutward()
{
    const std::vector<Vec3>& x = m_rest.m_positions;
    DisjointSets pieces(x.size());
    for (const Triangle& t : m_rest.m_triangles)
        for (int corner : t) pieces.join(t[0], corner);
    std::vector<double> volume(x.size(), 0);
    std::vector<int> first(x.size(), -1);
    for (std::size_t k = 0; k < m_rest.m_triangles.size(); ++k)
    {
        const Triangle& t = m_rest.m_triangles[k];
        const int piece = pieces.root(t[0]);
        if (first[piece] < 0) first[piece] = static_cast<int>(k);
        volume[piece] += dot(x[t[0]] - x[piece], cross(x[t[1]] - x[piece], x[t[2]] - x[piece]));
    }
    if (std::all_of(volume.begin(), volume.end(), [](double v) { return !(v < 0); })) return;
    const WindingNumber winding(x, m_rest.m_triangles);
    std::vector<unsigned char> turned(x.size(), 0);
    for (std::size_t piece = 0; piece < x.size(); ++piece)
        if (volume[piece] < 0) turned[piece] = std::fabs(winding.at(behind(x, m_rest.m_triangles[first[piece]]))) < 0.5;
    for (Triangle& t : m_rest.m_triangles)
        if (turned[pieces.root(t[0])]) std::swap(t[1], t[2]);
}

// Bands and margins are relative to the tetrahedra's mean edge, scaled down if the skin is finer than the mesh's
// boundary.
void CollisionSkin::measure(const TetMesh& mesh)
{
    const SurfaceTopology own(m_rest.m_triangles, static_cast<int>(m_vertices.size()));
    const SurfaceTopology boundary(mesh.surface(), mesh.nodeCount());
    const double finer = meanEdge(own, m_rest.m_positions) / meanEdge(boundary, mesh.restPositions());
    m_rest.m_meanEdge = mesh.meanEdgeLength() * std::min(1.0, finer);
    m_rest.m_size = std::cbrt(mesh.volume());
}

void CollisionSkin::follow(const std::vector<Vec3>& nodeValues, std::vector<Vec3>& vertexValues) const
{
    vertexValues.resize(m_vertices.size());
    for (std::size_t v = 0; v < m_vertices.size(); ++v)
    {
        const SkinVertex& vertex = m_vertices[v];
        const auto part = [&](int a) { return vertex.m_weights[a] * nodeValues[vertex.m_nodes[a]]; };
        vertexValues[v] = part(0) + part(1) + part(2) + part(3);
    }
}

SurfacePoint CollisionSkin::pointOf(int body, const Triangle& vertices, const std::array<double, 3>& weights) const
{
    SurfacePoint point;
    point.m_body = body;
    point.m_count = 0;
    for (int c = 0; c < 3; ++c)
    {
        if (weights[c] == 0) continue;
        const SkinVertex& vertex = m_vertices[vertices[c]];
        for (int a = 0; a < 4; ++a)
        {
            if (vertex.m_weights[a] == 0) continue;
            const auto end = point.m_nodes.begin() + point.m_count;
            const auto at = std::find(point.m_nodes.begin(), end, vertex.m_nodes[a]);
            const std::ptrdiff_t place = at - point.m_nodes.begin();
            if (at == end)
            {
                point.m_nodes[place] = vertex.m_nodes[a];
                point.m_weights[place] = 0;
                ++point.m_count;
            }
            point.m_weights[place] += weights[c] * vertex.m_weights[a];
        }
    }
    return point;
}

}  // namespace bullet_fem
