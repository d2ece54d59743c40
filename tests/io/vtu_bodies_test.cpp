// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Frames of several bodies with all fields, in all encodings; this test decodes base64 and zlib itself.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstring>
#include <iterator>
#include <sstream>

#include "bullet_fem/io/tet_mesh_file.h"
#include "bullet_fem/io/vtu_writer.h"
#include "io/sample_bodies.h"
#include "io/temporary_folder.h"

namespace bullet_fem
{
namespace
{

using testing::AllOf;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

std::string base64Decoded(const std::string& text)
{
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    unsigned bits = 0, count = 0;
    for (const char c : text)
    {
        const std::size_t digit = digits.find(c);
        if (digit == std::string::npos) break;
        bits = bits << 6 | static_cast<unsigned>(digit);
        if ((count += 6) >= 8) bytes += static_cast<char>(bits >> (count -= 8) & 255);
    }
    return bytes;
}

std::uint64_t word(const std::string& bytes, std::size_t k)
{
    std::uint64_t value = 0;
    std::memcpy(&value, bytes.data() + 8 * k, 8);
    return value;
}

std::string unpacked(const std::string& text, bool compressed)
{
    if (!compressed)
    {
        const std::string bytes = base64Decoded(text);
        EXPECT_EQ(word(bytes, 0), bytes.size() - 8);
        return bytes.substr(8);
    }
    // The header is encoded separately; its length follows from its first word.
    const std::uint64_t blocks = word(base64Decoded(text.substr(0, 12)), 0);
    const std::size_t headerText = (8 * (3 + blocks) + 2) / 3 * 4;
    const std::string header = base64Decoded(text.substr(0, headerText)),
                      packed = base64Decoded(text.substr(headerText));
    std::string bytes;
    std::size_t begin = 0;
    for (std::uint64_t b = 0; b < blocks; ++b)
    {
        const bool isShort = b + 1 == blocks && word(header, 2) > 0;
        std::string block(isShort ? word(header, 2) : word(header, 1), '\0');
        uLongf size = block.size();
        EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(block.data()), &size,
                             reinterpret_cast<const Bytef*>(packed.data() + begin), word(header, 3 + b)),
                  Z_OK);
        EXPECT_EQ(size, block.size());
        begin += word(header, 3 + b);
        bytes += block;
    }
    EXPECT_EQ(begin, packed.size());
    return bytes;
}

template <class Number>
std::vector<double> numbersIn(const std::string& bytes)
{
    std::vector<Number> numbers(bytes.size() / sizeof(Number));
    if (!bytes.empty()) std::memcpy(numbers.data(), bytes.data(), bytes.size());
    return {numbers.begin(), numbers.end()};
}

/// The numbers of the DataArray `name` after `section`.
std::vector<double> numbersOf(const std::string& xml, const std::string& section, const std::string& name)
{
    const std::size_t array = xml.find("Name=\"" + name + "\"", xml.find("<" + section));
    EXPECT_NE(array, std::string::npos) << name;
    const std::size_t tag = xml.rfind('<', array), begin = xml.find('>', array) + 2, end = xml.find('<', begin);
    const std::string attributes = xml.substr(tag, begin - tag), text = xml.substr(begin, end - begin);
    if (attributes.find("\"ascii\"") != std::string::npos)
    {
        std::istringstream stream(text);
        return {std::istream_iterator<double>(stream), {}};
    }
    const std::string bytes = unpacked(text, xml.find("vtkZLibDataCompressor") != std::string::npos);
    if (attributes.find("Float32") != std::string::npos) return numbersIn<float>(bytes);
    if (attributes.find("Int32") != std::string::npos) return numbersIn<std::int32_t>(bytes);
    return numbersIn<std::uint8_t>(bytes);
}

std::string written(const std::vector<BodyFrame>& bodies, VtuEncoding encoding)
{
    const TemporaryFolder folder;
    VtuSeries series(folder.path("out"), "run", encoding);
    series.writeBodies(0.5, bodies);
    EXPECT_THAT(folder.read("out/run.pvd"), HasSubstr("timestep=\"0.5\" part=\"0\" file=\"run_000000.vtu\""));
    return folder.read("out/run_000000.vtu");
}

