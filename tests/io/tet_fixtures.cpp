// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "io/tet_fixtures.h"

#include <cstdint>

#include "io/byte_text.h"

namespace bullet_fem
{
namespace
{

constexpr std::uint64_t kTags[] = {7, 1000000000000000000u, 3, 12, 5, 9223372036854775817u};  // the last exceeds 2^63
constexpr int kSmallTags[] = {7, 2000000000, 3, 12, 5, 6};
constexpr int kPoint = 0, kEdge[] = {0, 1}, kTriangle[] = {0, 1, 3};

std::string gmsh2Binary(bool bigEndian)
{
    ByteText file(bigEndian);
    file << "$MeshFormat\n2.2 1 8\n";
    file.raw<std::int32_t>(1) << "\n$EndMeshFormat\n$Nodes\n6\n";
    for (int i = 0; i < 6; ++i)
    {
        file.raw<std::int32_t>(kSmallTags[i]);
        for (int k = 0; k < 3; ++k) file.raw(fixtureNodes()[i][k]);
    }
    file << "\n$EndNodes\n$Elements\n5\n";
    const auto block = [&](int type, int count) { file.raw(type).raw(count).raw(2); };
    const auto begin = [&](int number) { file.raw(number).raw(99).raw(1); };
    block(15, 1);
    begin(1);
    file.raw(kSmallTags[kPoint]);
    block(1, 1);
    begin(2);
    for (const int i : kEdge) file.raw(kSmallTags[i]);
    block(2, 1);
    begin(3);
    for (const int i : kTriangle) file.raw(kSmallTags[i]);
    block(4, 2);
    for (int e = 0; e < 2; ++e)
    {
        begin(4 + e);
        for (const int i : fixtureTets()[e]) file.raw(kSmallTags[i]);
    }
    file << "\n$EndElements\n";
    return file.bytes();
}

/// Binary Gmsh 4 with sizes of 4 or 8 bytes, and two parameters per node in the second block.
std::string gmsh4Binary(bool bigEndian, int sizeBytes)
{
    ByteText file(bigEndian);
    const auto tag = [&](int i) { return sizeBytes == 8 ? kTags[i] : static_cast<std::uint64_t>(kSmallTags[i]); };
    const auto sizes = [&](std::initializer_list<std::uint64_t> numbers)
    {
        for (const std::uint64_t number : numbers)
            sizeBytes == 8 ? file.raw(number) : file.raw(static_cast<std::uint32_t>(number));
    };
    const auto nodes = [&](auto places)
    {
        for (const int i : places) sizes({tag(i)});
    };
    file << "$MeshFormat\n4.1 1 " << sizeBytes << "\n";
    file.raw<std::int32_t>(1) << "\n$EndMeshFormat\n$Entities\n";
    sizes({0, 0, 0, 0});
    file << "\n$EndEntities\n$Nodes\n";
    sizes({3, 6, 3, tag(5)});
    for (const auto& [begin, end] : {std::pair(0, 4), std::pair(4, 6), std::pair(6, 6)})
    {
        const bool parametric = begin == 4;
        file.raw(2).raw(1).raw<std::int32_t>(parametric);
        sizes({static_cast<std::uint64_t>(end - begin)});
        for (int i = begin; i < end; ++i) sizes({tag(i)});
        for (int i = begin; i < end; ++i)
        {
            for (int k = 0; k < 3; ++k) file.raw(fixtureNodes()[i][k]);
            if (parametric) file.raw(0.25).raw(0.75);
        }
    }
    file << "\n$EndNodes\n$Elements\n";
    sizes({4, 5, 1, 5});
    file.raw(0).raw(1).raw(15);
    sizes({1, 1, tag(kPoint)});
    file.raw(1).raw(1).raw(1);
    sizes({1, 2});
    nodes(std::vector<int>(std::begin(kEdge), std::end(kEdge)));
    file.raw(2).raw(1).raw(2);
    sizes({1, 3});
    nodes(std::vector<int>(std::begin(kTriangle), std::end(kTriangle)));
    file.raw(3).raw(1).raw(4);
    sizes({2});
    for (std::uint64_t e = 0; e < 2; ++e)
    {
        sizes({4 + e});
        nodes(fixtureTets()[e]);
    }
    file << "\n$EndElements\n";
    return file.bytes();
}

std::string tetGenDecorated()
{
    return "# made by hand\n\n6 3 1 1 # points, dimension, attributes, markers\n"
           "1 0 0 0 .5 1\r\n2 1 0 0 .5 1#red\n\n3 0 1 0 .5 1\n4 5 5 5 .5 0\n5 0 0 1 .5 1\n  6\t1 1 1.25 .5 1\n# the "
           "end\n"
           "# tetrahedra\n2 4 1\n1 1 2 3 5 17\n2 2 3 5 6 18\n# the end";
}

/// `Real` and `Integer` are the types of positions and of version 5's arrays.
template <class Real, class Integer>
std::string vtkBinary(const std::string& version, const std::string& real, const std::string& integer, bool extras)
{
    ByteText file(true);
    file << "# vtk DataFile Version " << version << "\ntwo tetrahedra\nBINARY\nDATASET UNSTRUCTURED_GRID\n";
    if (extras)
    {
        file << "FIELD FieldData 3\nTIME 1 1 double\n";
        file.raw(1.5) << "\nMETADATA\nINFORMATION 0\n\nname 1 2 string\n";
        file.raw<std::uint8_t>(0xC0 | 6) << "rubber";
        file.raw<std::uint16_t>(0x8000 | 4) << "soft\nflags 1 9 bit\n";
        file.raw<std::uint16_t>(0x2020) << "\n";
    }
    file << "POINTS 6 " << real << "\n";
    for (const Vec3& x : fixtureNodes())
        for (int k = 0; k < 3; ++k) file.raw(static_cast<Real>(x[k]));
    file << "\n";
    if (extras) file << "METADATA\nINFORMATION 2\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 0 9\n\n";
    const int rows[] = {1, 0, 2, 0, 1, 3, 0, 1, 3, 4, 0, 1, 2, 4, 4, 1, 2, 4, 5};
    if (version[0] < '5')
    {
        file << "CELLS 5 19\n";
        for (const int i : rows) file.raw<std::int32_t>(i);
    }
    else
    {
        file << "CELLS 6 14\nOFFSETS " << integer << "\n";
        for (const int end : {0, 1, 3, 6, 10, 14}) file.raw(static_cast<Integer>(end));
        file << "\nCONNECTIVITY " << integer << "\n";
        for (const int i : {0, 0, 1, 0, 1, 3, 0, 1, 2, 4, 1, 2, 4, 5}) file.raw(static_cast<Integer>(i));
    }
    file << "\nCELL_TYPES 5\n";
    for (const int type : {1, 3, 5, 10, 10}) file.raw<std::int32_t>(type);
    file << "\nCELL_DATA 5\nSCALARS region int 1\nLOOKUP_TABLE default\n";
    for (int e = 0; e < 5; ++e) file.raw<std::int32_t>(e);
    file << "\n";
    return file.bytes();
}

/// A .vtk file as in Bullet's data: with wrong sizes, and without types.
std::string vtkOfBullet()
{
    return "#vtk DataFile Version 2.0\nI know\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 6 double\n0 0 0\n1 0 0\n0 1 0\n"
           "5 5 5\n0 0 1\n1 1 1.25\nCELLS 2 8\n4 0 1 2 4\n4 1 2 4 5\nCELL_TYPES 10\n";
}

std::string vtkTextWithExtras()
{
    return "# vtk DataFile Version 4.2\r\ntwo tetrahedra\nascii\ndataset unstructured_grid\nFIELD FieldData 3\n"
           "TIME 1 1 double\n1.5\nMETADATA\nINFORMATION 0\n\nname 1 1 string\nsoft%20rubber\nNULL_ARRAY\npoints 6 "
           "float\n"
           "0 0 0 1 0 0 0 1 0\n5 5 5 0 0 1 1 1 1.25\n\nMETADATA\nCOMPONENT_NAMES\nX\nY\nZ\n\nCELLS 6 20\n1 0\n2 0 1\n"
           "3 0 1 3\n0\n4 0 1 2 4\n4 1 2 4 5\n\nCELL_TYPES 6\n1\n3\n5\n0\n10 10\n\nPOINT_DATA 6\nSCALARS s float\n";
}

std::string vtuTwoPieces()
{
    return "<?xml version=\"1.0\"?>\n<!-- by hand -->\n<VTKFile type='UnstructuredGrid'>\n<UnstructuredGrid>\n"
           "<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"><Points/></Piece>\n"
           "<Piece NumberOfPoints=\"4\" NumberOfCells=\"3\"><Cells>\n"
           "<DataArray type=\"UInt8\" Name=\"types\">1 3 5</DataArray>\n"
           "<DataArray type=\"Int32\" Name=\"offsets\">1 3 6</DataArray>\n"
           "<DataArray type=\"Int32\" Name=\"connectivity\">0 0 1 0 1 3</DataArray></Cells>\n"
           "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\">0 0 0 1 0 0 0 1 0 5 5 5</DataArray></Points>\n"
           "</Piece>\n<Piece NumberOfPoints=\"5\" NumberOfCells=\"2\">\n<PointData><DataArray "
           "Name=\"s\"/></PointData>\n"
           "<Points><DataArray type=\"Float32\">0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1.25</DataArray></Points>\n<Cells>\n"
           "<DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 2 3 1 2 3 4</DataArray>\n"
           "<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">4 8</DataArray>\n"
           "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">10 10</DataArray>\n"
           "</Cells></Piece>\n</UnstructuredGrid></VTKFile>";
}

std::string meditTetrahedraFirst()
{
    return "MeshVersionFormatted 1 # by hand\nDimension\n3\n\nTetrahedra\n2\n1 2 3 5 0\n2 3 5 6 0\n\nVertices 6 # all\n"
           "0 0 0 1\n1 0 0 1\n0 1 0 1\n5 5 5 1.\n0 0 1 1\n1 1 1.25 1\nCorners\n2\n1\n2\nNormals 1\n0 0 -1\n"
           "NormalAtVertices 1\n1 1\nTriangles\n1\n1 2 4 1\nRequiredTriangles 1\n1\nRidges 1\n1\nEdges\n1\n1 2 7\n";
}

void addVtu(std::vector<TetFixture>& fixtures, const std::string& name, const VtuLayout& layout)
{
    fixtures.push_back({name, TetMeshFormat::vtu, vtuBinary(layout), 1, 1, 1, "1.0"});
}

}  // namespace

const std::vector<Vec3>& fixtureNodes()
{
    static const std::vector<Vec3> nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 5, 5}, {0, 0, 1}, {1, 1, 1.25}};
    return nodes;
}

