// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/common/message.h"
#include "io/tet/cell_kind.h"
#include "io/tet/node_numbers.h"
#include "io/tet/tet_readers.h"

namespace bullet_fem
{
namespace
{

/// The next line that is not blank: an item with attributes and markers, which are ignored.
std::string_view nextLine(MeshScanner& text, const char* what)
{
    if (text.peekWord().empty()) text.word(what);
    return text.restOfLine();
}

/// The next number of the last line.
template <class Number>
Number take(const MeshScanner& text, std::string_view& line, const char* what)
{
    return text.parse<Number>(takeWord(line), what);
}

/// The next number of a header, whose last numbers are optional.
std::uint64_t takeOr(const MeshScanner& text, std::string_view& line, std::uint64_t otherwise)
{
    const std::string_view word = takeWord(line);
    return word.empty() ? otherwise : text.parse<std::uint64_t>(word, "a number of the header");
}

}  // namespace

void readTetGenNodes(MeshScanner& text, TetMeshFile& mesh)
{
    std::string_view line = nextLine(text, "the number of points");
    const auto count = take<std::uint64_t>(text, line, "a number of points");
    const std::uint64_t dimension = takeOr(text, line, 3);
    if (dimension != 3) text.fail(message("the dimension is ", dimension, "; it must be 3"));
    text.need(count, 4, 1, "points");
    for (std::uint64_t i = 0; i < count; ++i)
    {
        line = nextLine(text, "a point");
        mesh.m_nodeNumbers.push_back(take<std::uint64_t>(text, line, "a point's number"));
        Vec3 x;
        for (int k = 0; k < 3; ++k) x[k] = take<double>(text, line, "a coordinate");
        mesh.m_positions.push_back(x);
    }
    mesh.m_format = "TetGen";
}

void readTetGenTets(MeshScanner& text, TetMeshFile& mesh)
{
    const NodeNumbers numbers(mesh.m_nodeNumbers, text);
    std::string_view line = nextLine(text, "the number of tetrahedra");
    const auto count = take<std::uint64_t>(text, line, "a number of tetrahedra");
    const std::uint64_t corners = takeOr(text, line, 4);
    if (corners != 4)
        text.fail(message("a tetrahedron with ", corners, " nodes cannot be read, only those with 4",
                          corners == 10 ? "; run TetGen without -o2" : ""));
    const bool hasAttributes = takeOr(text, line, 0) > 0;
    text.need(count, 5, 1, "tetrahedra");
    for (std::uint64_t e = 0; e < count; ++e)
    {
        line = nextLine(text, "a tetrahedron");
        take<std::int64_t>(text, line, "a tetrahedron's number");
        Tet tet;
        for (int& place : tet)
        {
            const auto number = take<std::uint64_t>(text, line, "a point's number");
            place = numbers.find(number);
            if (place < 0)
                text.fail(message("a tetrahedron uses point ", number, ", which the .node file does not have"));
        }
        mesh.m_tets.push_back(tet);
        const std::string_view attribute = hasAttributes ? takeWord(line) : std::string_view();
        if (!attribute.empty()) noteRegion(mesh, text.parse<double>(attribute, "an attribute"));
    }
    mesh.m_regions.resize(mesh.m_regions.empty() ? 0 : mesh.m_tets.size(), 0);
}

}  // namespace bullet_fem