class VtuBodies : public testing::TestWithParam<VtuEncoding>
{
protected:
    const std::vector<BodyFrame> m_bodies = {sampleBox(0, 0.5), sampleTriangle(7), sampleBox(2)};
    const std::string m_xml = written(m_bodies, GetParam());
};

// Two boxes of 27 nodes and 40 tetrahedra, and a triangle between them.
TEST_P(VtuBodies, CellsOfAllBodiesShareOneVtkBlock)
{
    EXPECT_THAT(m_xml, HasSubstr("NumberOfPoints=\"57\" NumberOfCells=\"81\""));
    const std::vector<double> points = numbersOf(m_xml, "Points", "Points"),
                              nodes = numbersOf(m_xml, "Cells", "connectivity"),
                              offsets = numbersOf(m_xml, "Cells", "offsets"),
                              types = numbersOf(m_xml, "Cells", "types"), body = numbersOf(m_xml, "CellData", "body");
    ASSERT_EQ(points.size(), 3u * 57);
    ASSERT_EQ(nodes.size(), 4u * 40 + 3 + 4 * 40);
    ASSERT_EQ(types.size(), 81u);
    ASSERT_EQ(body.size(), 81u);
    for (int k = 0; k < 4; ++k)
    {
        EXPECT_EQ(nodes[4 * 39 + k], m_bodies[0].m_tets[39][k]);
        EXPECT_EQ(nodes[163 + k], 30 + m_bodies[2].m_tets[0][k]);
    }
    EXPECT_THAT(std::vector<double>(nodes.begin() + 160, nodes.begin() + 163), ElementsAre(27, 28, 29));
    EXPECT_THAT(std::vector<double>(offsets.begin() + 39, offsets.begin() + 42), ElementsAre(160, 163, 167));
    EXPECT_THAT(std::vector<double>(types.begin() + 39, types.begin() + 42), ElementsAre(10, 5, 10));
    EXPECT_THAT(std::vector<double>(body.begin() + 39, body.begin() + 42), ElementsAre(0, 7, 2));
    EXPECT_NEAR(points[3 * 26], m_bodies[0].m_positions[26].x, 1e-7);
}

// The file is read back with the mesh file's regions.
TEST_P(VtuBodies, RegionsOfBodiesWithoutAnyAreZero)
{
    EXPECT_THAT(m_xml, Not(HasSubstr("region")));
    std::vector<BodyFrame> bodies = m_bodies;
    for (int e = 0; e < 40; ++e) bodies[2].m_tetRegion.push_back(e < 7 ? -3 : 12);
    const std::string xml = written(bodies, GetParam());
    const std::vector<double> regions = numbersOf(xml, "CellData", "region");
    ASSERT_EQ(regions.size(), 81u);
    EXPECT_THAT(std::vector<double>(regions.begin() + 39, regions.begin() + 49),
                ElementsAre(0, 0, -3, -3, -3, -3, -3, -3, -3, 12));
    const std::vector<int> read = readTetMesh(xml.data(), xml.size(), TetMeshFormat::vtu).m_regions;
    ASSERT_EQ(read.size(), 80u);
    EXPECT_EQ(read[40], -3);
    EXPECT_EQ(read[79], 12);
}

