// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "io/tet/gmsh_sections.h"

#include "fem/common/message.h"
#include "io/tet/cell_kind.h"

namespace bullet_fem
{
namespace
{

constexpr const char* kNodeTag = "a node tag";
constexpr const char* kElementType = "an element type";

/// A Gmsh element type.
struct GmshCell
{
    CellKind kind;
    int nodes;         ///< nodes of an element; 0 if refused
    std::string name;  ///< with its article, if refused
};

struct Counted
{
    int type, nodes;
};

constexpr Counted kLines[] = {{1, 2}, {8, 3}, {26, 4}, {27, 5}, {28, 6}, {62, 7}, {63, 8}, {64, 9}, {65, 10}, {66, 11}};
constexpr Counted kTriangles[] = {{2, 3},   {9, 6},   {20, 9},  {21, 10}, {22, 12}, {23, 15},
                                  {24, 15}, {25, 21}, {42, 28}, {43, 36}, {44, 45}, {45, 55},
                                  {46, 66}, {52, 18}, {53, 21}, {54, 24}, {55, 27}, {56, 30}};
constexpr Counted kQuadrangles[] = {{3, 4},   {10, 9},  {16, 8},  {36, 16}, {37, 25}, {38, 36},  {39, 12},
                                    {40, 16}, {41, 20}, {47, 49}, {48, 64}, {49, 81}, {50, 100}, {51, 121},
                                    {57, 24}, {58, 28}, {59, 32}, {60, 36}, {61, 40}};

struct NamedCell
{
    int type;
    const char* name;
};

constexpr NamedCell kVolumes[] = {{5, "a hexahedron"},
                                  {6, "a prism"},
                                  {7, "a pyramid"},
                                  {11, "a tetrahedron of second order (10 nodes)"},
                                  {12, "a hexahedron of second order (27 nodes)"},
                                  {13, "a prism of second order (18 nodes)"},
                                  {14, "a pyramid of second order (14 nodes)"},
                                  {17, "a hexahedron of second order (20 nodes)"},
                                  {18, "a prism of second order (15 nodes)"},
                                  {19, "a pyramid of second order (13 nodes)"},
                                  {29, "a tetrahedron of third order (20 nodes)"},
                                  {30, "a tetrahedron of fourth order (35 nodes)"},
                                  {31, "a tetrahedron of fifth order (56 nodes)"},
                                  {35, "a polyhedron"}};

/// The nodes of a cell of this type; 0 if it is not one of these.
template <std::size_t Size>
int nodesOf(int type, const Counted (&cells)[Size])
{
    for (const Counted& cell : cells)
        if (cell.type == type) return cell.nodes;
    return 0;
}

/// The element type of a number in Gmsh's list (GmshDefines.h).
GmshCell gmshCell(int type)
{
    if (type == 4) return {CellKind::tet, 4, {}};
    if (type == 15) return {CellKind::point, 1, {}};
    if (const int nodes = nodesOf(type, kLines)) return {CellKind::edge, nodes, {}};
    if (const int nodes = nodesOf(type, kTriangles)) return {CellKind::face, nodes, {}};
    if (const int nodes = nodesOf(type, kQuadrangles)) return {CellKind::face, nodes, {}};
    for (const NamedCell& volume : kVolumes)
        if (volume.type == type)
            return {CellKind::refused, 0, message(volume.name, ", Gmsh's element type ", type, ",")};
    return {CellKind::refused, 0, message("Gmsh's element type ", type)};
}

/// The element type of a number; fails on refused cells.
GmshCell cellOf(int type, const MeshScanner& scanner)
{
    const GmshCell cell = gmshCell(type);
    if (cell.kind == CellKind::refused) scanner.fail(refusalOf(cell.name));
    return cell;
}

/// A count in a line of its own, which is text in binary files, too.
std::uint64_t readCountLine(MeshScanner& scanner, const char* what)
{
    const auto count = scanner.text<std::uint64_t>(what);
    scanner.restOfLine();
    return count;
}

/// The nodes of an element, whose tags have `tagBytes` bytes in binary files.
template <class Tag>
void readElementNodes(GmshFile& file, const GmshCell& cell, int tagBytes, std::int64_t region)
{
    if (cell.kind == CellKind::tet)
    {
        Tet tet;
        for (int& place : tet)
            place = placeOfGmshNode(file, static_cast<std::uint64_t>(file.scanner.get<Tag>(kNodeTag, tagBytes)));
        file.mesh.m_tets.push_back(tet);
        noteRegion(file.mesh, static_cast<double>(region));
        return;
    }
    for (int i = 0; i < cell.nodes; ++i) file.scanner.get<Tag>(kNodeTag, tagBytes);
    countSkipped(file.mesh, cell.kind, 1);
}

void readTextElements2(GmshFile& file, std::uint64_t count)
{
    MeshScanner& scanner = file.scanner;
    for (std::uint64_t e = 0; e < count; ++e)
    {
        scanner.text<std::int64_t>("an element number");
        const GmshCell cell = cellOf(scanner.text<int>(kElementType), scanner);
        const auto tagCount = scanner.text<std::uint64_t>("a number of tags");
        scanner.need(tagCount, 1, 4, "element tags");
        std::int64_t group = 0;  // the first tag
        for (std::uint64_t i = 0; i < tagCount; ++i)
        {
            const auto tag = scanner.text<std::int64_t>("an element tag");
            if (i == 0) group = tag;
        }
        readElementNodes<std::int32_t>(file, cell, 4, group);
    }
}

void readBinaryElements2(GmshFile& file, std::uint64_t count)
{
    MeshScanner& scanner = file.scanner;
    for (std::uint64_t done = 0; done < count;)
    {
        const GmshCell cell = cellOf(scanner.get<std::int32_t>(kElementType), scanner);
        const auto blockCount = scanner.get<std::uint32_t>("a number of elements");
        const auto tagCount = scanner.get<std::uint32_t>("a number of tags");
        if (blockCount == 0 || blockCount > count - done)
            scanner.fail(message("a block of ", blockCount, " elements where ", count - done, " are left"));
        scanner.need(blockCount, std::uint64_t{1} + tagCount + static_cast<unsigned>(cell.nodes), 4, "elements");
        for (std::uint32_t e = 0; e < blockCount; ++e)
        {
            scanner.skipBytes(4, "an element's number");
            const auto group = tagCount > 0 ? scanner.get<std::int32_t>("an element tag") : 0;
            if (tagCount > 1) scanner.skipBytes(4 * (std::uint64_t{tagCount} - 1), "an element's tags");
            readElementNodes<std::int32_t>(file, cell, 4, group);
        }
        done += blockCount;
    }
}

/// The four numbers at the beginning of a section of version 4.1; the last two are the minimum and the maximum tag.
struct BlockHeader
{
    std::uint64_t blocks, items;
};

BlockHeader readBlockHeader(GmshFile& file, const char* what)
{
    BlockHeader header{};
    header.blocks = file.scanner.get<std::uint64_t>("a number of blocks", file.sizeBytes);
    header.items = file.scanner.get<std::uint64_t>(what, file.sizeBytes);
    file.scanner.get<std::uint64_t>("the least tag", file.sizeBytes);
    file.scanner.get<std::uint64_t>("the largest tag", file.sizeBytes);
    return header;
}

/// The number of items in a block, at most those that remain of the declared total.
std::uint64_t readBlockCount(GmshFile& file, std::uint64_t& left, const char* what)
{
    const auto count = file.scanner.get<std::uint64_t>(what, file.sizeBytes);
    if (count > left) file.scanner.fail(message("a block of ", count, " where ", left, " of the section's are left"));
    left -= count;
    return count;
}

}  // namespace

Vec3 readGmshPosition(MeshScanner& scanner)
{
    Vec3 x;
    for (int i = 0; i < 3; ++i) x[i] = scanner.get<double>("a coordinate");
    return x;
}

int placeOfGmshNode(const GmshFile& file, std::uint64_t tag)
{
    const int place = file.numbers->find(tag);
    if (place < 0) file.scanner.fail(message("a tetrahedron uses node ", tag, ", which $Nodes does not have"));
    return place;
}

void readGmshNodes2(GmshFile& file)
{
    MeshScanner& scanner = file.scanner;
    const std::uint64_t count = readCountLine(scanner, "a number of nodes");
    scanner.need(count, 4, 7, "nodes");  // binary: a tag of 4 bytes and three coordinates of 8
    for (std::uint64_t i = 0; i < count; ++i)
    {
        const auto tag = scanner.get<std::int32_t>(kNodeTag);
        file.mesh.m_nodeNumbers.push_back(static_cast<std::uint64_t>(tag));
        file.mesh.m_positions.push_back(readGmshPosition(scanner));
    }
}

// For each element: number, type, physical and elementary region, count of nodes, nodes.
void readGmshElements1(GmshFile& file)
{
    MeshScanner& scanner = file.scanner;
    const std::uint64_t count = readCountLine(scanner, "a number of elements");
    scanner.need(count, 6, 4, "elements");
    for (std::uint64_t e = 0; e < count; ++e)
    {
        scanner.text<std::int64_t>("an element number");
        GmshCell cell = cellOf(scanner.text<int>(kElementType), scanner);
        const auto region = scanner.text<std::int64_t>("a physical region");
        scanner.text<std::int64_t>("an elementary region");
        const auto nodes = scanner.text<int>("a number of nodes");
        if (nodes < 1 || (cell.kind == CellKind::tet && nodes != cell.nodes))
            scanner.fail(message("an element has ", nodes, " nodes; its type has ", cell.nodes));
        cell.nodes = nodes;
        readElementNodes<std::int32_t>(file, cell, 4, region);
    }
}

void readGmshElements2(GmshFile& file)
{
    const std::uint64_t count = readCountLine(file.scanner, "a number of elements");
    file.scanner.need(count, 4, 1, "elements");
    if (file.scanner.isBinary())
        readBinaryElements2(file, count);
    else
        readTextElements2(file, count);
}

void readGmshNodes4(GmshFile& file)
{
    MeshScanner& scanner = file.scanner;
    const BlockHeader header = readBlockHeader(file, "a number of nodes");
    const auto tagBytes = static_cast<std::uint64_t>(file.sizeBytes);
    scanner.need(header.items, 4, (tagBytes + 24) / 4, "nodes");
    std::uint64_t left = header.items;
    for (std::uint64_t b = 0; b < header.blocks; ++b)
    {
        const auto dimension = scanner.get<std::int32_t>("an entity's dimension");
        scanner.get<std::int32_t>("an entity's tag");
        const auto parametric = scanner.get<std::int32_t>("whether nodes are parametric");
        if (dimension < 0 || dimension > 3 || parametric < 0 || parametric > 1)
            scanner.fail(message("a block of dimension ", dimension, " and parametric ", parametric,
                                 "; these must be in [0, 3] and [0, 1]"));
        const std::uint64_t count = readBlockCount(file, left, "a number of nodes");
        for (std::uint64_t i = 0; i < count; ++i)
            file.mesh.m_nodeNumbers.push_back(scanner.get<std::uint64_t>(kNodeTag, file.sizeBytes));
        for (std::uint64_t i = 0; i < count; ++i)
        {
            file.mesh.m_positions.push_back(readGmshPosition(scanner));
            for (int p = 0; p < parametric * dimension; ++p) scanner.get<double>("a parameter");
        }
    }
    if (left > 0) scanner.fail(message("the blocks have ", left, " nodes fewer than $Nodes declares"));
}

void readGmshEntities4(GmshFile& file)
{
    MeshScanner& scanner = file.scanner;
    std::uint64_t counts[4];  // of points, curves, surfaces and volumes
    for (std::uint64_t& count : counts) count = scanner.get<std::uint64_t>("a number of entities", file.sizeBytes);
    const auto readTags = [&](const char* what)
    {
        const auto count = scanner.get<std::uint64_t>("a number of tags", file.sizeBytes);
        scanner.need(count, 1, 4, what);
        std::int32_t first = 0;
        for (std::uint64_t i = 0; i < count; ++i)
        {
            const auto tag = scanner.get<std::int32_t>(what);
            if (i == 0) first = tag;
        }
        return first;
    };
    for (int dimension = 0; dimension < 4; ++dimension)
    {
        scanner.need(counts[dimension], 5, 4, "entities");
        for (std::uint64_t i = 0; i < counts[dimension]; ++i)
        {
            const auto tag = scanner.get<std::int32_t>("an entity's tag");
            for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) scanner.get<double>("a coordinate of an entity");
            const std::int32_t group = readTags("a physical group");
            if (dimension > 0) readTags("an entity of the boundary");
            if (dimension == 3) file.groups[tag] = group;
        }
    }
}

void readGmshElements4(GmshFile& file)
{
    MeshScanner& scanner = file.scanner;
    const BlockHeader header = readBlockHeader(file, "a number of elements");
    const auto tagBytes = static_cast<std::uint64_t>(file.sizeBytes);
    scanner.need(header.items, 2, tagBytes, "elements");
    std::uint64_t left = header.items;
    for (std::uint64_t b = 0; b < header.blocks; ++b)
    {
        const auto dimension = scanner.get<std::int32_t>("an entity's dimension");
        const auto group = file.groups.find(scanner.get<std::int32_t>("an entity's tag"));
        const std::int32_t region = dimension == 3 && group != file.groups.end() ? group->second : 0;
        const GmshCell cell = cellOf(scanner.get<std::int32_t>(kElementType), scanner);
        const std::uint64_t count = readBlockCount(file, left, "a number of elements");
        for (std::uint64_t e = 0; e < count; ++e)
        {
            scanner.get<std::uint64_t>("an element tag", file.sizeBytes);
            readElementNodes<std::uint64_t>(file, cell, file.sizeBytes, region);
        }
    }
    if (left > 0) scanner.fail(message("the blocks have ", left, " elements fewer than $Elements declares"));
}

}  // namespace bullet_fem