const std::vector<Tet>& fixtureTets()
{
    static const std::vector<Tet> tets = {{0, 1, 2, 4}, {1, 2, 4, 5}};
    return tets;
}

std::string gmsh1Text(const std::string& nodes)
{
    return "$" + nodes + "\n6\n7 0 0 0\n2000000000 1 0 0\n3 0 1 0\n12 5 5 5\n5 0 0 1e0\n6 1 1 +1.25\n$END" + nodes +
           "\n$ELM\n5\n1 15 0 1 1 7\n2 1 0 1 2 7 2000000000\n3 2 4 1 3 7 2000000000 12\n4 4 0 1 4 7 2000000000 3 5\n"
           "5 4 0 1 4 2000000000 3 5 6\n$ENDELM\n";
}

std::string gmsh2Text(const std::string& version)
{
    return "$MeshFormat\n" + version +
           " 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 1 \"body\"\n$EndPhysicalNames\n$Nodes\n6\n7 0 0 0\n"
           "2000000000 1 0 0\n3 0 1 0\n12 5 5 5\n5 0 0 1e0\n6 1 1 +1.25\n$EndNodes\n$Elements\n5\n1 15 2 0 1 7\n"
           "2 1 0 7 2000000000\n3 2 4 0 1 1 -1 7 2000000000 12\n4 4 2 0 1 7 2000000000 3 5\n5 4 2 0 1 2000000000 3 5 "
           "6\n"
           "$EndElements\n$NodeData\n1\n\"s\"\n0\n$EndNodeData\n";
}

