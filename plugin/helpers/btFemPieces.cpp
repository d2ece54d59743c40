// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Cuts soft bodies into fragments along the faces of their tetrahedra.
#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <random>
#include <utility>

#include "BulletSoftBody/btSoftBody.h"
#include "bullet_bridge/body/soft_body_mesh.h"
#include "bullet_fem/btFemCollision.h"
#include "bullet_fem/btFemVectors.h"
#include "bullet_fem/btFemWelds.h"
#include "fem/common/attempt.h"
#include "fem/common/message.h"

using namespace bullet_fem;

namespace
{

constexpr int kCandidates = 10;  // candidates per cell; the one farthest from the other points is taken

RestMesh restOf(const btSoftBody* body, const char* caller)
{
    if (!body) reject(caller, ": the body is null");
    if (body->m_tetras.size() == 0)
        reject(caller, ": the body has no tetrahedra; make it of tetrahedra, as btFemHelpers does");
    return restMeshOf(*body);
}

/// Neighbours of every tetrahedron behind its faces; -1: none.
std::vector<std::array<int, 4>> neighboursOf(const TetMesh& mesh)
{
    struct Side
    {
        std::array<int, 3> m_face;
        int m_tet, m_side;
        bool operator<(const Side& b) const { return m_face < b.m_face; }
    };
    std::vector<Side> sides;
    for (int e = 0; e < mesh.tetCount(); ++e)
        for (int a = 0; a < 4; ++a)
        {
            const Tet& tet = mesh.tets()[e];
            Side side = {{tet[(a + 1) % 4], tet[(a + 2) % 4], tet[(a + 3) % 4]}, e, a};
            std::sort(side.m_face.begin(), side.m_face.end());
            sides.push_back(side);
        }
    std::stable_sort(sides.begin(), sides.end());
    std::vector<std::array<int, 4>> neighbours(mesh.tetCount(), {-1, -1, -1, -1});
    for (std::size_t k = 1; k < sides.size(); ++k)
    {
        const Side &a = sides[k - 1], &b = sides[k];
        if (a < b) continue;
        neighbours[a.m_tet][a.m_side] = b.m_tet;
        neighbours[b.m_tet][b.m_side] = a.m_tet;
    }
    return neighbours;
}

/// The components of a mesh connected by faces between tetrahedra of one label, in the order of their first tetrahedra.
std::vector<std::vector<int>> partsOf(const TetMesh& mesh, const std::vector<int>& labels)
{
    const std::vector<std::array<int, 4>> neighbours = neighboursOf(mesh);
    std::vector<std::vector<int>> parts;
    std::vector<unsigned char> found(mesh.tetCount(), 0);
    for (int first = 0; first < mesh.tetCount(); ++first)
    {
        if (found[first]) continue;
        std::vector<int> part = {first};
        found[first] = 1;
        for (std::size_t k = 0; k < part.size(); ++k)
            for (const int next : neighbours[part[k]])
            {
                if (next < 0 || found[next] || labels[next] != labels[first]) continue;
                found[next] = 1;
                part.push_back(next);
            }
        std::sort(part.begin(), part.end());
        parts.push_back(std::move(part));
    }
    return parts;
}

/// Components of a label other than its largest take a neighbour's label, so that cells are connected.
void joinStrays(const TetMesh& mesh, std::vector<int>& labels)
{
    constexpr int kNone = -1;
    const std::vector<std::array<int, 4>> neighbours = neighboursOf(mesh);
    const std::vector<std::vector<int>> parts = partsOf(mesh, labels);
    std::map<int, std::size_t> largest;  // largest component of each label
    for (std::size_t p = 0; p < parts.size(); ++p)
    {
        const auto at = largest.emplace(labels[parts[p].front()], p).first;
        if (parts[p].size() > parts[at->second].size()) at->second = p;
    }
    std::vector<int> joined(labels.size(), kNone);
    std::vector<int> reached;
    for (const auto& [label, p] : largest)
        for (int e : parts[p]) joined[e] = label;
    for (int e = 0; e < mesh.tetCount(); ++e)
        if (joined[e] != kNone) reached.push_back(e);
    for (std::size_t k = 0; k < reached.size(); ++k)
        for (int next : neighbours[reached[k]])
        {
            if (next < 0 || joined[next] != kNone) continue;
            joined[next] = joined[reached[k]];
            reached.push_back(next);
        }
    for (std::size_t e = 0; e < labels.size(); ++e)  // unreachable tetrahedra keep their label
        if (joined[e] != kNone) labels[e] = joined[e];
}

Vec3 centroidOf(const TetMesh& mesh, int e)
{
    Vec3 sum;
    for (int node : mesh.tets()[e]) sum += mesh.restPositions()[node];
    return 0.25 * sum;
}

int nearestOf(const std::vector<Vec3>& points, const Vec3& x)
{
    int nearest = -1;
    for (int k = 0; k < static_cast<int>(points.size()); ++k)
        if (nearest < 0 || norm(points[k] - x) < norm(points[nearest] - x)) nearest = k;
    return nearest;
}

/// Random points at element centroids, with probability by volume; each is the best of some candidates, the one
/// farthest from the previous points [Mitchell 1991]. The generator is specified exactly by the standard; std's
/// distributions are not.
std::vector<Vec3> spreadPoints(const TetMesh& mesh, int count, unsigned randomSeed)
{
    std::vector<double> sums(1, 0);
    for (int e = 0; e < mesh.tetCount(); ++e) sums.push_back(sums.back() + mesh.tetVolume(e));
    std::mt19937 random(randomSeed);
    const auto draw = [&]
    {
        const double at = sums.back() * (static_cast<double>(random()) / 4294967296.0);
        const auto after = std::upper_bound(sums.begin() + 1, sums.end() - 1, at);
        return centroidOf(mesh, static_cast<int>(after - sums.begin()) - 1);
    };
    std::vector<Vec3> points;
    while (static_cast<int>(points.size()) < count)
    {
        Vec3 best = draw();
        for (int k = 1; k < kCandidates && !points.empty(); ++k)
        {
            const Vec3 other = draw();
            const auto away = [&](const Vec3& x) { return norm(points[nearestOf(points, x)] - x); };
            if (away(other) > away(best)) best = other;
        }
        points.push_back(best);
    }
    return points;
}

/// Node masses and the volumes by which they are divided.
struct SharedMass
{
    std::vector<double> m_mass;    // mass of every node; 0: pinned [kg]
    std::vector<double> m_volume;  // volume at every node [m3]
    std::vector<double> m_ofTet;   // filled volume of every tetrahedron [m3]
    std::vector<double> m_filled;  // filled fractions; empty: all 1
};

SharedMass sharedMassOf(const btSoftBody& body, const TetMesh& mesh)
{
    SharedMass shared;
    shared.m_filled = filledFractionsOf(body);
    shared.m_volume = lumpedMasses(mesh, shared.m_filled, 1);
    bool repaired = false;
    shared.m_mass = sanitisedMasses(body, shared.m_volume, repaired);
    for (int e = 0; e < mesh.tetCount(); ++e)
        shared.m_ofTet.push_back(mesh.tetVolume(e) * (shared.m_filled.empty() ? 1 : shared.m_filled[e]));
    return shared;
}

/// Copies the settings of the cut body.
void copySettings(const btSoftBody& from, btSoftBody& to)
{
    to.m_cfg = from.m_cfg;
    to.m_cfg.collisions &= ~BT_FEM_RENDER_SURFACE;  // the fragment has no embedded surface
    to.m_materials[0]->m_kLST = from.m_materials[0]->m_kLST;
    to.m_materials[0]->m_kAST = from.m_materials[0]->m_kAST;
    to.m_materials[0]->m_kVST = from.m_materials[0]->m_kVST;
    to.setFriction(from.getFriction());
    to.setRestitution(from.getRestitution());
    to.setCollisionFlags(from.getCollisionFlags());
    to.m_sleepingThreshold = from.m_sleepingThreshold;
    if (from.getCollisionShape()) to.getCollisionShape()->setMargin(from.getCollisionShape()->getMargin());
}

btFemPiece pieceOf(const btSoftBody& body, const RestMesh& rest, const SharedMass& shared, std::vector<int> part)
{
    const TetMesh& whole = rest.m_mesh;
    btFemPiece piece;
    piece.m_tets = std::move(part);
    for (int e : piece.m_tets)
        piece.m_nodes.insert(piece.m_nodes.end(), whole.tets()[e].begin(), whole.tets()[e].end());
    std::sort(piece.m_nodes.begin(), piece.m_nodes.end());
    piece.m_nodes.erase(std::unique(piece.m_nodes.begin(), piece.m_nodes.end()), piece.m_nodes.end());
    const int count = static_cast<int>(piece.m_nodes.size());
    const auto local = [&](int node)
    { return int(std::lower_bound(piece.m_nodes.begin(), piece.m_nodes.end(), node) - piece.m_nodes.begin()); };

    std::vector<Vec3> X;
    for (int node : piece.m_nodes) X.push_back(rest.m_origin + whole.restPositions()[node]);
    std::vector<Tet> tets;
    std::vector<double> volume(count, 0);
    for (int e : piece.m_tets)
    {
        Tet tet = whole.tets()[e];
        for (int& node : tet) node = local(node);
        for (int node : tet) volume[node] += shared.m_ofTet[e] / 4;
        tets.push_back(tet);
    }
    const TetMesh mesh(X, tets);
    btAlignedObjectArray<btVector3> positions;
    btAlignedObjectArray<btScalar> masses;
    for (int i = 0; i < count; ++i)
    {
        const int node = piece.m_nodes[i];
        positions.push_back(bulletVector(X[i]));
        masses.push_back(static_cast<btScalar>(shared.m_mass[node] * volume[i] / shared.m_volume[node]));
    }
    auto made = std::make_unique<btSoftBody>(body.m_worldInfo, count, &positions[0], &masses[0]);
    makeTets(*made, mesh);
    if (!shared.m_filled.empty())
        for (std::size_t e = 0; e < piece.m_tets.size(); ++e)
            storeFill(*made, static_cast<int>(e), shared.m_filled[piece.m_tets[e]], massScaleOf(body));
    for (int i = 0; i < count; ++i)
    {
        const btSoftBody::Node& from = body.m_nodes[piece.m_nodes[i]];
        btSoftBody::Node& to = made->m_nodes[i];
        to.m_x = from.m_x;
        to.m_q = from.m_q;
        to.m_v = from.m_v;
        if (from.m_im == 0) to.m_im = 0;
    }
    copySettings(body, *made);
    made->updateNormals();
    made->updateBounds();
    piece.m_body = made.release();
    return piece;
}

}  // namespace