TEST_P(VtuBodies, FieldsOfBodiesWithoutAnyAreZero)
{
    for (const char* name : {"displacement", "velocity", "contact_force", "reaction_force"})
        EXPECT_EQ(numbersOf(m_xml, "PointData", name).size(), 3u * 57) << name;
    EXPECT_EQ(numbersOf(m_xml, "PointData", "displacement")[2], 0.5);
    EXPECT_EQ(numbersOf(m_xml, "PointData", "velocity")[2], 1);
    EXPECT_EQ(numbersOf(m_xml, "PointData", "contact_force")[2], 4);
    EXPECT_EQ(numbersOf(m_xml, "PointData", "reaction_force")[0], 7);
    const std::vector<double> stress = numbersOf(m_xml, "PointData", "stress"),
                              vonMisesOfNodes = numbersOf(m_xml, "PointData", "von_mises");
    ASSERT_EQ(stress.size(), 6u * 57);
    ASSERT_EQ(vonMisesOfNodes.size(), 57u);
    EXPECT_THAT(std::vector<double>(stress.begin() + 6 * 26, stress.begin() + 6 * 27),
                ElementsAre(1500, 0, 0, 10, 0, 0));
    EXPECT_NEAR(vonMisesOfNodes[26], std::sqrt(1500.0 * 1500 + 300), 1e-3);
    for (int i = 6 * 27; i < 6 * 30; ++i) EXPECT_EQ(stress[i], 0);
    EXPECT_THAT(m_xml, HasSubstr("Scalars=\"von_mises\" Vectors=\"displacement\""));
}

TEST_P(VtuBodies, StressOfCellsIsInVtksOrder)
{
    const std::vector<double> stress = numbersOf(m_xml, "CellData", "stress");
    ASSERT_EQ(stress.size(), 6u * 81);
    EXPECT_THAT(std::vector<double>(stress.begin() + 6, stress.begin() + 12), ElementsAre(1, 2, 3, 4, 5, 6));
    EXPECT_THAT(std::vector<double>(stress.begin() + 6 * 40, stress.begin() + 6 * 41), Each(0));
    EXPECT_NEAR(numbersOf(m_xml, "CellData", "von_mises")[1], std::sqrt(3.0 + 3 * (16 + 25 + 36)), 1e-5);
    EXPECT_THAT(m_xml, HasSubstr("ComponentName0=\"XX\" ComponentName1=\"YY\" ComponentName2=\"ZZ\" "
                                 "ComponentName3=\"XY\" ComponentName4=\"YZ\" ComponentName5=\"XZ\""));
}

TEST_P(VtuBodies, CellsHaveTheirPlasticStrain)
{
    const std::vector<double> strain = numbersOf(m_xml, "CellData", "plastic_strain");
    ASSERT_EQ(strain.size(), 81u);
    EXPECT_NEAR(strain[2], 0.02, 1e-8);
    EXPECT_EQ(strain[40], 0);
}

TEST_P(VtuBodies, CellsHaveTheActivationOfTheirFibres)
{
    const std::vector<double> activation = numbersOf(m_xml, "CellData", "activation");
    ASSERT_EQ(activation.size(), 81u);
    EXPECT_EQ(activation[3], -300);
    EXPECT_EQ(activation[40], 0);
    EXPECT_EQ(activation[80], -3900);
    std::vector<BodyFrame> bodies = m_bodies;
    for (BodyFrame& body : bodies) body.m_tetActivation.clear();
    EXPECT_THAT(written(bodies, GetParam()), Not(HasSubstr("activation")));
}

TEST_P(VtuBodies, MayBeEmpty)
{
    const std::string xml = written({}, GetParam());
    EXPECT_THAT(xml, AllOf(HasSubstr("NumberOfPoints=\"0\" NumberOfCells=\"0\""), Not(HasSubstr("stress"))));
    EXPECT_TRUE(numbersOf(xml, "Points", "Points").empty());
}

std::string encodingName(const testing::TestParamInfo<VtuEncoding>& info)
{
    constexpr const char* names[] = {"text", "binary", "compressed"};
    return names[static_cast<int>(info.param)];
}

INSTANTIATE_TEST_SUITE_P(Encodings, VtuBodies,
                         testing::Values(VtuEncoding::text, VtuEncoding::binary, VtuEncoding::compressed),
                         encodingName);