std::string gmsh4Text()
{
    return "$Comments\nby hand, $Nodes\n$EndComments\r\n$MeshFormat\r\n4.1 0 8\r\n$EndMeshFormat\r\n$Entities\n0 0 0 "
           "0\n"
           "$EndEntities\n$Nodes\n3 6 3 9223372036854775817\n2 1 0 4\n7\n1000000000000000000\n3\n12\n0 0 0\n1 0 0\n"
           "0 1 0\n5 5 5\n2 2 1 2\n5\n9223372036854775817\n0 0 1 .5 .5\n1 1 1.25 .25 .75\n2 3 0 "
           "0\n$EndNodes\n$Elements\n"
           "4 5 1 5\n0 1 15 1\n1 7\n1 1 1 1\n2 7 1000000000000000000\n2 1 2 1\n3 7 1000000000000000000 12\n3 1 4 2\n"
           "4 7 1000000000000000000 3 5\n5 1000000000000000000 3 5 9223372036854775817\n$EndElements\n";
}

std::string tetGenText(int first)
{
    ByteText file;
    file << "6 3 0 0\n";
    for (int i = 0; i < 6; ++i)
        file << i + first << " " << fixtureNodes()[i].x << " " << fixtureNodes()[i].y << " " << fixtureNodes()[i].z
             << "\n";
    file << "2 4 0\n";
    for (int e = 0; e < 2; ++e)
    {
        file << e + first;
        for (const int i : fixtureTets()[e]) file << " " << i + first;
        file << "\n";
    }
    return file.bytes();
}