bool btFemPieces::voronoiLabels(const btSoftBody* body, int cells, unsigned randomSeed, std::vector<int>& labels,
                                std::string* why)
{
    const auto label = [&]
    {
        const TetMesh mesh = restOf(body, "voronoiLabels").m_mesh;
        if (cells < 1 || cells > mesh.tetCount())
            reject("voronoiLabels: ", cells, " cells are not in [1, ", mesh.tetCount(),
                   "], the number of tetrahedra; take fewer cells or a finer mesh");
        const std::vector<Vec3> points = spreadPoints(mesh, cells, randomSeed);
        std::vector<int> nearest;
        for (int e = 0; e < mesh.tetCount(); ++e) nearest.push_back(nearestOf(points, centroidOf(mesh, e)));
        joinStrays(mesh, nearest);
        labels = std::move(nearest);
    };
    return attempt(why, label);
}

bool btFemPieces::cut(const btSoftBody* body, const std::vector<int>& labels, std::vector<btFemPiece>& pieces,
                      std::string* why)
{
    const auto cutBody = [&]
    {
        const RestMesh rest = restOf(body, "cut");
        if (static_cast<int>(labels.size()) != rest.m_mesh.tetCount())
            reject("cut: ", labels.size(), " labels for ", rest.m_mesh.tetCount(),
                   " tetrahedra; give one for each, as voronoiLabels does");
        std::vector<std::vector<int>> parts = partsOf(rest.m_mesh, labels);
        const auto isBefore = [&](const std::vector<int>& a, const std::vector<int>& b)
        { return labels[a.front()] < labels[b.front()]; };
        std::stable_sort(parts.begin(), parts.end(), isBefore);
        const SharedMass shared = sharedMassOf(*body, rest.m_mesh);
        std::vector<btFemPiece> made;
        for (std::vector<int>& part : parts)
        {
            const int label = labels[part.front()];
            made.push_back(pieceOf(*body, rest, shared, std::move(part)));
            made.back().m_label = label;
        }
        pieces = std::move(made);
    };
    return attempt(why, cutBody);
}
