// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Region labels of tetrahedra in all formats: two tetrahedra with a common face, of regions 7 and -3, beside a triangle
// of region 5.
#include <gtest/gtest.h>

#include "bullet_fem/io/tet_mesh_file.h"
#include "io/byte_text.h"

namespace bullet_fem
{
namespace
{

std::vector<int> regionsOf(const std::string& bytes, TetMeshFormat format)
{
    const TetMeshFile file = readTetMesh(bytes.data(), bytes.size(), format);
    EXPECT_EQ(file.m_tets.size(), 2u);
    return file.m_regions;
}

const std::vector<int> kRegions = {7, -3};

TEST(TetRegions, AreGmshsFirstPhysicalGroup)
{
    const std::string nodes = "$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n$EndNodes\n";
    EXPECT_EQ(regionsOf("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + nodes +
                            "$Elements\n3\n1 2 2 5 1 1 2 3\n2 4 2 7 1 1 2 3 4\n3 4 3 -3 2 1 2 3 4 5\n$EndElements\n",
                        TetMeshFormat::gmsh),
              kRegions);
    EXPECT_TRUE(regionsOf("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + nodes +
                              "$Elements\n2\n2 4 2 0 1 1 2 3 4\n3 4 0 2 3 4 5\n$EndElements\n",
                          TetMeshFormat::gmsh)
                    .empty());
}

TEST(TetRegions, AreGmshsGroupsOfVolumes)
{
    const std::string head = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n",
                      mesh =
                          "$Nodes\n1 5 1 5\n3 1 0 5\n1\n2\n3\n4\n5\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n$EndNodes\n"
                          "$Elements\n3 3 1 3\n2 1 2 1\n1 1 2 3\n3 1 4 1\n2 1 2 3 4\n3 4 4 1\n3 2 3 4 5\n"
                          "$EndElements\n",
                      box = "0 0 0 1 1 1 ";
    EXPECT_EQ(regionsOf(head + "$Entities\n1 1 1 2\n9 0 0 0 1 4\n1 " + box + "0 2 9 -9\n1 " + box + "1 5 0\n1 " + box +
                            "2 7 8 1 1\n4 " + box + "1 -3 0\n$EndEntities\n" + mesh,
                        TetMeshFormat::gmsh),
              kRegions);
    EXPECT_TRUE(regionsOf(head + "$Entities\nof nobody's\n$EndEntities\n" + mesh, TetMeshFormat::gmsh).empty());
}

TEST(TetRegions, AreGmshsGroupsInBinaryFiles)
{
    ByteText file(false);
    file << "$MeshFormat\n2.2 1 8\n";
    file.raw<std::int32_t>(1) << "\n$EndMeshFormat\n$Nodes\n5\n";
    const double x[5][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
    for (std::int32_t i = 0; i < 5; ++i) file.raw(i + 1).raw(x[i][0]).raw(x[i][1]).raw(x[i][2]);
    file << "\n$EndNodes\n$Elements\n2\n";
    for (const std::int32_t e : {0, 1})
    {
        file.raw(4).raw(1).raw(2).raw(e + 1).raw(kRegions[e]).raw(1);
        for (std::int32_t a = 1; a <= 4; ++a) file.raw(a + e);
    }
    file << "\n$EndElements\n";
    EXPECT_EQ(regionsOf(file.bytes(), TetMeshFormat::gmsh), kRegions);
}

TEST(TetRegions, AreMeditsReferences)
{
    EXPECT_EQ(
        regionsOf("MeshVersionFormatted 2\nDimension 3\nVertices\n5\n0 0 0 1\n1 0 0 1\n0 1 0 1\n0 0 1 1\n1 1 1 1\n"
                  "Triangles\n1\n1 2 3 5\nTetrahedra\n2\n1 2 3 4 7\n2 3 4 5 -3\nEnd\n",
                  TetMeshFormat::medit),
        kRegions);
}

TEST(TetRegions, AreTetGensFirstAttribute)
{
    const std::string nodes = "5 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n";
    EXPECT_EQ(regionsOf(nodes + "2 4 2\n1 1 2 3 4 7.0 1\n2 2 3 4 5 -3 1\n", TetMeshFormat::tetgen), kRegions);
    EXPECT_TRUE(regionsOf(nodes + "2 4 0\n1 1 2 3 4 7\n2 2 3 4 5 -3\n", TetMeshFormat::tetgen).empty());
}

TEST(TetRegions, AreACellArrayOfVtk)
{
    const std::string mesh =
        "# vtk DataFile Version 3.0\nregions\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 float\n0 0 0 1 0 0 0 1 0 "
        "0 0 1 1 1 1\nCELLS 3 14\n3 0 1 2\n4 0 1 2 3\n4 1 2 3 4\nCELL_TYPES 3\n5\n10\n10\n";
    const std::string points = "POINT_DATA 5\nSCALARS heat float\nLOOKUP_TABLE default\n1 2 3 4 5\n";
    const std::string other = "SCALARS quality double 2\nLOOKUP_TABLE default\n1 2 3 4 5 6\n";
    for (const std::string& data :
         {std::string("CELL_DATA 3\nSCALARS MaterialIds int 1\nLOOKUP_TABLE default\n5 7 -3\n"),
          points + "CELL_DATA 3\n" + other + "FIELD FieldData 2\nbefore 1 3 int\n1 1 1\nmedit:ref 1 3 int\n5 7 -3\n"})
        EXPECT_EQ(regionsOf(mesh + data, TetMeshFormat::vtk), kRegions);
    for (const char* data : {"", "CELL_DATA 3\nSCALARS volume int 1\nLOOKUP_TABLE default\n5 7 -3\n",
                             "CELL_DATA 3\nSCALARS region int 1\nLOOKUP_TABLE default\n5 7 x\n"})
        EXPECT_TRUE(regionsOf(mesh + data, TetMeshFormat::vtk).empty()) << data;
}

TEST(TetRegions, AreACellArrayOfVtu)
{
    const auto file = [](const std::string& name)
    {
        return "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"5\" NumberOfCells=\"3\">"
               "<CellData><DataArray type=\"Int32\" Name=\"" +
               name +
               "\" format=\"ascii\">5 7 -3</DataArray></CellData><Points><DataArray type=\"Float64\" "
               "NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 0 1 0 0 0 1 1 1 1</DataArray></Points><Cells>"
               "<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 1 2 0 1 2 3 1 2 3 4</DataArray>"
               "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">3 7 11</DataArray>"
               "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">5 10 10</DataArray></Cells></Piece>"
               "</UnstructuredGrid></VTKFile>";
    };
    EXPECT_EQ(regionsOf(file("region"), TetMeshFormat::vtu), kRegions);
    EXPECT_TRUE(regionsOf(file("stress"), TetMeshFormat::vtu).empty());
}

}  // namespace
}  // namespace bullet_fem
