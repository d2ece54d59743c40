// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/io/surface_file.h"

#include <climits>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <set>
#include <stdexcept>
#include <unordered_map>

#include "fem/common/message.h"
#include "fem/common/reason.h"
#include "io/surface/polygon_mesh.h"
#include "io/surface/triangulate.h"
#include "io/text/file_bytes.h"
#include "io/text/foreign_file.h"

namespace bullet_fem
{
namespace
{

PolygonMesh readPolygons(const std::string& path)
{
    checkIsFile(path);
    const std::string ending = lowerCaseEnding(path);
    // A binary .stl file may begin with anything.
    if (ending == ".off" || ending == ".ply" || ending == ".obj")
        refuseForeignFile(readHead(path, kHeadBytes), ".off, .obj, .stl or .ply");
    if (ending == ".off") return readOff(withoutByteOrderMark(readBytes(path)));
    if (ending == ".ply") return readPly(readBytes(path));
    if (ending == ".obj" || ending == ".stl") return readWithAssimp(path);
    throw std::runtime_error("the ending '" + ending + "' is not known; it must be .off, .obj, .stl or .ply");
}

void checkPolygons(const PolygonMesh& mesh)
{
    if (mesh.m_positions.size() > INT_MAX) throw std::runtime_error("it has more than 2^31 - 1 vertices");
    std::size_t corner = 0;
    for (std::size_t f = 0; f < mesh.m_faceEnd.size(); ++f)
        for (; corner < mesh.m_faceEnd[f]; ++corner)
        {
            const int v = mesh.m_corners[corner];
            if (v < 0 || v >= static_cast<int>(mesh.m_positions.size()))
                throw std::runtime_error(
                    message("face ", f, " uses vertex ", v, ", which is not in [0, ", mesh.m_positions.size(), ")"));
            if (!isFinite(mesh.m_positions[v]))
                throw std::runtime_error(message("vertex ", v, " of face ", f, " is not finite"));
        }
}

struct PositionHash
{
    std::size_t operator()(const Vec3& x) const
    {
        std::uint64_t h = 0;
        for (int i = 0; i < 3; ++i)
        {
            std::uint64_t bits;
            std::memcpy(&bits, &(i == 0 ? x.x : i == 1 ? x.y : x.z), sizeof bits);
            h = (h ^ bits) * 0x9E3779B97F4A7C15u;
            h ^= h >> 29;
        }
        return static_cast<std::size_t>(h);
    }
};
struct PositionEqual
{
    bool operator()(const Vec3& a, const Vec3& b) const { return a.x == b.x && a.y == b.y && a.z == b.z; }
};

/// For every vertex the first one of equal position. Exact, because a tolerance would depend on the size of details.
std::vector<int> firstAtSamePlace(const std::vector<Vec3>& positions)
{
    std::unordered_map<Vec3, int, PositionHash, PositionEqual> seen;
    std::vector<int> first(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i)
    {
        const Vec3 key = positions[i] + Vec3{};  // turns -0 into +0, which compares equal but would hash apart
        first[i] = seen.emplace(key, static_cast<int>(i)).first->second;
    }
    return first;
}

std::vector<Triangle> weldedTriangles(const PolygonMesh& mesh)
{
    const std::vector<int> welded = firstAtSamePlace(mesh.m_positions);
    std::vector<Triangle> all, kept;
    std::size_t begin = 0;
    for (const std::size_t end : mesh.m_faceEnd)
    {
        std::vector<int> corners;
        for (; begin < end; ++begin) corners.push_back(welded[mesh.m_corners[begin]]);
        triangulatePolygon(mesh.m_positions, std::move(corners), all);
    }
    for (const Triangle& t : all)
        if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) kept.push_back(t);
    return kept;
}

/// Whether labels define regions: a single colour defines none, and a photographic texture has too many.
bool areRegions(const std::vector<int>& labels)
{
    std::set<int> different;
    for (const int label : labels)
        if (different.insert(label).second && static_cast<int>(different.size()) > kMaxSurfaceRegions) return false;
    return different.size() > 1;
}

/// Removes unused vertices, keeps their order, and renumbers the triangles.
SurfaceMesh compact(const PolygonMesh& mesh, std::vector<Triangle> triangles, double scale)
{
    const std::vector<Vec3>& positions = mesh.m_positions;
    std::vector<int> number(positions.size(), -1);
    for (const Triangle& t : triangles)
        for (const int v : t) number[v] = 0;
    SurfaceMesh surface;
    for (std::size_t v = 0; v < positions.size(); ++v)
    {
        if (number[v] < 0) continue;
        number[v] = static_cast<int>(surface.m_vertices.size());
        surface.m_vertices.push_back(positions[v] * scale);
        if (!isFinite(surface.m_vertices.back()))
            throw std::runtime_error(message("vertex ", v, " is not finite once scaled"));
        if (!mesh.m_labels.empty()) surface.m_labels.push_back(mesh.m_labels[v]);
    }
    if (!areRegions(surface.m_labels)) surface.m_labels.clear();
    for (Triangle& t : triangles)
        for (int& v : t) v = number[v];
    surface.m_triangles = std::move(triangles);
    return surface;
}

}  // namespace

SurfaceMesh readSurfaceFile(const std::string& path, double scale)
{
    if (!(scale > 0 && std::isfinite(scale)))
        reject("readSurfaceFile: scale is ", scale, "; it must be positive and finite");
    try
    {
        const PolygonMesh polygons = readPolygons(path);
        checkPolygons(polygons);
        std::vector<Triangle> triangles = weldedTriangles(polygons);
        if (triangles.empty()) throw std::runtime_error("it has no triangle");
        return compact(polygons, std::move(triangles), scale);
    }
    catch (const std::exception& error)
    {
        throw std::runtime_error("cannot read the surface file '" + path + "': " + reasonOf(error));
    }
}

}  // namespace bullet_fem