// 21,483 nodes and 96,000 cells: each array has more than one compressed block.
TEST(VtuEncodings, BinaryIsSmallerAndCompressedSmallerStill)
{
    BodyFrame body;
    const TetMesh mesh = makeBox({1, 1.37, 0.71}, {30, 32, 20});
    body.m_positions = mesh.restPositions();
    body.m_tets = mesh.tets();
    body.m_velocity = mesh.restPositions();
    const std::string text = written({body}, VtuEncoding::text), binary = written({body}, VtuEncoding::binary),
                      compressed = written({body}, VtuEncoding::compressed);
    EXPECT_EQ(numbersOf(compressed, "Cells", "connectivity"), numbersOf(text, "Cells", "connectivity"));
    EXPECT_EQ(numbersOf(compressed, "Points", "Points"), numbersOf(binary, "Points", "Points"));
    EXPECT_LT(compressed.size(), binary.size() / 2);
    RecordProperty("bytes", std::to_string(text.size()) + " " + std::to_string(binary.size()) + " " +
                                std::to_string(compressed.size()));
}

TEST(VtuBodiesInput, RejectsInconsistentArrays)
{
    const TemporaryFolder folder;
    VtuSeries series(folder.path("out"), "run");
    const auto rejected = [&](const auto& spoil)
    {
        BodyFrame body = sampleBox(3);
        spoil(body);
        return messageOf<std::invalid_argument>([&] { series.writeBodies(0, {sampleTriangle(0), body}); });
    };
    EXPECT_THAT(rejected([](BodyFrame& b) { b.m_velocity.pop_back(); }),
                HasSubstr("body 1: 26 velocities for 27 vertices; give as many, or none"));
    EXPECT_THAT(rejected([](BodyFrame& b) { b.m_tetStress.push_back({}); }),
                HasSubstr("41 stresses for 40 tetrahedra"));
    EXPECT_THAT(rejected([](BodyFrame& b) { b.m_tetRegion.push_back(1); }), HasSubstr("1 regions for 40 tetrahedra"));
    EXPECT_THAT(rejected([](BodyFrame& b) { b.m_nodeStress.push_back({}); }), HasSubstr("stress"));
    EXPECT_THAT(rejected([](BodyFrame& b) { b.m_contactForce[3].y = 1e39; }),
                HasSubstr("contact force of vertex 3 is not finite in single precision"));
    EXPECT_THAT(rejected([](BodyFrame& b) { b.m_reactionForce.pop_back(); }),
                HasSubstr("26 reaction forces for 27 vertices; give as many, or none"));
    EXPECT_THAT(rejected([](BodyFrame& b) { b.m_tetPlasticStrain.pop_back(); }), HasSubstr("plastic strains for"));
    EXPECT_THAT(rejected([](BodyFrame& b) { b.m_tetPlasticStrain[4] = NAN; }),
                HasSubstr("plastic strain of tetrahedron 4"));
    EXPECT_THAT(rejected([](BodyFrame& b) { b.m_tetActivation.pop_back(); }),
                HasSubstr("39 activations for 40 tetrahedra; give as many, or none"));
    EXPECT_THAT(rejected([](BodyFrame& b) { b.m_tetActivation[6] = INFINITY; }),
                HasSubstr("activation of tetrahedron 6"));
    EXPECT_THAT(rejected([](BodyFrame& b) { b.m_tetStress[5].yz = NAN; }), HasSubstr("stress of tetrahedron 5"));
    EXPECT_THAT(rejected([](BodyFrame& b) { b.m_tets[4][2] = 27; }),
                HasSubstr("tetrahedron 4 uses vertex 27, which is not in [0, 27)"));
    EXPECT_EQ(series.frameCount(), 0);
    EXPECT_FALSE(std::filesystem::exists(folder.path("out/run_000000.vtu")));
}

TEST(VtuBodiesInput, ReportsAMissingFolder)
{
    const TemporaryFolder folder;
    VtuSeries series(folder.path("out"), "run");
    std::filesystem::remove_all(folder.path("out"));
    EXPECT_THAT(messageOf<std::runtime_error>([&] { series.writeBodies(0, {sampleBox(0)}); }),
                AllOf(HasSubstr("out/run_000000.vtu'"), HasSubstr("No such file")));
    EXPECT_EQ(series.frameCount(), 0);
}

}  // namespace
}  // namespace bullet_fem