std::string vtkText(const std::string& version)
{
    const std::string head = "# vtk DataFile Version " + version +
                             "\ntwo tetrahedra\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 6 double\n0 0 0\n1 0 0\n"
                             "0 1 0\n5 5 5\n0 0 1\n1 1 1.25\n";
    const std::string rows = "CELLS 5 19\n1 0\n2 0 1\n3 0 1 3\n4 0 1 2 4\n4 1 2 4 5\n",
                      arrays =
                          "CELLS 6 14\nOFFSETS vtktypeint64\n0 1 3 6 10 14\nCONNECTIVITY vtktypeint64\n"
                          "0 0 1 0 1 3 0 1 2 4 1 2 4 5\n";
    return head + (version[0] < '5' ? rows : arrays) + "\nCELL_TYPES 5\n1\n3\n5\n10\n10\n";
}

std::string vtuText()
{
    return "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n"
           "<Piece NumberOfPoints=\"6\" NumberOfCells=\"5\">\n<Points>\n"
           "<DataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\" format=\"ascii\">\n"
           "0 0 0 1 0 0 0 1 0 5 5 5 0 0 1 1 1 1.25\n</DataArray>\n</Points>\n<Cells>\n"
           "<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 0 1 0 1 3 0 1 2 4 1 2 4 5</DataArray>\n"
           "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">1 3 6 10 14</DataArray>\n"
           "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">1 3 5 10 10</DataArray>\n"
           "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}

std::string meditText(int version)
{
    return "MeshVersionFormatted " + std::to_string(version) +
           "\nDimension 3\nVertices\n6\n0 0 0 0\n1 0 0 0\n0 1 0 0\n5 5 5 0\n0 0 1 0\n1 1 1.25 0\nEdges\n1\n1 2 0\n"
           "Triangles\n1\n1 2 4 0\nHexahedra\n0\nTetrahedra\n2\n1 2 3 5 0\n2 3 5 6 0\nEnd\nwhatever 1";
}

std::vector<TetFixture> tetFixtures()
{
    using Format = TetMeshFormat;
    std::vector<TetFixture> all = {
        {"Gmsh1Text", Format::gmsh, gmsh1Text("NOD"), 1, 1, 1, "1 text"},
        {"Gmsh1NoeText", Format::gmsh, gmsh1Text("NOE"), 1, 1, 1, "1 text"},
        {"Gmsh20Text", Format::gmsh, gmsh2Text("2"), 1, 1, 1, "2 text"},
        {"Gmsh22Text", Format::gmsh, gmsh2Text("2.2"), 1, 1, 1, "2.2 text"},
        {"Gmsh22Little", Format::gmsh, gmsh2Binary(false), 1, 1, 1, "2.2 binary"},
        {"Gmsh22Big", Format::gmsh, gmsh2Binary(true), 1, 1, 1, "2.2 binary"},
        {"Gmsh41Text", Format::gmsh, gmsh4Text(), 1, 1, 1, "4.1 text"},
        {"Gmsh41Little", Format::gmsh, gmsh4Binary(false, 8), 1, 1, 1, "4.1 binary"},
        {"Gmsh41Big", Format::gmsh, gmsh4Binary(true, 8), 1, 1, 1, "4.1 binary"},
        {"Gmsh41Little32", Format::gmsh, gmsh4Binary(false, 4), 1, 1, 1, "4.1 binary"},
        {"TetGenFrom0", Format::tetgen, tetGenText(0), 0, 0, 0, ""},
        {"TetGenFrom1", Format::tetgen, tetGenText(1), 0, 0, 0, ""},
        {"TetGenDecorated", Format::tetgen, tetGenDecorated(), 0, 0, 0, ""},
        {"Vtk20Text", Format::vtk, vtkText("2.0"), 1, 1, 1, "2.0 text"},
        {"VtkOfBullet", Format::vtk, vtkOfBullet(), 0, 0, 0, "2.0 text"},
        {"Vtk42TextWithExtras", Format::vtk, vtkTextWithExtras(), 1, 1, 1, "4.2 text"},
        {"Vtk51Text", Format::vtk, vtkText("5.1"), 1, 1, 1, "5.1 text"},
        {"Vtk20Double", Format::vtk, vtkBinary<double, int>("2.0", "double", "", false), 1, 1, 1, "2.0 binary"},
        {"Vtk42Float", Format::vtk, vtkBinary<float, int>("4.2", "float", "", true), 1, 1, 1, "4.2 binary"},
        {"Vtk51Int64", Format::vtk, vtkBinary<double, std::int64_t>("5.1", "double", "vtktypeint64", true), 1, 1, 1,
         "5.1 binary"},
        {"Vtk51Int", Format::vtk, vtkBinary<float, std::int32_t>("5.1", "float", "int", false), 1, 1, 1, "5.1 binary"},
        {"Vtk51Long", Format::vtk, vtkBinary<float, std::int64_t>("5.1", "float", "long", false), 1, 1, 1,
         "5.1 binary"},
        {"VtuText", Format::vtu, vtuText(), 1, 1, 1, "0.1"},
        {"VtuTwoPieces", Format::vtu, vtuTwoPieces(), 1, 1, 1, ""},
        {"Medit1", Format::medit, meditText(1), 1, 1, 0, "1 text"},
        {"Medit2", Format::medit, meditText(2), 1, 1, 0, "2 text"},
        {"MeditTetrahedraFirst", Format::medit, meditTetrahedraFirst(), 1, 1, 0, "1 text"}};
    addVtu(all, "VtuInline", {});
    addVtu(all, "VtuInlinePaddedHeader", {"binary", false, 4, 0, true});
    addVtu(all, "VtuInlineBig64", {"binary", true, 8, 0, false, "Float32", "Int32"});
    addVtu(all, "VtuInlineZlib", {"binary", false, 4, 32768});
    addVtu(all, "VtuInlineZlibBlocksBig64", {"binary", true, 8, 40});
    addVtu(all, "VtuInlineZlibFullBlocks", {"binary", false, 4, 8});
    addVtu(all, "VtuRaw", {"raw"});
    addVtu(all, "VtuRawBig", {"raw", true, 4, 0, false, "Float32", "UInt32"});
    addVtu(all, "VtuRawZlib64", {"raw", false, 8, 24});
    addVtu(all, "VtuBase64", {"base64", false, 8});
    addVtu(all, "VtuBase64Zlib", {"base64", false, 4, 32768, false, "Float64", "Int16"});
    return all;
}

}  // namespace bullet_fem
