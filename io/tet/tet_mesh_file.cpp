// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/io/tet_mesh_file.h"

#include <algorithm>
#include <climits>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "fem/common/message.h"
#include "fem/common/reason.h"
#include "io/tet/tet_readers.h"
#include "io/text/file_bytes.h"
#include "io/text/foreign_file.h"

namespace bullet_fem
{
namespace
{

void checkScale(double scale)
{
    if (!(scale > 0 && std::isfinite(scale)))
        reject("readTetMeshFile: scale is ", scale, "; it must be positive and finite");
}

constexpr const char* kEndings = ".msh, .node and .ele, .vtk, .vtu or .mesh";

/// The format recognised by the first bytes; `stated` if they are ambiguous.
TetMeshFormat formatOf(std::string_view bytes, TetMeshFormat stated)
{
    struct Beginning
    {
        std::string_view m_text;
        TetMeshFormat m_format;
    };
    constexpr Beginning beginnings[] = {{"$MeshFormat", TetMeshFormat::gmsh},
                                        {"$Comments", TetMeshFormat::gmsh},
                                        {"$NOD", TetMeshFormat::gmsh},
                                        {"$NOE", TetMeshFormat::gmsh},
                                        {"# vtk DataFile", TetMeshFormat::vtk},
                                        {"#vtk DataFile", TetMeshFormat::vtk},
                                        {"MeshVersionFormatted", TetMeshFormat::medit}};
    bytes.remove_prefix(std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size()));
    bytes = bytes.substr(0, kHeadBytes);
    if (bytes.substr(0, 1) == "<" && bytes.find("<VTKFile") != std::string_view::npos) return TetMeshFormat::vtu;
    for (const Beginning& known : beginnings)
        if (bytes.substr(0, known.m_text.size()) == known.m_text) return known.m_format;
    return stated;
}

TetMeshFile readTetGen(std::string_view bytes)
{
    TetMeshFile mesh;
    MeshScanner text(bytes, true);
    readTetGenNodes(text, mesh);
    readTetGenTets(text, mesh);
    return mesh;
}

TetMeshFile readFormat(std::string_view bytes, TetMeshFormat format)
{
    switch (format)
    {
        case TetMeshFormat::gmsh:
            return readGmsh(bytes);
        case TetMeshFormat::tetgen:
            return readTetGen(bytes);
        case TetMeshFormat::vtk:
            return readVtk(bytes);
        case TetMeshFormat::vtu:
            return readVtu(bytes);
        case TetMeshFormat::medit:
            return readMedit(bytes);
    }
    throw std::runtime_error("the format is not known");
}

/// Removes nodes that no tetrahedron uses, and scales the others; drops regions if all are 0.
void finish(TetMeshFile& mesh, double scale)
{
    const auto isZero = [](int region) { return region == 0; };
    if (mesh.m_regions.size() != mesh.m_tets.size() ||
        std::all_of(mesh.m_regions.begin(), mesh.m_regions.end(), isZero))
        mesh.m_regions.clear();
    if (mesh.m_tets.empty())
        throw std::runtime_error(message("it has no tetrahedra (but ", mesh.m_skippedFaces, " faces, ",
                                         mesh.m_skippedEdges, " edges and ", mesh.m_skippedPoints, " points)"));
    if (mesh.m_positions.size() > INT_MAX) throw std::runtime_error("it has more than 2^31 - 1 nodes");
    std::vector<int> number(mesh.m_positions.size(), -1);
    for (const Tet& tet : mesh.m_tets)
        for (const int i : tet) number[i] = 0;
    int used = 0;
    for (std::size_t i = 0; i < number.size(); ++i)
    {
        if (number[i] < 0) continue;
        const Vec3 x = mesh.m_positions[i] * scale;
        if (!isFinite(x))
            throw std::runtime_error(message("node ", mesh.m_nodeNumbers[i], " has the position (",
                                             mesh.m_positions[i].x, ", ", mesh.m_positions[i].y, ", ",
                                             mesh.m_positions[i].z, "), which is not finite",
                                             isFinite(mesh.m_positions[i]) ? " once scaled" : ""));
        mesh.m_positions[used] = x;
        mesh.m_nodeNumbers[used] = mesh.m_nodeNumbers[i];
        number[i] = used++;
    }
    for (Tet& tet : mesh.m_tets)
        for (int& i : tet) i = number[i];
    mesh.m_unusedNodes = number.size() - static_cast<std::size_t>(used);
    mesh.m_positions.resize(used);
    mesh.m_nodeNumbers.resize(used);
}

/// Runs `read` on the bytes of a file, and prepends its name to exceptions.
template <class Read>
auto readNamed(const std::string& path, Read read)
{
    try
    {
        const std::string bytes = readBytes(path);
        return read(std::string_view(bytes));
    }
    catch (const std::exception& error)
    {
        throw std::runtime_error("cannot read the mesh file '" + path + "': " + reasonOf(error));
    }
}

/// Reads a .node and an .ele file in one folder; `path` is either of them.
TetMeshFile readTetGenFiles(const std::string& path, double scale)
{
    const bool isNode = lowerCaseEnding(path) == ".node";
    const std::string other = std::filesystem::path(path).replace_extension(isNode ? ".ele" : ".node").string();
    TetMeshFile mesh;
    readNamed(isNode ? path : other,
              [&](std::string_view bytes)
              {
                  refuseForeignFile(bytes, kEndings);
                  MeshScanner text(withoutByteOrderMark(bytes), true);
                  readTetGenNodes(text, mesh);
              });
    readNamed(isNode ? other : path,
              [&](std::string_view bytes)
              {
                  refuseForeignFile(bytes, kEndings);
                  MeshScanner text(withoutByteOrderMark(bytes), true);
                  readTetGenTets(text, mesh);
                  finish(mesh, scale);
              });
    return mesh;
}

}  // namespace

TetMeshFile readTetMesh(const void* bytes, std::size_t size, TetMeshFormat format, double scale)
{
    checkScale(scale);
    const std::string_view text = withoutByteOrderMark({static_cast<const char*>(bytes), size});
    refuseForeignFile(text, kEndings);
    TetMeshFile mesh = readFormat(text, formatOf(text, format));
    finish(mesh, scale);
    return mesh;
}

TetMeshFile readTetMeshFile(const std::string& path, double scale)
{
    checkScale(scale);
    struct Ending
    {
        const char* ending;
        TetMeshFormat format;
    };
    constexpr Ending endings[] = {
        {".msh", TetMeshFormat::gmsh},
        {".vtk", TetMeshFormat::vtk},
        {".vtu", TetMeshFormat::vtu},
        {".mesh", TetMeshFormat::medit},
        {".meshb", TetMeshFormat::medit}};  // gives a message that binary files are not supported
    const std::string ending = lowerCaseEnding(path);
    if (ending == ".node" || ending == ".ele") return readTetGenFiles(path, scale);
    for (const Ending& known : endings)
        if (ending == known.ending)
            return readNamed(path, [&](std::string_view bytes)
                             { return readTetMesh(bytes.data(), bytes.size(), known.format, scale); });
    throw std::runtime_error("cannot read the mesh file '" + path + "': the ending '" + ending +
                             "' is not known; it must be .msh, .node, .ele, .vtk, .vtu or .mesh");
}

}  // namespace bullet_fem
