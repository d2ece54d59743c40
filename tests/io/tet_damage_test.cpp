// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdint>
#include <random>

#include "io/temporary_folder.h"
#include "io/tet_fixtures.h"

namespace bullet_fem
{
namespace
{

/// Reads arbitrary bytes from a buffer of exactly their size, so that sanitizers detect reads beyond it. A resulting
/// mesh must be valid; returns true if there is one. Errors must be std::runtime_error with a message.
bool readsWhole(const std::string& bytes, TetMeshFormat format)
{
    const std::vector<char> exact(bytes.begin(), bytes.end());
    TetMeshFile mesh;
    try
    {
        mesh = readTetMesh(exact.data(), exact.size(), format);
    }
    catch (const std::runtime_error& error)
    {
        EXPECT_STRNE(error.what(), "");
        return false;
    }
    EXPECT_FALSE(mesh.m_tets.empty());
    EXPECT_EQ(mesh.m_nodeNumbers.size(), mesh.m_positions.size());
    for (const Vec3& x : mesh.m_positions) EXPECT_TRUE(isFinite(x));
    std::vector<char> used(mesh.m_positions.size(), 0);
    for (const Tet& tet : mesh.m_tets)
        for (const int i : tet)
        {
            const bool inside = i >= 0 && i < static_cast<int>(used.size());
            EXPECT_TRUE(inside) << i;
            if (inside) used[i] = 1;
        }
    EXPECT_EQ(std::count(used.begin(), used.end(), 0), 0);
    return true;
}

class TetDamageTest : public testing::TestWithParam<TetFixture>
{
};

TEST_P(TetDamageTest, TruncationGivesAnErrorOrAMesh)
{
    const TetFixture& file = GetParam();
    int whole = 0;
    for (std::size_t size = 0; size < file.bytes.size(); ++size)
        whole += readsWhole(file.bytes.substr(0, size), file.format);
    // The bytes after the tetrahedra may be cut off, and in text formats digits of the last number.
    EXPECT_LE(whole, static_cast<int>(file.bytes.size()) / 2);
    EXPECT_FALSE(readsWhole(file.bytes.substr(0, file.bytes.size() / 2), file.format));
}

TEST_P(TetDamageTest, MutationGivesAnErrorOrAMesh)
{
    const TetFixture& file = GetParam();
    std::mt19937 random(1);
    const auto below = [&](std::size_t end) { return std::uniform_int_distribution<std::size_t>(0, end - 1)(random); };
    const std::string likely = std::string("0123456789 -.#$<>=\"\n\xff\x7f\x80") + '\0';
    for (int trial = 0; trial < 1000; ++trial)
    {
        std::string bytes = file.bytes;
        for (std::size_t changes = 1 + below(4); changes > 0; --changes)
        {
            const std::size_t at = below(bytes.size());
            switch (below(5))
            {
                case 0:
                    bytes[at] = likely[below(likely.size())];
                    break;
                case 1:
                    bytes[at] = static_cast<char>(bytes[at] ^ 1 << below(8));
                    break;
                case 2:
                    bytes.insert(at, 1, likely[below(likely.size())]);
                    break;
                case 3:
                    bytes.erase(at, 1 + below(8));
                    break;
                default:
                    bytes.insert(at, bytes.substr(below(bytes.size()), below(40)));
            }
            if (bytes.empty()) bytes = "0";
        }
        readsWhole(bytes, file.format);
    }
}

INSTANTIATE_TEST_SUITE_P(Formats, TetDamageTest, testing::ValuesIn(tetFixtures()),
                         [](const auto& fixture) { return fixture.param.name; });

TEST(TetDamage, NestedXmlIsAnError)
{
    std::string deep;
    for (int i = 0; i < 100000; ++i) deep += "<a>";
    EXPECT_FALSE(readsWhole(deep, TetMeshFormat::vtu));
}

TEST(TetDamage, EmptyInputIsAnError)
{
    for (const TetMeshFormat format :
         {TetMeshFormat::gmsh, TetMeshFormat::tetgen, TetMeshFormat::vtk, TetMeshFormat::vtu, TetMeshFormat::medit})
        EXPECT_THROW(readTetMesh(nullptr, 0, format), std::runtime_error);
}

/// A .vtu file whose points decompress to as many zeros as a deflated megabyte can hold.
TEST(TetDamage, BombsOfZlibAreRefused)
{
    constexpr std::size_t blocks = 200, blockBytes = std::size_t{1} << 20;
    const std::string zeros(blockBytes, '\0');
    std::string block(compressBound(blockBytes), '\0');
    uLongf size = block.size();
    ASSERT_EQ(compress(reinterpret_cast<Bytef*>(block.data()), &size, reinterpret_cast<const Bytef*>(zeros.data()),
                       blockBytes),
              Z_OK);
    block.resize(size);
    std::string data;
    const auto count = [&](std::size_t number)
    {
        for (int i = 0; i < 4; ++i) data += static_cast<char>(number >> 8 * i & 0xff);
    };
    count(blocks), count(blockBytes), count(0);
    for (std::size_t b = 0; b < blocks; ++b) count(block.size());
    for (std::size_t b = 0; b < blocks; ++b) data += block;
    const std::string file =
        "<VTKFile type=\"UnstructuredGrid\" compressor=\"vtkZLibDataCompressor\"><UnstructuredGrid>"
        "<Piece NumberOfPoints=\"8738133\" NumberOfCells=\"1\"><Points>"
        "<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"appended\" offset=\"0\"/></Points></Piece>"
        "</UnstructuredGrid><AppendedData encoding=\"raw\">_" +
        data + "</AppendedData></VTKFile>";
    EXPECT_THAT(messageOf<std::runtime_error>([&] { readTetMesh(file.data(), file.size(), TetMeshFormat::vtu); }),
                testing::HasSubstr("far more numbers than it has bytes"));
}

/// Components that share one array of points.
TEST(TetDamage, ArraysUsedAgainAndAgainAreRefused)
{
    constexpr int points = 4000, pieces = 400;
    std::string file = "<VTKFile type=\"UnstructuredGrid\" header_type=\"UInt64\"><UnstructuredGrid>";
    for (int i = 0; i < pieces; ++i)
        file += "<Piece NumberOfPoints=\"" + std::to_string(points) +
                "\" NumberOfCells=\"0\"><Points><DataArray type=\"Float64\" format=\"appended\" offset=\"0\"/></Points>"
                "<Cells><DataArray type=\"Int8\" Name=\"connectivity\"/><DataArray type=\"Int8\" Name=\"offsets\"/>"
                "<DataArray type=\"Int8\" Name=\"types\"/></Cells></Piece>";
    file += "</UnstructuredGrid><AppendedData encoding=\"raw\">_";
    for (int i = 0; i < 8; ++i) file += static_cast<char>(std::uint64_t{points} * 24 >> 8 * i & 0xff);
    file += std::string(points * 24, '\0') + "</AppendedData></VTKFile>";
    EXPECT_THAT(messageOf<std::runtime_error>([&] { readTetMesh(file.data(), file.size(), TetMeshFormat::vtu); }),
                testing::HasSubstr("far more numbers than it has bytes"));
}

}  // namespace
}  // namespace bullet_fem
