// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/io/surface_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <sstream>
#include <utility>

#include "io/temporary_folder.h"

namespace bullet_fem
{
namespace
{

using testing::AllOf;
using testing::HasSubstr;

/// A box of 1 x 2 x 3 from the origin; all numbers are exact in single precision.
const std::vector<Vec3> kBoxCorners = {{0, 0, 0}, {0, 0, 3}, {0, 2, 0}, {0, 2, 3},
                                       {1, 0, 0}, {1, 0, 3}, {1, 2, 0}, {1, 2, 3}};
const int kBoxQuads[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};

std::string boxVertexLines(const std::string& before, const std::string& after)
{
    std::ostringstream text;
    for (const Vec3& x : kBoxCorners) text << before << x.x << ' ' << x.y << ' ' << x.z << after << '\n';
    return text.str();
}
std::string boxFaceLines(const std::string& before, int firstIndex, const std::string& after = "")
{
    std::ostringstream text;
    for (const auto& quad : kBoxQuads)
    {
        text << before;
        for (const int v : quad) text << ' ' << v + firstIndex << after;
        text << '\n';
    }
    return text.str();
}
std::string withoutLastByte(std::string text)
{
    text.pop_back();
    return text;
}
template <typename Number>
void append(std::string& bytes, Number value, bool bigEndian = false)
{
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    if (bigEndian) std::reverse(raw, raw + sizeof value);
    bytes.append(raw, sizeof value);
}

std::string boxOff()
{
    return "OFF\n8 6 0\n" + boxVertexLines("", "") + boxFaceLines("4", 0);
}
std::string boxColouredOff()
{
    return "# made by hand\n\nCOFF # coloured\r\n8 6 12\r\n# vertices\n" + boxVertexLines(" ", "  1 0 0 1 #red\r") +
           "\n" + boxFaceLines("4 ", 0, " ") + "# the end";
}
std::string boxObj()
{
    return "mtllib nowhere.mtl\no box\n" + boxVertexLines("v ", "") + "vt 0 0\nvt 1 1\nvn 0 0 1\nusemtl red\n" +
           boxFaceLines("f", 1, "/2/1") + "l 1 2 3\np 4\n";
}
std::string plyHeader(const std::string& encoding)
{
    return "ply\nformat " + encoding +
           " 1.0\ncomment made by hand\nelement vertex 8\nproperty double x\nproperty double y\nproperty double z\n"
           "property uchar red\nelement face 6\nproperty float quality\nproperty list uchar int vertex_indices\n"
           "element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n";
}
std::string boxTextPly()
{
    return plyHeader("ascii") + boxVertexLines("", " 255") + boxFaceLines("0.5 4", 0) + "0 1\n";
}
// A PLY header as some exporters write it, without the word `comment`.
std::string strayLine(std::string ply)
{
    return ply.replace(ply.find("comment made"), 8, "");
}
std::string boxBinaryPly(bool bigEndian)
{
    std::string bytes = plyHeader(bigEndian ? "binary_big_endian" : "binary_little_endian");
    for (const Vec3& x : kBoxCorners)
    {
        for (int i = 0; i < 3; ++i) append(bytes, x[i], bigEndian);
        append<std::uint8_t>(bytes, 255);
    }
    for (const auto& quad : kBoxQuads)
    {
        append(bytes, 0.5f, bigEndian);
        append<std::uint8_t>(bytes, 4);
        for (const int v : quad) append<std::int32_t>(bytes, v, bigEndian);
    }
    append<std::int32_t>(bytes, 0, bigEndian);
    append<std::int32_t>(bytes, 1, bigEndian);
    return bytes;
}
std::vector<Triangle> boxTriangles()
{
    std::vector<Triangle> triangles;
    for (const auto& q : kBoxQuads)
    {
        triangles.push_back({q[0], q[1], q[2]});
        triangles.push_back({q[0], q[2], q[3]});
    }
    return triangles;
}
std::string boxTextStl()
{
    std::ostringstream text;
    text << "solid box\n";
    for (const Triangle& t : boxTriangles())
    {
        text << "facet normal 0 0 0\nouter loop\n";
        for (const int v : t)
            text << "vertex " << kBoxCorners[v].x << ' ' << kBoxCorners[v].y << ' ' << kBoxCorners[v].z << '\n';
        text << "endloop\nendfacet\n";
    }
    text << "endsolid box\n";
    return text.str();
}
/// Zeros of both signs are equal coordinates.
std::string boxBinaryStl()
{
    std::string bytes(80, ' ');
    append<std::uint32_t>(bytes, 12);
    float zero = 0;
    for (const Triangle& t : boxTriangles())
    {
        for (int i = 0; i < 3; ++i) append(bytes, 0.f);
        for (const int v : t)
            for (int i = 0; i < 3; ++i)
                append(bytes, kBoxCorners[v][i] == 0 ? zero = -zero : static_cast<float>(kBoxCorners[v][i]));
        append<std::uint16_t>(bytes, 0);
    }
    return bytes;
}

/// Number of triangles at an edge: minimum and maximum.
std::pair<int, int> trianglesPerEdge(const SurfaceMesh& surface)
{
    std::map<std::pair<int, int>, int> count;
    for (const Triangle& t : surface.m_triangles)
        for (int i = 0; i < 3; ++i) ++count[std::minmax(t[i], t[(i + 1) % 3])];
    std::pair<int, int> range{std::numeric_limits<int>::max(), 0};
    for (const auto& entry : count) range = {std::min(range.first, entry.second), std::max(range.second, entry.second)};
    return range;
}
double volume(const SurfaceMesh& surface)
{
    double sum = 0;
    for (const Triangle& t : surface.m_triangles)
        sum += dot(surface.m_vertices[t[0]], cross(surface.m_vertices[t[1]], surface.m_vertices[t[2]])) / 6;
    return sum;
}

struct BoxFile
{
    const char *test, *name;
    std::string bytes;
};
std::ostream& operator<<(std::ostream& out, const BoxFile& file)
{
    return out << file.name;
}

class BoxFileTest : public testing::TestWithParam<BoxFile>
{
};

TEST_P(BoxFileTest, IsAClosedBoxWithSharedVertices)
{
    const TemporaryFolder folder;
    const SurfaceMesh surface = readSurfaceFile(folder.write(GetParam().name, GetParam().bytes));
    EXPECT_EQ(surface.m_vertices.size(), 8u);
    EXPECT_EQ(surface.m_triangles.size(), 12u);
    EXPECT_EQ(trianglesPerEdge(surface), std::make_pair(2, 2));
    EXPECT_DOUBLE_EQ(volume(surface), 6);  // the numbers are exact in single precision
}

INSTANTIATE_TEST_SUITE_P(
    Formats, BoxFileTest,
    testing::Values(BoxFile{"Off", "box.off", boxOff()},
                    BoxFile{"OffWithoutLastLineBreak", "box.off", withoutLastByte(boxOff())},
                    BoxFile{"OffColoursCommentsAndCarriageReturns", "box.OFF", boxColouredOff()},
                    BoxFile{"OffWithoutItsHeaderWord", "box.off", boxOff().substr(4)},
                    BoxFile{"PlyWithALineThatIsNoComment", "box.ply", strayLine(boxTextPly())},
                    BoxFile{"ObjWithNormalsAndTexture", "box.Obj", boxObj()},
                    BoxFile{"PlyText", "box.ply", boxTextPly()},
                    BoxFile{"PlyTextWithoutLastLineBreak", "box.ply", withoutLastByte(boxTextPly())},
                    BoxFile{"PlyLittleEndian", "box.PLY", boxBinaryPly(false)},
                    BoxFile{"PlyBigEndian", "box.ply", boxBinaryPly(true)}, BoxFile{"StlText", "box.stl", boxTextStl()},
                    BoxFile{"StlBinaryWithZerosOfBothSigns", "my.box.STL", boxBinaryStl()}),
    [](const auto& file) { return std::string(file.param.test); });

TEST(SurfaceFile, ScaleMultipliesPositions)
{
    const TemporaryFolder folder;
    const SurfaceMesh surface = readSurfaceFile(folder.write("box.off", boxOff()), 0.5);
    EXPECT_DOUBLE_EQ(volume(surface), 0.75);
    EXPECT_DOUBLE_EQ(surface.m_vertices[1].z, 1.5);
}

TEST(SurfaceFile, TextKeepsDoublePrecisionOfOffAndPly)
{
    const TemporaryFolder folder;
    const std::string corners = "0.1 1e3 -2.5E-1\n+1 0 0\n0 1 0\n";
    const SurfaceMesh off = readSurfaceFile(folder.write("t.off", "OFF 3 1 0\n" + corners + "3 0 1 2\n"));
    EXPECT_EQ(off.m_vertices[0].x, 0.1);
    EXPECT_EQ(off.m_vertices[0].y, 1000);
    EXPECT_EQ(off.m_vertices[0].z, -0.25);
}

TEST(SurfaceFile, ObjectsOfOneFileBecomeOneSurface)
{
    const TemporaryFolder folder;
    const std::string text = "o a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no b\nv 5 0 0\nv 6 0 0\nv 5 1 0\nf -3 -2 -1\n";
    const SurfaceMesh surface = readSurfaceFile(folder.write("two.obj", text));
    EXPECT_EQ(surface.m_vertices.size(), 6u);
    ASSERT_EQ(surface.m_triangles.size(), 2u);
    EXPECT_EQ(surface.m_vertices[surface.m_triangles[1][0]].x, 5);
}

TEST(SurfaceFile, DropsCollapsedTrianglesShortFacesAndUnusedVertices)
{
    const TemporaryFolder folder;
    const std::string text =
        "OFF\n6 4 0\n9 9 9\n0 0 0\n1 0 0\n0 1 0\n0 0 0\nnan 0 0\n"  // vertex 4 equals vertex 1; 0 and 5 are unused
        "3 1 2 3\n3 1 2 4\n2 1 2\n0\n";
    const SurfaceMesh surface = readSurfaceFile(folder.write("t.off", text));
    EXPECT_EQ(surface.m_vertices.size(), 3u);
    ASSERT_EQ(surface.m_triangles.size(), 1u);
    EXPECT_EQ(surface.m_triangles[0], (Triangle{0, 1, 2}));
}

TEST(SurfaceFile, KeepsVertexOrder)
{
    const TemporaryFolder folder;
    const SurfaceMesh surface = readSurfaceFile(folder.write("box.ply", boxTextPly()));
    ASSERT_EQ(surface.m_vertices.size(), kBoxCorners.size());
    for (std::size_t i = 0; i < kBoxCorners.size(); ++i)
        EXPECT_EQ(norm(surface.m_vertices[i] - kBoxCorners[i]), 0) << i;
}

// 0xRRGGBB, for any order and type of a PLY file's colours.
TEST(SurfaceFile, KeepsColoursOfPlyVerticesAsLabels)
{
    const TemporaryFolder folder;
    const std::string
        head = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n",
        faces = "element face 4\nproperty list uchar int vertex_indices\nend_header\n",
        triangles = "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
    const auto labels = [&](const std::string& properties, const std::string& vertices)
    {
        folder.write("tet.ply", head + properties + faces + vertices + triangles);
        return readSurfaceFile(folder.path("tet.ply")).m_labels;
    };
    EXPECT_EQ(labels("property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n",
                     "0 0 0 255 0 0 9\n1 0 0 255 0 0 9\n0 1 0 1 2 3 9\n0 0 1 0 0 255 9\n"),
              (std::vector<int>{0xFF0000, 0xFF0000, 0x010203, 0x0000FF}));
    EXPECT_EQ(labels("property float blue\nproperty float green\nproperty float red\n",
                     "0 0 0 1 0.5 0\n1 0 0 0 0 1\n0 1 0 2 -1 nan\n0 0 1 0 0 0\n"),
              (std::vector<int>{0x0080FF, 0xFF0000, 0x0000FF, 0}));
    EXPECT_TRUE(labels("property uchar red\nproperty uchar green\nproperty uchar blue\n",
                       "0 0 0 7 7 7\n1 0 0 7 7 7\n0 1 0 7 7 7\n0 0 1 7 7 7\n")
                    .empty())
        << "of one colour";
    EXPECT_TRUE(labels("property uchar red\n", "0 0 0 7\n1 0 0 8\n0 1 0 9\n0 0 1 7\n").empty()) << "red alone";
    EXPECT_TRUE(labels("", "0 0 0\n1 0 0\n0 1 0\n0 0 1\n").empty());
}

// A fan of triangles around corner 0; no two corners have equal colours.
TEST(SurfaceFile, TreatsTooManyColoursAsAPhotograph)
{
    const TemporaryFolder folder;
    const auto labels = [&](int colours)
    {
        std::ostringstream text;
        text << "ply\nformat ascii 1.0\nelement vertex " << colours
             << "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\n"
                "property uchar blue\nelement face "
             << colours - 2 << "\nproperty list uchar int vertex_indices\nend_header\n";
        for (int v = 0; v < colours; ++v) text << v << ' ' << v * v << " 0 " << v / 256 << " 0 " << v % 256 << '\n';
        for (int t = 2; t < colours; ++t) text << "3 0 " << t - 1 << ' ' << t << '\n';
        folder.write("fan.ply", text.str());
        return readSurfaceFile(folder.path("fan.ply")).m_labels.size();
    };
    EXPECT_EQ(labels(256), 256u);
    EXPECT_EQ(labels(257), 0u);
}

TEST(SurfaceFile, KeepsPartsOfObjFilesAsLabels)
{
    const TemporaryFolder folder;
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 5 0 0\nv 6 0 0\nv 5 1 0\n";
    const auto labels = [&](const std::string& begin, const std::string& second)
    {
        folder.write("parts.obj", vertices + begin + "f 1 3 2\nf 1 2 4\n" + second + "f 2 3 4\nf 5 6 7\n");
        return readSurfaceFile(folder.path("parts.obj")).m_labels;
    };
    const std::vector<int> parts = {1, 1, 1, 1, 2, 2, 2};
    EXPECT_EQ(labels("g lower\n", "g upper\n"), parts);
    EXPECT_EQ(labels("usemtl rubber\n", "usemtl steel\n"), parts);
    EXPECT_EQ(labels("o lower\n", "o upper\n"), parts);
    EXPECT_TRUE(labels("", "").empty());
}

TEST(SurfaceFile, RejectsInvalidScale)
{
    const auto read = [](double scale) { return [scale] { readSurfaceFile("box.off", scale); }; };
    EXPECT_THAT(messageOf<std::invalid_argument>(read(0)), AllOf(HasSubstr("scale is 0;"), HasSubstr("positive")));
    EXPECT_THAT(messageOf<std::invalid_argument>(read(-2)), HasSubstr("scale is -2;"));
    EXPECT_THAT(messageOf<std::invalid_argument>(read(std::nan(""))), HasSubstr("scale is nan;"));
    EXPECT_THAT(messageOf<std::invalid_argument>(read(HUGE_VAL)), HasSubstr("scale is inf;"));
}

TEST(SurfaceFile, RejectsScaleThatOverflows)
{
    const TemporaryFolder folder;
    const std::string path = folder.write("t.off", "OFF 3 1 0\n0 0 0\n1e10 0 0\n0 1 0\n3 0 1 2\n");
    EXPECT_THAT(messageOf<std::runtime_error>([&] { readSurfaceFile(path, 1e300); }),
                HasSubstr("vertex 1 is not finite once scaled"));
}

TEST(SurfaceFile, RejectsMissingFileAndFolder)
{
    const TemporaryFolder folder;
    const std::string missing = folder.path("missing.off"), directory = folder.path("folder.off");
    std::filesystem::create_directory(directory);
    EXPECT_THAT(messageOf<std::runtime_error>([&] { readSurfaceFile(missing); }),
                AllOf(HasSubstr(missing), HasSubstr("no such file")));
    EXPECT_THAT(messageOf<std::runtime_error>([&] { readSurfaceFile(directory); }),
                AllOf(HasSubstr(directory), HasSubstr("directory or device")));
}

struct BadFile
{
    const char *test, *name;
    std::string bytes;
    const char* cause;
};
std::ostream& operator<<(std::ostream& out, const BadFile& file)
{
    return out << file.name;
}

class BadFileTest : public testing::TestWithParam<BadFile>
{
};

TEST_P(BadFileTest, IsRejectedWithItsNameAndTheCause)
{
    const TemporaryFolder folder;
    const std::string path = folder.write(GetParam().name, GetParam().bytes);
    EXPECT_THAT(messageOf<std::runtime_error>([&] { readSurfaceFile(path); }),
                AllOf(HasSubstr(path), HasSubstr(GetParam().cause)));
}

const std::string kThreeLines = "0 0 0\n1 0 0\n0 1 0\n";
const std::string kPlyVertices = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n";
const std::string kPlyFaces = "property float z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n";

INSTANTIATE_TEST_SUITE_P(Ending, BadFileTest,
                         testing::Values(BadFile{"Unknown", "box.gltf", "{}",
                                                 "'.gltf' is not known; it must be .off, .obj, .stl or .ply"},
                                         BadFile{"None", "box", boxOff(), "the ending '' is not known"},
                                         BadFile{"OfAnotherFormat", "box.stl", boxOff(), "STL"}),
                         [](const auto& file) { return std::string(file.param.test); });

INSTANTIATE_TEST_SUITE_P(
    Off, BadFileTest,
    testing::Values(BadFile{"Empty", "t.off", "", "the file ends where the header OFF should be"},
                    BadFile{"Header", "t.off", "QOFF\n8 6 0\n", "line 1: 'QOFF' is not a known OFF header"},
                    BadFile{"CountsAlone", "t.off", "8 6 0\n", "the file ends where vertex 0 of 8 should be"},
                    BadFile{"FourCoordinates", "t.off", "4OFF\n3 1 0\n", "'4OFF' is not a known OFF header"},
                    BadFile{"Binary", "t.off", "OFF BINARY\n", "binary OFF is not supported"},
                    BadFile{"Count", "t.off", "OFF\nthree 1 0\n", "line 2: 'three' is not a vertex count"},
                    BadFile{"NegativeCount", "t.off", "OFF\n-3 1 0\n", "count is negative"},
                    BadFile{"HugeCount", "t.off", "OFF\n4000000000 1 0\n0 0 0\n", "vertex 1 of 4000000000"},
                    BadFile{"CutShort", "t.off", "OFF\n3 2 0\n" + kThreeLines + "3 0 1 2\n", "face 1 of 2"},
                    BadFile{"Coordinate", "t.off", "OFF\n3 1 0\n0 0 x\n", "line 3: 'x' is not a coordinate"},
                    BadFile{"TwoCoordinates", "t.off", "OFF\n3 1 0\n0 0\n", "line 3: '' is not a coordinate"},
                    BadFile{"HugeFace", "t.off", "OFF\n3 1 0\n" + kThreeLines + "2000000000 0 1 2\n",
                            "'' is not a vertex index"},
                    BadFile{"IndexTooLarge", "t.off", "OFF\n3 1 0\n" + kThreeLines + "3 0 1 3\n",
                            "vertex 3, which is not in [0, 3)"},
                    BadFile{"IndexNegative", "t.off", "OFF\n3 1 0\n" + kThreeLines + "3 0 1 -1\n",
                            "vertex -1, which is not in [0, 3)"},
                    BadFile{"NotFinite", "t.off", "OFF\n3 1 0\n0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n",
                            "vertex 0 of face 0 is not finite"},
                    BadFile{"NoTriangle", "t.off", "OFF\n3 1 0\n" + kThreeLines + "2 0 1\n", "no triangle"}),
    [](const auto& file) { return std::string(file.param.test); });

INSTANTIATE_TEST_SUITE_P(
    Ply, BadFileTest,
    testing::Values(
        BadFile{"Empty", "t.ply", "", "no end_header line"},
        BadFile{"HeaderCutShort", "t.ply", "ply\nformat ascii 1.0\nelement ve", "no end_header line"},
        BadFile{"Magic", "t.ply", "OFF\nend_header\n", "'ply' on its first line"},
        BadFile{"Encoding", "t.ply", "ply\nformat utf 1.0\nend_header\n", "'utf' is not a PLY encoding"},
        BadFile{"Keyword", "t.ply", "ply\nformat ascii 1.0\nelement vertex 4\nelephant\n", "unexpected 'elephant'"},
        BadFile{"Type", "t.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\n", "'half' is not"},
        BadFile{"ElementCount", "t.ply", "ply\nformat ascii 1.0\nelement vertex x\n", "'x' is not an element count"},
        BadFile{"NoZ", "t.ply", kPlyVertices + "end_header\n0 0\n0 0\n0 0\n", "has 0 properties 'z', not one"},
        BadFile{"CutShort", "t.ply", kPlyVertices + kPlyFaces + "0 0 0\n1 0\n",
                "vertex 1 of 3: the file ends too early"},
        BadFile{"BinaryCutShort", "t.ply", withoutLastByte(boxBinaryPly(false)),
                "edge 0 of 1: the file ends too early"},
        BadFile{"Number", "t.ply", kPlyVertices + kPlyFaces + "0 0 zero\n", "vertex 0 of 3: 'zero' is not a number"},
        BadFile{"NegativeIndex", "t.ply", kPlyVertices + kPlyFaces + kThreeLines + "3 0 1 -2\n",
                "-2 is not a count or"},
        BadFile{"IndexTooLarge", "t.ply", kPlyVertices + kPlyFaces + kThreeLines + "3 0 1 7\n",
                "vertex 7, which is not"},
        BadFile{"NoFace", "t.ply", kPlyVertices + "property float z\nend_header\n" + kThreeLines, "no triangle"}),
    [](const auto& file) { return std::string(file.param.test); });

INSTANTIATE_TEST_SUITE_P(
    ThroughAssimp, BadFileTest,
    testing::Values(BadFile{"EmptyObj", "t.obj", "", "too small"},
                    BadFile{"ObjIndex", "t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "index out of range"},
                    BadFile{"ObjNotFinite", "t.obj", "v 0 0 0\nv 1 0 1e60\nv 0 1 0\nf 1 2 3\n", "not finite"},
                    BadFile{"EmptyStl", "t.stl", "", "empty"},
                    BadFile{"BinaryStlCutShort", "t.stl", withoutLastByte(boxBinaryStl()), "STL"}),
    [](const auto& file) { return std::string(file.param.test); });

}  // namespace
}  // namespace bullet_fem
