// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors

// Variants of mesh files by other programs: with tolerated faults, with other line endings, and files that are no
// meshes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bullet_fem/io/surface_file.h"
#include "bullet_fem/io/tet_mesh_file.h"
#include "io/temporary_folder.h"
#include "io/tet_fixtures.h"

namespace bullet_fem
{
namespace
{

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

TetMeshFile readAs(TetMeshFormat format, const std::string& bytes)
{
    return readTetMesh(bytes.data(), bytes.size(), format);
}

/// Replaces all occurrences of a text.
std::string withEach(std::string bytes, const std::string& what, const std::string& by)
{
    for (std::size_t at = 0; (at = bytes.find(what, at)) != std::string::npos; at += by.size())
        bytes.replace(at, what.size(), by);
    return bytes;
}

/// A .vtk file with the unit tetrahedron and its mirror image below; CELLS and the text after it are given.
std::string twoTets(const std::string& cells, const std::string& types)
{
    return "# vtk DataFile Version 2.0\ntwo\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n0 0 0\n1 0 0\n0 1 0\n"
           "0 0 1\n0 0 -1\n\n" +
           cells + "\n" + types;
}

constexpr const char* kRows = "\n4 0 1 2 3\n4 0 2 1 4\n";
const std::vector<Tet> kTwoTets = {{0, 1, 2, 3}, {0, 2, 1, 4}};

std::vector<std::string> notesOf(const std::string& bytes)
{
    const TetMeshFile file = readAs(TetMeshFormat::vtk, bytes);
    EXPECT_EQ(file.m_tets, kTwoTets);
    return file.m_notes;
}

TEST(VtkCells, AreReadOneByOneIfTheirSizeIsWrong)
{
    const std::string types = "CELL_TYPES 2\n10\n10\n";
    EXPECT_THAT(notesOf(twoTets("CELLS 2 10" + std::string(kRows), types)), ElementsAre());
    for (const char* size : {"8", "2", "0", "-1", "4000000000"})
        EXPECT_THAT(notesOf(twoTets("CELLS 2 " + std::string(size) + kRows, types)),
                    ElementsAre("line 12: CELLS should state 10 numbers for 2 cells, not " + std::string(size) +
                                "; read cell by cell"));
    EXPECT_THAT(notesOf(twoTets("CELLS 2" + std::string(kRows), types)), ElementsAre(HasSubstr("not 0;")));
}

TEST(VtkCells, DefaultToTetrahedraIfAllHaveFourCorners)
{
    const std::string cells = "CELLS 2 10" + std::string(kRows);
    for (const char* types : {"CELL_TYPES 10\n", "CELL_TYPES 1\n10", "CELL_TYPES 0", "cell_types 2 10"})
        EXPECT_THAT(notesOf(twoTets(cells, types)),
                    ElementsAre(AllOf(HasSubstr("line 16: CELL_TYPES lists "), HasSubstr(" types for 2 cells; all"))));
    EXPECT_THAT(notesOf(twoTets(cells, "")), ElementsAre(HasSubstr("no section CELL_TYPES; all cells have four")));
    EXPECT_THAT(notesOf(twoTets(cells, "CELL_TYPES 7\n10\n10\n")),
                ElementsAre(HasSubstr("2 types for 2 cells, but states 7")));
}

// Without types a quadrilateral and a tetrahedron are not distinguished.
TEST(VtkCells, AreRejectedIfTypesAreAmbiguous)
{
    const auto why = [](const std::string& bytes)
    { return messageOf<std::runtime_error>([&] { readAs(TetMeshFormat::vtk, bytes); }); };
    EXPECT_THAT(why(twoTets("CELLS 2 9\n4 0 1 2 3\n3 0 2 1\n", "CELL_TYPES 10\n")), HasSubstr("list the type of each"));
    EXPECT_THAT(why(twoTets("CELLS 2 10" + std::string(kRows), "CELL_TYPES 2\n9\n")),
                HasSubstr("list the type of each"));
}

TEST(VtkCells, FacesAndTetrahedraAreDistinguishedByType)
{
    const TetMeshFile file =
        readAs(TetMeshFormat::vtk,
               twoTets("CELLS 4 999\n4 0 1 2 3\n3 0 1 2\n4 0 2 1 4\n4 0 1 2 3\n", "CELL_TYPES 4\n10\n5\n10\n9\n"));
    EXPECT_EQ(file.m_tets, kTwoTets);
    EXPECT_EQ(file.m_skippedFaces, 2u);
    EXPECT_THAT(file.m_notes, ElementsAre(HasSubstr("CELLS should state 19 numbers for 4 cells, not 999")));
}

TEST(VtkCells, BinaryCellsAreReadOneByOneToo)
{
    std::string bytes = twoTets("", "");
    bytes.replace(bytes.find("ASCII"), 5, "BINARY");
    bytes.replace(bytes.find("double\n") + 7, std::string::npos, "");
    const auto number = [&](std::uint64_t bits, int size)
    {
        while (size-- > 0) bytes += static_cast<char>(bits >> 8 * size & 0xff);
    };
    constexpr std::uint64_t one = 0x3ff0000000000000, minusOne = 0xbff0000000000000;
    for (const std::uint64_t x : {0ul, 0ul, 0ul, one, 0ul, 0ul, 0ul, one, 0ul, 0ul, 0ul, one, 0ul, 0ul, minusOne})
        number(x, 8);
    const std::string head = bytes;
    const auto cells = [&](const char* counts)
    {
        bytes = head + counts;
        for (const int i : {4, 0, 1, 2, 3, 4, 0, 2, 1, 4}) number(static_cast<std::uint64_t>(i), 4);
        bytes += "\nCELL_TYPES 2\n";
        number(10, 4), number(10, 4);
        return bytes;
    };
    EXPECT_THAT(notesOf(cells("\nCELLS 2 10\n")), ElementsAre());
    EXPECT_THAT(notesOf(cells("\nCELLS 2 8\n")), ElementsAre(HasSubstr("should state 10 numbers for 2 cells, not 8")));
    EXPECT_THAT(messageOf<std::runtime_error>([&] { readAs(TetMeshFormat::vtk, cells("\nCELLS 1 10\n")); }),
                HasSubstr("CELLS of 1 cells have 5 numbers, not 10, and more follow"));
}

TEST(GmshVersion1, HasRegionsAndSkipsFacesWithAnyNumberOfNodes)
{
    const std::string file =
        "$NOD\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 0 0 -1\n$ENDNOD\n$ELM\n4\n1 9 3 1 6 1 2 3 1 2 3\n"
        "2 4 8 1 4 1 2 3 4\n3 3 3 1 4 1 2 3 4\n4 4 9 2 4 1 3 2 5\n$ENDELM\n";
    for (const std::string& bytes : {file, withEach(file, "\n", " \r\n")})
    {
        const TetMeshFile mesh = readAs(TetMeshFormat::gmsh, bytes);
        EXPECT_EQ(mesh.m_tets, kTwoTets);
        EXPECT_THAT(mesh.m_regions, ElementsAre(8, 9));
        EXPECT_EQ(mesh.m_skippedFaces, 2u);
        EXPECT_THAT(mesh.m_nodeNumbers, ElementsAre(1u, 2u, 3u, 4u, 5u));
    }
    const auto why = [&](const std::string& what, const std::string& by)
    { return messageOf<std::runtime_error>([&] { readAs(TetMeshFormat::gmsh, withEach(file, what, by)); }); };
    EXPECT_THAT(why("2 4 8 1 4 ", "2 5 8 1 8 "),
                HasSubstr("line 12: a hexahedron, Gmsh's element type 5, cannot be read"));
    EXPECT_THAT(why("2 4 8 1 4 ", "2 11 8 1 10 "), HasSubstr("a tetrahedron of second order (10 nodes)"));
    EXPECT_THAT(why("2 4 8 1 4 ", "2 4 8 1 3 "), HasSubstr("line 12: an element has 3 nodes; its type has 4"));
    EXPECT_THAT(why("1 9 3 1 6 ", "1 9 3 1 -6 "), HasSubstr("line 11: an element has -6 nodes"));
    EXPECT_THAT(why("1 3 2 5", "1 3 2 6"), HasSubstr("line 14: a tetrahedron uses node 6"));
    EXPECT_THAT(why("$ENDELM", "$EndElements"), HasSubstr("'$EndElements' stands where $ENDELM should be"));
    EXPECT_THAT(why("$NOD", "$NODES"), HasSubstr("'$NODES' stands where a section such as $MeshFormat"));
    EXPECT_THAT(messageOf<std::runtime_error>([] { readAs(TetMeshFormat::gmsh, "$ELM\n0\n$ENDELM\n"); }),
                HasSubstr("$ELM stands before $NOD"));
}

class MeshUnderAnotherEnding : public testing::TestWithParam<TetFixture>
{
};

TEST_P(MeshUnderAnotherEnding, IsKnownByItsFirstBytes)
{
    const TemporaryFolder folder;
    const TetMeshFile wanted = readAs(GetParam().format, GetParam().bytes);
    for (const char* name : {"mesh.msh", "mesh.vtk", "mesh.vtu", "mesh.mesh"})
        for (const char* before : {"", "\xEF\xBB\xBF"})
        {
            const TetMeshFile read = readTetMeshFile(folder.write(name, before + GetParam().bytes));
            EXPECT_EQ(read.m_format, wanted.m_format) << name;
            EXPECT_EQ(read.m_tets, wanted.m_tets) << name;
        }
}

std::vector<TetFixture> fixturesThatSayWhatTheyAre()
{
    std::vector<TetFixture> fixtures;
    for (TetFixture& fixture : tetFixtures())
        if (fixture.format != TetMeshFormat::tetgen) fixtures.push_back(std::move(fixture));
    return fixtures;
}

INSTANTIATE_TEST_SUITE_P(Formats, MeshUnderAnotherEnding, testing::ValuesIn(fixturesThatSayWhatTheyAre()),
                         [](const auto& fixture) { return fixture.param.name; });

struct ForeignFile
{
    const char* test;
    std::string bytes;
    const char* told;
};
std::ostream& operator<<(std::ostream& out, const ForeignFile& file)
{
    return out << file.test;
}

class ForeignFileTest : public testing::TestWithParam<ForeignFile>
{
};

TEST_P(ForeignFileTest, IsNamedInWordsUnderEveryEnding)
{
    const TemporaryFolder folder;
    const std::string bytes = GetParam().bytes + std::string(600, '\xfe');
    const auto named = AllOf(HasSubstr("byte "), HasSubstr(GetParam().told), HasSubstr("; "), Not(HasSubstr("??")));
    folder.write("a.ele", "1 4 0\n0 0 1 2 3\n");
    for (const char* name : {"a.msh", "a.node", "a.vtk", "a.vtu", "a.mesh", "a.meshb"})
        EXPECT_THAT(messageOf<std::runtime_error>([&] { readTetMeshFile(folder.write(name, bytes)); }),
                    AllOf(HasSubstr(name), named));
    for (const char* name : {"a.off", "a.ply", "a.obj"})
        EXPECT_THAT(messageOf<std::runtime_error>([&] { readSurfaceFile(folder.write(name, bytes)); }),
                    AllOf(HasSubstr(name), named));
}

using namespace std::string_literals;
INSTANTIATE_TEST_SUITE_P(
    Kinds, ForeignFileTest,
    testing::Values(
        ForeignFile{"Gzip", "\x1f\x8b\x08\0"s, "it is a gzip archive, which is not read; unpack it first"},
        ForeignFile{"Zip", "PK\3\4"s, "it is a ZIP archive"},
        ForeignFile{"Hdf5", "\x89HDF\r\n\x1a\n"s, "it is an HDF5 file, such as MED, XDMF or CGNS, which is not"},
        ForeignFile{"Utf16", "\xff\xfe$\0M\0"s, "it is text in UTF-16, which is not read; save it as UTF-8"},
        ForeignFile{"Medit", "\1\0\0\0\3\0\0\0"s, "it is a binary Medit file (.meshb)"},
        ForeignFile{"BigEndianMedit", "\0\0\0\1\0\0\0\4"s, "save it as text (.mesh)"},
        ForeignFile{"Baked", "BFEMBODY\1\0"s, "it is a baked body of BulletFEM, which is not read; give it"},
        ForeignFile{"Unknown", "solid\0mesh"s, "byte 5: it is a binary file, and of no format that is read; save"}),
    [](const auto& file) { return std::string(file.param.test); });

// For example the numbers of a binary file whose header says ASCII.
TEST(UnprintableWords, AreToldInWords)
{
    const auto why = [](TetMeshFormat format, const std::string& bytes)
    { return messageOf<std::runtime_error>([&] { readAs(format, bytes); }); };
    EXPECT_THAT(why(TetMeshFormat::vtk, withEach(vtkText("2.0"), "\n1 0 0", "\n\x3f\x80 0 0")),
                HasSubstr("line 7: '(unprintable bytes)' is not a coordinate"));
    EXPECT_THAT(why(TetMeshFormat::vtk, withEach(vtkText("2.0"), "CELLS", "CE\x1b[2JLLS")),
                HasSubstr("line 12: '(unprintable bytes)' stands where a section"));
    EXPECT_THAT(why(TetMeshFormat::gmsh, withEach(gmsh2Text("2.2"), "$Elements", "\xc3\xa9\xc3\xa9")),
                HasSubstr("'(unprintable bytes)' stands where a section such as $Nodes"));
}

TEST(RepeatedElements, AreRejectedByTheMesh)
{
    std::string text = tetGenText(1);
    text.replace(text.find("2 4 0"), std::string::npos, "2 4 0\n1 1 2 3 5\n2 5 3 2 1\n");
    const TetMeshFile file = readAs(TetMeshFormat::tetgen, text);
    EXPECT_THAT(messageOf<std::invalid_argument>([&] { file.mesh(); }),
                AllOf(HasSubstr("1 of 2 elements repeat another one (none is there only once): element 1 "),
                      HasSubstr("has the four nodes of element 0; list each element once")));
}

}  // namespace
}  // namespace bullet_fem
