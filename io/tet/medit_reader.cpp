// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <optional>

#include "fem/common/message.h"
#include "io/tet/cell_kind.h"
#include "io/tet/tet_readers.h"

namespace bullet_fem
{
namespace
{

bool beginsWithLetter(std::string_view word)
{
    return !word.empty() && ((word[0] >= 'a' && word[0] <= 'z') || (word[0] >= 'A' && word[0] <= 'Z'));
}

/// Skips the contents of an unread keyword, up to the next keyword.
void skipToKeyword(MeshScanner& text)
{
    while (!text.atEnd() && !beginsWithLetter(text.peekWord())) text.word("a number");
}

void readHeader(MeshScanner& text, TetMeshFile& mesh)
{
    mesh.m_format = "Medit";
    if (text.peekWord() != "MeshVersionFormatted") text.fail("a Medit file begins with MeshVersionFormatted");
    text.word("MeshVersionFormatted");
    const int version = text.text<int>("a version");
    if (version < 1 || version > 4) text.fail(message("the version is ", version, "; it must be in [1, 4]"));
    mesh.m_version = message(version, " text");
}

void readVertices(MeshScanner& text, TetMeshFile& mesh)
{
    if (!mesh.m_positions.empty()) text.fail("there is a second section Vertices");
    const auto count = text.text<std::uint64_t>("a number of vertices");
    text.need(count, 4, 1, "vertices");
    for (std::uint64_t i = 0; i < count; ++i)
    {
        Vec3 x;
        for (int k = 0; k < 3; ++k) x[k] = text.text<double>("a coordinate");
        text.text<double>("a reference");  // an integer, which some programs write with a decimal point
        mesh.m_positions.push_back(x);
        mesh.m_nodeNumbers.push_back(i + 1);
    }
}

void readTetrahedra(MeshScanner& text, TetMeshFile& mesh)
{
    const auto count = text.text<std::uint64_t>("a number of tetrahedra");
    text.need(count, 5, 1, "tetrahedra");
    for (std::uint64_t e = 0; e < count; ++e)
    {
        Tet tet;
        for (int& place : tet)
        {
            const auto number = text.text<std::uint64_t>("a vertex number");
            if (number < 1 || number > mesh.m_positions.size())
                text.fail(message("a tetrahedron uses vertex ", number, ", which is not in [1, ",
                                  mesh.m_positions.size(), "]"));
            place = static_cast<int>(number - 1);
        }
        mesh.m_tets.push_back(tet);
        noteRegion(mesh, text.text<double>("a reference"));
    }
}

/// Kind of a keyword's cells, of any order; none for other keywords, such as RequiredTriangles, Ridges and Normals.
std::optional<CellKind> kindOf(std::string_view keyword)
{
    const auto begins = [&](std::string_view name) { return keyword.substr(0, name.size()) == name; };
    if (begins("Edges")) return CellKind::edge;
    if (begins("Triangles") || begins("Quadrilaterals")) return CellKind::face;
    for (const char* name : {"Tetrahedra", "Hexahedra", "Prisms", "Pentahedra", "Pyramids", "Polyhedra"})
        if (begins(name)) return CellKind::refused;
    return {};
}

/// Skips another keyword of cells, or an unknown one.
void skipSection(MeshScanner& text, std::string_view keyword, TetMeshFile& mesh)
{
    const std::optional<CellKind> kind = kindOf(keyword);
    if (kind)
    {
        const auto count = text.text<std::uint64_t>("a number of cells");
        if (*kind == CellKind::refused && count > 0)
            text.fail(refusalOf("a cell of the section " + std::string(keyword)));
        text.need(count, *kind == CellKind::edge ? 3 : 4, 1, "cells");
        countSkipped(mesh, *kind, static_cast<std::size_t>(count));
    }
    skipToKeyword(text);
}

}  // namespace

TetMeshFile readMedit(std::string_view bytes)
{
    TetMeshFile mesh;
    MeshScanner text(bytes, true);
    readHeader(text, mesh);
    std::vector<MeshScanner> early;  // tetrahedra before the vertices are read at the end
    bool ended = false;
    while (!ended && !text.atEnd())
    {
        const std::string_view keyword = text.word("a keyword");
        if (!beginsWithLetter(keyword))
            text.fail("'" + printable(keyword) + "' stands where a keyword such as Vertices should");
        if (keyword == "Dimension")
        {
            const int dimension = text.text<int>("a dimension");
            if (dimension != 3) text.fail(message("the dimension is ", dimension, "; it must be 3"));
        }
        else if (keyword == "Vertices")
            readVertices(text, mesh);
        else if (keyword == "Tetrahedra" && !mesh.m_positions.empty())
            readTetrahedra(text, mesh);
        else if (keyword == "Tetrahedra")
        {
            early.push_back(text);
            skipToKeyword(text);
        }
        else
            skipSection(text, keyword, mesh);
        ended = keyword == "End";
    }
    for (MeshScanner& section : early) readTetrahedra(section, mesh);
    return mesh;
}

}  // namespace bullet_fem
