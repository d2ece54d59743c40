// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/io/tet_mesh_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "io/byte_text.h"
#include "io/temporary_folder.h"
#include "io/tet_fixtures.h"

namespace bullet_fem
{
namespace
{

using testing::AllOf;
using testing::HasSubstr;

TetMeshFile readText(const std::string& bytes, TetMeshFormat format, double scale = 1)
{
    return readTetMesh(bytes.data(), bytes.size(), format, scale);
}

const char* endingOf(TetMeshFormat format)
{
    switch (format)
    {
        case TetMeshFormat::gmsh:
            return "msh";
        case TetMeshFormat::tetgen:
            return "ele";
        case TetMeshFormat::vtk:
            return "vtk";
        case TetMeshFormat::vtu:
            return "vtu";
        case TetMeshFormat::medit:
            return "mesh";
    }
    return "";
}

/// Expects exactly the fixtures' two tetrahedra on their five nodes, bitwise equal.
void expectTheFixture(const TetMeshFile& mesh)
{
    ASSERT_EQ(mesh.m_positions.size(), 5u);
    ASSERT_EQ(mesh.m_nodeNumbers.size(), 5u);
    const int kept[] = {0, 1, 2, 4, 5};
    for (int i = 0; i < 5; ++i) EXPECT_EQ(norm(mesh.m_positions[i] - fixtureNodes()[kept[i]]), 0) << "node " << i;
    EXPECT_EQ(mesh.m_tets, (std::vector<Tet>{{0, 1, 2, 3}, {1, 2, 3, 4}}));
}

class TetFixtureTest : public testing::TestWithParam<TetFixture>
{
};

TEST_P(TetFixtureTest, IsTheSameMesh)
{
    const TetMeshFile mesh = readText(GetParam().bytes, GetParam().format);
    expectTheFixture(mesh);
    EXPECT_GE(mesh.m_unusedNodes, 1u);  // more, if components have nodes of their own
    EXPECT_EQ(mesh.m_skippedFaces, GetParam().faces);
    EXPECT_EQ(mesh.m_skippedEdges, GetParam().edges);
    EXPECT_EQ(mesh.m_skippedPoints, GetParam().points);
    EXPECT_EQ(mesh.m_version, GetParam().version);
    EXPECT_DOUBLE_EQ(mesh.mesh().volume(), 1. / 6 + 1.25 / 3 - 1. / 24);
}

TEST_P(TetFixtureTest, IsReadFromAFile)
{
    const TemporaryFolder folder;
    std::string bytes = GetParam().bytes;
    const std::size_t nodesEnd = bytes.find("2 4 ");  // the start of TetGen's second file
    if (GetParam().format == TetMeshFormat::tetgen)
    {
        folder.write("mesh.node", bytes.substr(0, nodesEnd));
        bytes = bytes.substr(nodesEnd);
    }
    expectTheFixture(readTetMeshFile(folder.write(std::string("mesh.") + endingOf(GetParam().format), bytes)));
}

INSTANTIATE_TEST_SUITE_P(Formats, TetFixtureTest, testing::ValuesIn(tetFixtures()),
                         [](const auto& fixture) { return fixture.param.name; });

TEST(TetMeshFile, ReportsTheNodeNumbersOfTheFile)
{
    EXPECT_EQ(readText(gmsh4Text(), TetMeshFormat::gmsh).m_nodeNumbers,
              (std::vector<std::uint64_t>{7, 1000000000000000000u, 3, 5, 9223372036854775817u}));
    EXPECT_EQ(readText(tetGenText(1), TetMeshFormat::tetgen).m_nodeNumbers,
              (std::vector<std::uint64_t>{1, 2, 3, 5, 6}));
    EXPECT_EQ(readText(vtkText("5.1"), TetMeshFormat::vtk).m_nodeNumbers, (std::vector<std::uint64_t>{0, 1, 2, 4, 5}));
    EXPECT_EQ(readText(meditText(2), TetMeshFormat::medit).m_nodeNumbers, (std::vector<std::uint64_t>{1, 2, 3, 5, 6}));
    EXPECT_EQ(readText(vtuText(), TetMeshFormat::vtu).m_unusedNodes, 1u);
}

// As in some of Bullet's own files.
TEST(TetMeshFile, TakesVtkFilesWithoutTheBlankOfTheirFirstLine)
{
    const std::string text =
        "#vtk DataFile Version 2.0\none\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n0 0 0 1 0 0 0 1 0 0 0 1\n"
        "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n";
    EXPECT_EQ(readTetMesh(text.data(), text.size(), TetMeshFormat::vtk).mesh().tetCount(), 1);
    EXPECT_THROW(readTetMesh(text.data() + 1, text.size() - 1, TetMeshFormat::vtk), std::runtime_error);
}

TEST(TetMeshFile, ScaleMultipliesPositions)
{
    const TetMeshFile mesh = readText(meditText(2), TetMeshFormat::medit, 0.001);
    EXPECT_DOUBLE_EQ(mesh.m_positions[4].z, 0.00125);
    EXPECT_DOUBLE_EQ(mesh.mesh().volume() * 1e9, readText(meditText(2), TetMeshFormat::medit).mesh().volume());
}

TEST(TetMeshFile, RejectsInvalidScale)
{
    for (const double scale : {0., -1., std::nan(""), HUGE_VAL})
    {
        EXPECT_THAT(messageOf<std::invalid_argument>([&] { readTetMeshFile("box.msh", scale); }),
                    AllOf(HasSubstr("scale is"), HasSubstr("positive and finite")));
        EXPECT_THROW(readText(vtuText(), TetMeshFormat::vtu, scale), std::invalid_argument);
    }
}

TEST(TetMeshFile, RejectsScaleThatOverflows)
{
    std::string text = meditText(2);
    text.replace(text.find("1.25"), 4, "1e30");
    EXPECT_THAT(messageOf<std::runtime_error>([&] { readText(text, TetMeshFormat::medit, 1e300); }),
                AllOf(HasSubstr("node 6"), HasSubstr("not finite once scaled")));
}

TEST(TetMeshFile, NodeAndEleFilesLoadEachOther)
{
    const TemporaryFolder folder;
    const std::string text = tetGenText(1), nodes = text.substr(0, text.find("2 4 0")),
                      elements = text.substr(text.find("2 4 0"));
    const std::string node = folder.write("a.1.node", nodes), ele = folder.write("a.1.ele", elements);
    expectTheFixture(readTetMeshFile(node));
    expectTheFixture(readTetMeshFile(ele, 1));
    folder.write("b.node", nodes);
    EXPECT_THAT(messageOf<std::runtime_error>([&] { readTetMeshFile(folder.path("b.node")); }),
                AllOf(HasSubstr(folder.path("b.ele")), HasSubstr("no such file")));
    folder.write("b.ele", "1 4 0\n1 1 2 3 x\n");
    EXPECT_THAT(messageOf<std::runtime_error>([&] { readTetMeshFile(folder.path("b.node")); }),
                AllOf(HasSubstr(folder.path("b.ele")), HasSubstr("line 2: 'x' is not a point's number")));
    folder.write("b.node", "6 3 0 0\n1 0 0 y\n2 0 0 0\n3 0 0 0\n4 0 0 0\n5 0 0 0\n6 0 0 0\n");
    EXPECT_THAT(messageOf<std::runtime_error>([&] { readTetMeshFile(folder.path("b.ele")); }),
                AllOf(HasSubstr(folder.path("b.node")), HasSubstr("line 2: 'y' is not a coordinate")));
}

TEST(TetMeshFile, RejectsMissingFilesFoldersAndEndings)
{
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder.path("folder.vtk"));
    EXPECT_THAT(messageOf<std::runtime_error>([&] { readTetMeshFile(folder.path("no.msh")); }),
                AllOf(HasSubstr(folder.path("no.msh")), HasSubstr("no such file")));
    EXPECT_THAT(messageOf<std::runtime_error>([&] { readTetMeshFile(folder.path("folder.vtk")); }),
                HasSubstr("directory or device"));
    EXPECT_THAT(messageOf<std::runtime_error>([&] { readTetMeshFile("box.stl"); }),
                AllOf(HasSubstr("'box.stl'"), HasSubstr("'.stl' is not known; it must be .msh, .node, .ele, .vtk,")));
}

TEST(TetMeshFile, MeshRejectsInvalidElements)
{
    std::string text = tetGenText(0);
    text.replace(text.find("0 0 1 2 4"), 9, "0 0 1 2 2");
    const TetMeshFile mesh = readText(text, TetMeshFormat::tetgen);
    EXPECT_THAT(messageOf<std::invalid_argument>([&] { mesh.mesh(); }), HasSubstr("twice"));
}

/// A fixture with the first occurrence of a text replaced; empty if there is none.
std::string replaced(std::string bytes, const std::string& what, const std::string& by)
{
    const std::size_t at = bytes.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return at == std::string::npos ? bytes : bytes.replace(at, what.size(), by);
}

struct BadMesh
{
    const char* test;
    TetMeshFormat format;
    std::string bytes;
    const char* cause;
};
std::ostream& operator<<(std::ostream& out, const BadMesh& file)
{
    return out << file.test;
}

class BadMeshTest : public testing::TestWithParam<BadMesh>
{
};

TEST_P(BadMeshTest, IsRejectedWithPlaceAndCause)
{
    EXPECT_THAT(messageOf<std::runtime_error>([] { readText(GetParam().bytes, GetParam().format); }),
                HasSubstr(GetParam().cause));
}

BadMesh badGmsh(const char* test, const std::string& what, const std::string& by, const char* cause)
{
    return {test, TetMeshFormat::gmsh, replaced(gmsh4Text(), what, by), cause};
}
BadMesh badGmsh2(const char* test, const std::string& what, const std::string& by, const char* cause)
{
    return {test, TetMeshFormat::gmsh, replaced(gmsh2Text("2.2"), what, by), cause};
}
BadMesh badVtk(const char* test, const std::string& what, const std::string& by, const char* cause)
{
    return {test, TetMeshFormat::vtk, replaced(vtkText("2.0"), what, by), cause};
}
BadMesh badVtk5(const char* test, const std::string& what, const std::string& by, const char* cause)
{
    return {test, TetMeshFormat::vtk, replaced(vtkText("5.1"), what, by), cause};
}
BadMesh badVtu(const char* test, const std::string& what, const std::string& by, const char* cause)
{
    return {test, TetMeshFormat::vtu, replaced(vtuText(), what, by), cause};
}
BadMesh badInline(const char* test, const VtuLayout& layout, const std::string& what, const std::string& by,
                  const char* cause)
{
    return {test, TetMeshFormat::vtu, replaced(vtuBinary(layout), what, by), cause};
}
BadMesh badTetGen(const char* test, const std::string& what, const std::string& by, const char* cause)
{
    return {test, TetMeshFormat::tetgen, replaced(tetGenText(1), what, by), cause};
}
BadMesh badMedit(const char* test, const std::string& what, const std::string& by, const char* cause)
{
    return {test, TetMeshFormat::medit, replaced(meditText(2), what, by), cause};
}
const auto kTestName = [](const auto& bad) { return std::string(bad.param.test); };

std::string gmshByteOrder(std::int32_t one)
{
    ByteText file;
    file << "$MeshFormat\n4.1 1 8\n";
    file.raw(one) << "\n$EndMeshFormat\n";
    return file.bytes();
}

INSTANTIATE_TEST_SUITE_P(
    Gmsh, BadMeshTest,
    testing::Values(
        BadMesh{"Empty", TetMeshFormat::gmsh, "", "line 1: the file has no section $Nodes"},
        BadMesh{"OtherFile", TetMeshFormat::gmsh, "solid box\n",
                "line 1: 'solid' stands where a section such as $Mesh"},
        BadMesh{"ByteOrder", TetMeshFormat::gmsh, gmshByteOrder(2), "byte 20: the number that tells the byte order"},
        BadMesh{"Version1WithoutElements", TetMeshFormat::gmsh, "$NOD\n1\n1 0 0 0\n$ENDNOD\n", "it has no tetrahedra"},
        BadMesh{"Terminal", TetMeshFormat::gmsh, std::string("\033[2J\0\n", 6),
                "byte 0: it is a binary file, and of no format"},
        badGmsh(
            "Version40", "4.1 0 8", "4.0 0 8",
            "line 5: MSH version 4.0 cannot be read, only 1 ($NOD), 2.0 to 2.2 and 4.1; convert it: gmsh OLD.msh -save "
            "-format msh41 -o NEW.msh"),
        badGmsh("FileType", "4.1 0 8", "4.1 2 8", "the file type is 2; it must be 0 (text) or 1 (binary)"),
        badGmsh("DataSize", "4.1 0 8", "4.1 0 5", "line 5: the data size is 5; it must be 8 or 4"),
        badGmsh("NoEnd", "$EndEntities", "$EndEntity", "line 7: the section $Entities has no end"),
        badGmsh("EndOfNodes", "$EndNodes", "$EndNode", "line 27: '$EndNode' stands where $EndNodes should be"),
        badGmsh("HugeCount", "3 6 3 92", "3 9000000000000000000 3 92", "it declares 9000000000000000000 nodes, but"),
        badGmsh("HugeBlocks", "3 6 3 92", "18446744073709551615 6 3 92", "is not an entity's dimension"),
        badGmsh("HugeBlock", "2 1 0 4\n", "2 1 0 4000000000\n", "a block of 4000000000 where 6 of the section's"),
        badGmsh("ShortBlocks", "3 6 3 92", "3 7 3 92", "the blocks have 1 nodes fewer than $Nodes declares"),
        badGmsh("Dimension", "2 1 0 4\n", "7 1 0 4\n", "a block of dimension 7 and parametric 0"),
        badGmsh("TwiceSparse", "\n12\n", "\n1000000000000000000\n", "two have the number 1000000000000000000"),
        badGmsh("Coordinate", "5 5 5\n", "5 5 five\n", "line 20: 'five' is not a coordinate"),
        badGmsh("NegativeTag", "\n12\n", "\n-12\n", "line 16: '-12' is not a node tag"),
        badGmsh("NotFinite", "0 0 0\n1 0 0", "0 nan 0\n1 0 0", "node 7 has the position (0, nan, 0), which is not"),
        badGmsh("NotFiniteText", "0 0 0\n1 0 0", "0 1e999 0\n1 0 0", "line 17: '1e999' is not a coordinate"),
        badGmsh("UnknownNode", "4 7 1", "4 8 1", "line 37: a tetrahedron uses node 8, which $Nodes does not have"),
        badGmsh("Hexahedron", "3 1 4 2", "3 1 5 2",
                "line 36: a hexahedron, Gmsh's element type 5, cannot be read: of volume cells only tetrahedra"),
        badGmsh("SecondOrder", "3 1 4 2", "3 1 11 2", "a tetrahedron of second order (10 nodes), Gmsh's"),
        badGmsh("Type", "3 1 4 2", "3 1 77 2", "Gmsh's element type 77 cannot be read"),
        badGmsh("HugeElements", "4 5 1 5", "4 5000000000 1 5", "declares 5000000000 elements"),
        badGmsh("ElementsFirst", "$Nodes\n3 6", "$Elements\n3 6", "$Elements stands before $Nodes"),
        badGmsh("OnlyTriangles", "4 5 1 5\n", "3 3 1 5\n", "'3' stands where $EndElements should be"),
        badGmsh2("Elements2", "5 4 2 0", "5 17 2 0", "line 23: a hexahedron of second order (20 nodes)"),
        badGmsh2("Twice2", "\n12 ", "\n7 ", "line 15: of the nodes up to here two have the number 7"),
        badGmsh2("HugeCount2", "$Nodes\n6", "$Nodes\n6000000000", "line 9: it declares 6000000000 nodes"),
        badGmsh2("HugeTags2", "4 4 2 0 1", "4 4 2000000000 0 1", "it declares 2000000000 element tags"),
        badGmsh2("CutShort2", "6 1 1 +1.25\n$EndNodes\n$Elements\n", "6 1",
                 "line 16: '2' stands where $EndNodes should be")),
    kTestName);

INSTANTIATE_TEST_SUITE_P(
    TetGen, BadMeshTest,
    testing::Values(
        BadMesh{"Empty", TetMeshFormat::tetgen, "# nothing\n", "line 2: the file ends where the number of points"},
        badTetGen("Dimension", "6 3 0", "6 2 0", "line 1: the dimension is 2; it must be 3"),
        badTetGen("HugeCount", "6 3 0", "600000 3 0", "line 1: it declares 600000 points"),
        badTetGen("TooFewCoordinates", "4 5 5 5", "4 5 5", "line 5: '' is not a coordinate"),
        badTetGen("Twice", "4 5 5 5", "3 5 5 5", "two have the number 3"),
        badTetGen("SecondOrder", "2 4 0", "2 10 0",
                  "with 10 nodes cannot be read, only those with 4; run TetGen without"),
        badTetGen("HugeTets", "2 4 0", "2000000 4 0", "line 8: it declares 2000000 tetrahedra"),
        badTetGen("UnknownPoint", "2 2 3 5 6", "2 2 3 5 7",
                  "line 10: a tetrahedron uses point 7, which the .node file"),
        badTetGen("CutShort", "\n2 2 3 5 6", "# this is cut\n", "line 11: the file ends where a tetrahedron should be"),
        badTetGen("NoTets", "2 4 0", "0 4 0", "it has no tetrahedra")),
    kTestName);

INSTANTIATE_TEST_SUITE_P(
    Vtk, BadMeshTest,
    testing::Values(
        BadMesh{"Empty", TetMeshFormat::vtk, "", "line 1: a VTK file begins with '# vtk DataFile Version'"},
        badVtk("Version", "2.0", "6.0", "line 1: the version is 6.0; it must be in [1.0, 5.1]"),
        badVtk("Encoding", "ASCII", "UTF8", "line 3: the encoding must be ASCII or BINARY"),
        badVtk("Dataset", "UNSTRUCTURED_GRID", "POLYDATA", "line 4: the dataset is 'POLYDATA'"),
        badVtk("Section", "CELLS", "VERTICES", "line 12: 'VERTICES' stands where a section such as POINTS"),
        badVtk("Type", "double", "quad", "line 5: 'quad' is not a VTK number type"),
        badVtk("HugePoints", "POINTS 6", "POINTS 6148914691236517206", "declares 6148914691236517206 points"),
        badVtk("HugeCells", "CELLS 5 19", "CELLS 4000000000 19", "line 17: of 4000000000 CELLS only 5 are there"),
        badVtk("NegativeCells", "CELLS 5 19", "CELLS -5 19", "line 12: '-5' is not a number of cells"),
        badVtk("NoCells", "CELLS 5 19", "CELLS 0 19",
               "line 12: CELLS of 0 cells have 0 numbers, not 19, and more follow"),
        badVtk("CellCount", "CELLS 5 19", "CELLS 6 19", "line 17: of 6 CELLS only 5 are there"),
        badVtk("CellCountTooSmall", "CELLS 5 19", "CELLS 4 19", "line 16: CELLS of 4 cells have 14 numbers, not 19"),
        badVtk("CellRow", "\n4 0 1 2 4", "\n9999 0 1 2 4", "line 16: cell 3 has 9999 corners where"),
        badVtk("NegativeRow", "\n4 0 1 2 4", "\n-4 0 1 2 4", "line 16: cell 3 has -4 corners"),
        badVtk("Index", "4 1 2 4 5", "4 1 2 4 6", "cell 4 uses point 6, which is not in [0, 6)"),
        badVtk("NegativeIndex", "4 1 2 4 5", "4 1 2 4 -1", "cell 4 uses point -1, which is not in [0, 6)"),
        badVtk("Hexahedron", "\n10\n10", "\n10\n12", "line 12: of CELLS, cell 4: a hexahedron, VTK"),
        badVtk("SecondOrder", "\n10\n10", "\n10\n24", "a quadratic tetrahedron (10 nodes), VTK's cell type 24,"),
        badVtk("UnknownType", "\n10\n10", "\n10\n99", "VTK's cell type 99 cannot be read"),
        badVtk("Corners", "\n5\n10\n10", "\n10\n10\n10", "cell 2 is a tetrahedron with 3 corners"),
        badVtk("TypeCount", "\n10\n10\n", "\n10\n", "line 19: CELL_TYPES lists 4 types for 5 cells; list the type of"),
        badVtk("TypeCountTooLarge", "\n10\n10\n", "\n10\n10\n10\n", "lists 6 types for 5 cells; list the type of"),
        badVtk("NoTypes", "CELL_TYPES 5\n1\n3\n5\n10\n10\n", "",
               "line 12: behind CELLS the file has no section CELL_TYPES; list the type of each, 10 for a tetrahedron"),
        badVtk("TwoPoints", "CELLS 5 19", "POINTS 0 float\nCELLS 5 19", "there is a second section POINTS"),
        badVtk5("Offset0", "0 1 3 6 10 14", "1 1 3 6 10 14", "the first of the OFFSETS is 1, not 0"),
        badVtk5("OffsetsFall", "0 1 3 6 10 14", "0 1 3 2 10 14",
                "the corners of cell 2 end at 2, which is not in [3, 14]"),
        badVtk5("OffsetsTooFar", "0 1 3 6 10 14", "0 1 3 6 10 15", "end at 15, which is not in [10, 14]"),
        badVtk5("Floating", "OFFSETS vtktypeint64", "OFFSETS float", "the type of OFFSETS is not an integer"),
        badVtk5("NoConnectivity", "CONNECTIVITY", "CONNECTED", "line 15: here CONNECTIVITY should be"),
        badVtk5("Field", "POINTS 6", "FIELD f 1\na 4000000000 4000000000 int\nPOINTS 6",
                "an array of 4000000000 x 4000000000 values"),
        badVtk5("NotFinite", "0 0 0\n", "0 0 -inf\n", "node 0 has the position (0, 0, -inf), which is not finite")),
    kTestName);

INSTANTIATE_TEST_SUITE_P(
    Vtu, BadMeshTest,
    testing::Values(
        BadMesh{"Empty", TetMeshFormat::vtu, "", "this is not XML (XML_ERROR_EMPTY_DOCUMENT)"},
        BadMesh{"OtherXml", TetMeshFormat::vtu, "<svg/>", "line 1: the file has no <VTKFile>"},
        badVtu("Xml", "</Points>", "</Point>", "line 4: this is not XML (XML_ERROR_MISMATCHED_ELEMENT)"),
        badVtu("Kind", "\"UnstructuredGrid\"", "\"PolyData\"", "line 1: the type is 'PolyData'"),
        badVtu("Order", "LittleEndian", "MiddleEndian", "line 1: byte_order is 'MiddleEndian'"),
        badVtu("HeaderType", "byte_order", "header_type=\"UInt16\" byte_order", "header_type is 'UInt16'"),
        badVtu("Compressor", "byte_order", "compressor=\"vtkLZ4DataCompressor\" byte_order",
               "the compressor 'vtkLZ4DataCompressor' is not known; save with zlib or without"),
        badVtu("HugePoints", "Points=\"6\"", "Points=\"6000000000\"", "line 5: 18 coordinates for 6000000000 points"),
        badVtu("PointCount", "Points=\"6\"", "Points=\"x\"", "line 3: 'x' is not NumberOfPoints"),
        badVtu("HugeCells", "Cells=\"5\"", "Cells=\"5000000000\"", "line 9: 5 offsets for 5000000000 cells"),
        badVtu("Components", "Components=\"3\"", "Components=\"2\"", "points have 2 components, not 3"),
        badVtu("Coordinate", "1.25", "one", "line 5: DataArray 'Points': 'one' is not a number"),
        badVtu("Type", "Float64", "Float16", "line 5: DataArray 'Points': its type 'Float16' is not one of"),
        badVtu("Floating", "\"Int64\"", "\"Float64\"", "line 10: DataArray 'connectivity': its type is not an integer"),
        badVtu("Format", "\"ascii\"", "\"utf8\"", "its format 'utf8' is not ascii, binary or appended"),
        badVtu("NoTypes", "\"types\"", "\"kinds\"", "line 9: <Cells> has no DataArray 'types'"),
        badVtu("TypeCount", "5 10 10", "5 10", "line 9: there are 4 cell types for 5 cells"),
        badVtu("Index", "1 2 4 5<", "1 2 4 6<", "line 9: cell 4 uses point 6, which is not in [0, 6)"),
        badVtu("Pyramid", "10 10", "10 14", "cell 4: a pyramid, VTK's cell type 14, cannot be read"),
        badVtu("Appended", "format=\"ascii\"", "format=\"appended\" offset=\"7\"",
               "its offset is 7, but AppendedData has 0 bytes"),
        badInline("Base64", {}, "\n  ", "\n  ?", "line 6: DataArray '': byte 63 is not base64"),
        badInline("Base64Short", {}, "kAAAAA", "oAAAAA", "160 bytes should follow where"),
        badInline("Count", {}, "\n  k", "\n  _", "byte 95 is not base64"),
        badInline("NoUnderscore", {"raw"}, "\n  _", "\n  ", "AppendedData must begin with an underscore"),
        badInline("NoEnd", {"raw"}, "</AppendedData>", "", "<AppendedData> has no end"),
        badInline("AppendedKind", {"raw"}, "encoding=\"raw\"", "encoding=\"hex\"", "encoding of AppendedData is 'hex'"),
        badInline("Offset", {"raw"}, "offset=\"0\"", "offset=\"99999\"", "its offset is 99999, but AppendedData has"),
        badInline("NotZlib", {"raw", false, 4, 64}, "x\x9c", "x\x9d", "a zlib block does not decompress to 64 bytes")),
    kTestName);

INSTANTIATE_TEST_SUITE_P(
    Medit, BadMeshTest,
    testing::Values(
        BadMesh{"Empty", TetMeshFormat::medit, "", "line 1: a Medit file begins with MeshVersionFormatted"},
        BadMesh{"Binary", TetMeshFormat::medit, std::string("\1\0\0\0\2\0\0\0", 8), "save it as text (.mesh)"},
        badMedit("Version", "Formatted 2", "Formatted 9", "line 1: the version is 9; it must be in [1, 4]"),
        badMedit("Dimension", "Dimension 3", "Dimension 2", "line 2: the dimension is 2; it must be 3"),
        badMedit("HugeCount", "Vertices\n6", "Vertices\n6000000000000000000",
                 "line 4: it declares 6000000000000000000"),
        badMedit("Number", "5 5 5 0", "5 5 five 0", "line 8: 'five' is not a coordinate"),
        badMedit("Count", "Vertices\n6", "Vertices\n5", "line 10: '1' stands where a keyword such as Vertices"),
        badMedit("Index", "2 3 5 6 0", "2 3 5 7 0", "line 22: a tetrahedron uses vertex 7, which is not in [1, 6]"),
        badMedit("Index0", "1 2 3 5 0", "0 2 3 5 0", "line 21: a tetrahedron uses vertex 0, which is not in [1, 6]"),
        badMedit("HugeTets", "hedra\n2", "hedra\n200", "it declares 200 tetrahedra"),
        badMedit("Hexahedra", "Hexahedra\n0", "Hexahedra\n1",
                 "line 18: a cell of the section Hexahedra cannot be read"),
        badMedit("SecondOrder", "Tetrahedra\n2", "TetrahedraP2\n2", "a cell of the section TetrahedraP2 cannot be"),
        badMedit("HugeEdges", "Edges\n1", "Edges\n1000000", "line 12: it declares 1000000 cells"),
        badMedit("TwoVertices", "Edges\n1", "Vertices\n1", "there is a second section Vertices"),
        badMedit("NoTets", "Tetrahedra\n2", "Required\n2", "it has no tetrahedra (but 1 faces, 1 edges and 0 points)")),
    kTestName);

}  // namespace
}  // namespace bullet_fem
