// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/mesh/tet_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "fem/common/disjoint_sets.h"
#include "fem/common/message.h"
#include "fem/mesh/element_faces.h"

namespace bullet_fem
{
namespace
{

// Volume over longest edge cubed; smaller elements have meaningless shape gradients.
constexpr double kMinQuality = 1e-9;
constexpr double kSliverQuality = 1e-3;  // in this measure a regular tetrahedron has .118; slivers cost iterations

/// The face opposite each node of a positively oriented element, counter-clockwise seen from outside.
constexpr int kFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

std::string nodesOf(const Tet& tet)
{
    return message("(nodes ", tet[0], ", ", tet[1], ", ", tet[2], ", ", tet[3], ")");
}

void checkPositions(const std::vector<Vec3>& X)
{
    for (std::size_t i = 0; i < X.size(); ++i)
        if (!isFinite(X[i]))
            reject("node ", i, " has the rest position (", X[i].x, ", ", X[i].y, ", ", X[i].z,
                   "), which is not finite; give every node a finite position [m]");
}

void checkIndices(const std::vector<Tet>& tets, int nodeCount)
{
    for (std::size_t e = 0; e < tets.size(); ++e)
        for (int a = 0; a < 4; ++a)
        {
            const int i = tets[e][a];
            if (i < 0 || i >= nodeCount)
                reject("element ", e, " uses node ", i, ", outside [0, ", nodeCount - 1,
                       "]; count nodes from 0 and give a position for each");
            if (std::find(tets[e].begin(), tets[e].begin() + a, i) != tets[e].begin() + a)
                reject("element ", e, " ", nodesOf(tets[e]), " has node ", i,
                       " twice; an element needs four different nodes");
        }
}

/// Flags of nodes, 1 if they belong to no element.
std::vector<unsigned char> looseNodes(const std::vector<Tet>& tets, int nodeCount)
{
    std::vector<unsigned char> loose(nodeCount, 1);
    for (const Tet& tet : tets)
        for (const int i : tet) loose[i] = 0;
    return loose;
}

void refuseLooseNodes(const std::vector<unsigned char>& loose)
{
    const auto first = std::find(loose.begin(), loose.end(), 1);
    if (first != loose.end())
        reject("node ", first - loose.begin(), " of ", loose.size(),
               " belongs to no element; remove unused nodes from the mesh");
}

/// Signed volume of an element over its longest edge cubed [-]; scaled first against over- and underflow.
double signedQuality(const std::vector<Vec3>& X, const Tet& tet)
{
    double longest = 0;
    for (const auto& edge : kElementEdges)
    {
        const Vec3 d = X[tet[edge[0]]] - X[tet[edge[1]]];
        longest = std::max({longest, std::abs(d.x), std::abs(d.y), std::abs(d.z)});
    }
    Vec3 d[3];
    for (int a = 0; a < 3; ++a)
    {
        d[a] = X[tet[a + 1]] - X[tet[0]];
        d[a] = {d[a].x / longest, d[a].y / longest, d[a].z / longest};
    }
    double longestScaled = std::max({norm(d[0]), norm(d[1]), norm(d[2])});
    longestScaled = std::max({longestScaled, norm(d[1] - d[0]), norm(d[2] - d[0]), norm(d[2] - d[1])});
    return dot(cross(d[0], d[1]), d[2]) / 6 / (longestScaled * longestScaled * longestScaled);
}

/// Swaps the last two nodes of elements of negative orientation; returns their number.
int turnNegative(const std::vector<Vec3>& X, std::vector<Tet>& tets)
{
    int turned = 0;
    for (std::size_t e = 0; e < tets.size(); ++e)
    {
        const double quality = signedQuality(X, tets[e]);
        if (!(std::abs(quality) >= kMinQuality))
            reject("element ", e, " ", nodesOf(tets[e]), " is degenerate: its volume is ", std::abs(quality),
                   " of its longest edge cubed, the least allowed is ", kMinQuality,
                   "; remove it or move its nodes out of one plane");
        if (quality < 0)
        {
            std::swap(tets[e][2], tets[e][3]);
            ++turned;
        }
    }
    return turned;
}

/// The face opposite node a of an element.
Triangle sideOf(const Tet& tet, int a)
{
    return {tet[kFaces[a][0]], tet[kFaces[a][1]], tet[kFaces[a][2]]};
}

/// Rejects elements with four equal nodes, in any order; returns if there are none.
void refuseRepeatedElements(const std::vector<Tet>& tets)
{
    std::vector<std::pair<Tet, int>> sorted;  // nodes, ascending, and the element
    sorted.reserve(tets.size());
    for (std::size_t e = 0; e < tets.size(); ++e)
    {
        Tet nodes = tets[e];
        std::sort(nodes.begin(), nodes.end());
        sorted.emplace_back(nodes, static_cast<int>(e));
    }
    std::sort(sorted.begin(), sorted.end());
    std::size_t repeated = 0, single = 0, first = 0;  // `first`: where the repeated element with the lowest number is
    for (std::size_t i = 0, next = 0; i < sorted.size(); i = next)
    {
        while (next < sorted.size() && sorted[next].first == sorted[i].first) ++next;
        repeated += next - i - 1;
        if (next == i + 1)
            ++single;
        else if (first == 0 || sorted[i + 1].second < sorted[first].second)
            first = i + 1;
    }
    if (repeated == 0) return;
    const int e = sorted[first].second;
    reject(repeated, " of ", tets.size(), " elements repeat another one",
           single == 0 ? " (none is there only once)" : "", ": element ", e, " ", nodesOf(tets[e]),
           " has the four nodes of element ", sorted[first - 1].second, "; list each element once");
}

/// The faces with a single element, in the order of their elements, oriented outward.
std::vector<Triangle> boundaryFaces(const std::vector<Tet>& tets)
{
    const std::vector<ElementFace> faces = sortedFaces(tets);
    std::vector<char> onBoundary(4 * tets.size(), 0);
    for (std::size_t f = 0, next = 0; f < faces.size(); f = next)
    {
        while (next < faces.size() && faces[next].m_nodes == faces[f].m_nodes) ++next;
        const Triangle& n = faces[f].m_nodes;
        const auto apex = [&](std::size_t face) { return tets[faces[face].m_tet][faces[face].m_opposite]; };
        if (next - f > 2 || (next - f == 2 && apex(f) == apex(f + 1))) refuseRepeatedElements(tets);
        if (next - f > 2)
            reject("face (", n[0], ", ", n[1], ", ", n[2], ") is shared by ", next - f, " elements (", faces[f].m_tet,
                   ", ", faces[f + 1].m_tet, ", ", faces[f + 2].m_tet,
                   ", ...), at most 2 can be; remove overlapping elements");
        if (next - f == 1) onBoundary[4 * static_cast<std::size_t>(faces[f].m_tet) + faces[f].m_opposite] = 1;
    }
    std::vector<Triangle> surface;
    for (std::size_t e = 0; e < tets.size(); ++e)
        for (int a = 0; a < 4; ++a)
            if (onBoundary[4 * e + a]) surface.push_back(sideOf(tets[e], a));
    return surface;
}

/// Labels the connected components (through shared nodes) from 0, by lowest node; returns their number.
int labelComponents(const std::vector<Tet>& tets, std::vector<int>& label)
{
    DisjointSets pieces(label.size());
    for (const Tet& tet : tets)
        for (int a = 1; a < 4; ++a) pieces.join(tet[0], tet[a]);
    int count = 0;
    for (std::size_t i = 0; i < label.size(); ++i)
    {
        const int r = pieces.root(static_cast<int>(i));
        label[i] = r == static_cast<int>(i) ? count++ : label[r];
    }
    return count;
}

double meanEdge(const std::vector<Vec3>& X, const std::vector<Tet>& tets)
{
    double sum = 0;
    for (const Tet& tet : tets)
        for (const auto& edge : kElementEdges) sum += norm(X[tet[edge[0]]] - X[tet[edge[1]]]);
    return sum / (6.0 * static_cast<double>(tets.size()));
}

double largestFace(const std::vector<Vec3>& X, const Tet& tet)
{
    double most = 0;  // maximum of twice the area, squared
    for (int a = 0; a < 4; ++a)
    {
        const Vec3 &p = X[tet[a]], &q = X[tet[(a + 1) % 4]], &r = X[tet[(a + 2) % 4]];
        const Vec3 normal = cross(q - p, r - p);
        most = std::max(most, dot(normal, normal));
    }
    return 0.5 * std::sqrt(most);
}

}  // namespace

TetMesh::TetMesh(std::vector<Vec3> restPositions, std::vector<Tet> tets, LooseNodes loose)
{
    takeElements(std::move(restPositions), std::move(tets), loose);
    m_surface = boundaryFaces(m_tets);
    measure();
}

TetMesh TetMesh::withSides(std::vector<Vec3> restPositions, std::vector<Tet> tets,
                           const std::vector<unsigned char>& sides)
{
    TetMesh mesh;
    mesh.takeElements(std::move(restPositions), std::move(tets), LooseNodes::kept);
    if (mesh.m_turnedCount > 0) reject(mesh.m_turnedCount, " elements have negative orientation; turn them first");
    if (sides.size() != mesh.m_tets.size())
        reject("sides on the boundary are given for ", sides.size(), " of ", mesh.m_tets.size(), " elements");
    for (std::size_t e = 0; e < sides.size(); ++e)
    {
        if (sides[e] > 15) reject("element ", e, " has the sides ", static_cast<int>(sides[e]), ", not in [0, 15]");
        for (int a = 0; a < 4; ++a)
            if (sides[e] >> a & 1) mesh.m_surface.push_back(sideOf(mesh.m_tets[e], a));
    }
    mesh.measure();
    return mesh;
}

// m_surface lists the sides in the order of the elements.
std::vector<unsigned char> TetMesh::boundarySides() const
{
    std::vector<unsigned char> sides(m_tets.size(), 0);
    auto next = m_surface.begin();
    for (std::size_t e = 0; e < m_tets.size(); ++e)
        for (int a = 0; a < 4 && next != m_surface.end(); ++a)
            if (*next == sideOf(m_tets[e], a))
            {
                sides[e] = static_cast<unsigned char>(sides[e] | 1 << a);
                ++next;
            }
    return sides;
}

// Checks positions and elements, and mends negative orientation.
void TetMesh::takeElements(std::vector<Vec3> restPositions, std::vector<Tet> tets, LooseNodes loose)
{
    m_restPositions = std::move(restPositions);
    m_tets = std::move(tets);
    constexpr std::size_t most = std::numeric_limits<int>::max() / 12;  // three numbers a node, four faces an element
    if (m_tets.empty()) reject("the mesh has 0 elements; at least 1 tetrahedron is needed");
    if (m_tets.size() > most || m_restPositions.size() > most)
        reject("the mesh has ", m_restPositions.size(), " nodes and ", m_tets.size(), " elements, more than ", most,
               "; use a coarser mesh");
    checkPositions(m_restPositions);
    checkIndices(m_tets, nodeCount());
    m_loose = looseNodes(m_tets, nodeCount());
    if (loose == LooseNodes::refused) refuseLooseNodes(m_loose);
    m_looseCount = static_cast<int>(std::count(m_loose.begin(), m_loose.end(), 1));
    m_turnedCount = turnNegative(m_restPositions, m_tets);
    const auto isSliver = [this](const Tet& tet) { return signedQuality(m_restPositions, tet) < kSliverQuality; };
    m_sliverCount = static_cast<int>(std::count_if(m_tets.begin(), m_tets.end(), isSliver));
}

void TetMesh::measure()
{
    std::vector<unsigned char> onSurface(m_restPositions.size(), 0);
    for (const Triangle& triangle : m_surface)
        for (const int i : triangle) onSurface[i] = 1;
    for (int i = 0; i < nodeCount(); ++i)
        if (onSurface[i]) m_surfaceNodes.push_back(i);

    m_nodeComponent.resize(m_restPositions.size());
    m_componentCount = labelComponents(m_tets, m_nodeComponent);
    m_meanEdgeLength = meanEdge(m_restPositions, m_tets);
    m_shortestHeight = std::numeric_limits<double>::infinity();
    for (int e = 0; e < tetCount(); ++e)
    {
        const double volume = tetVolume(e);
        m_volume += volume;
        m_shortestHeight = std::min(m_shortestHeight, 3 * volume / largestFace(m_restPositions, m_tets[e]));
    }
}

double TetMesh::tetVolume(int e) const
{
    const Tet& tet = m_tets[e];
    const Vec3& X0 = m_restPositions[tet[0]];
    return dot(cross(m_restPositions[tet[1]] - X0, m_restPositions[tet[2]] - X0), m_restPositions[tet[3]] - X0) / 6;
}

}  // namespace bullet_fem
