// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/io/tet_mesh_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "bullet_fem/fem/mesh/generators.h"
#include "bullet_fem/io/tet_mesh_file.h"
#include "io/temporary_folder.h"

namespace bullet_fem
{
namespace
{

using testing::AllOf;
using testing::HasSubstr;

/// A ball, moved and scaled to coordinates with all digits and many magnitudes; one of them is -0.
TetMesh awkwardMesh()
{
    const TetMesh ball = makeSphere(1. / 3, 6);
    std::vector<Vec3> positions = ball.restPositions();
    for (std::size_t i = 0; i < positions.size(); ++i)
    {
        Vec3& x = positions[i];
        x = {x.x * 1e-7, x.y * 1e-7 + 1e-9, x.z * 1e-7};
        if (x.z == 0) x.z = -0.0;
    }
    return TetMesh(positions, ball.tets());
}

bool sameBits(const Vec3& a, const Vec3& b)
{
    for (int c = 0; c < 3; ++c)
        if (const double p = a[c], q = b[c]; std::memcmp(&p, &q, sizeof p) != 0) return false;
    return true;
}

class TetMeshWriter : public testing::TestWithParam<const char*>
{
};

TEST_P(TetMeshWriter, IsReadBackToTheSameBits)
{
    const TemporaryFolder folder;
    for (const TetMesh& mesh : {awkwardMesh(), makeBox({1e5 / 3, 2e4, 7e4}, {3, 2, 2}, {1e9, -1e-9, 0.1})})
    {
        const std::string path = folder.path(std::string("mesh") + GetParam());
        writeTetMeshFile(path, mesh);
        const TetMesh read = readTetMeshFile(path).mesh();
        ASSERT_EQ(read.nodeCount(), mesh.nodeCount());
        EXPECT_EQ(read.tets(), mesh.tets());
        for (int i = 0; i < mesh.nodeCount(); ++i)
            EXPECT_TRUE(sameBits(read.restPositions()[i], mesh.restPositions()[i])) << i;
    }
}

TEST_P(TetMeshWriter, KeepsRegions)
{
    const TemporaryFolder folder;
    const TetMesh mesh = makeBox({1, 1, 1}, {1, 1, 1});
    const std::vector<int> regions = {7, -2, 0, 2147483647, 7};
    const std::string path = folder.path(std::string("mesh") + GetParam());
    writeTetMeshFile(path, mesh, regions);
    const TetMeshFile read = readTetMeshFile(path);
    EXPECT_EQ(read.m_regions, regions);
    EXPECT_EQ(read.mesh().tets(), mesh.tets());
    EXPECT_THAT(messageOf<std::invalid_argument>(
                    [&] {
                        writeTetMeshFile(path, mesh, {1, 2});
                    }),
                HasSubstr("there are 2 regions for 5 elements; give one each, or none"));
}

TEST_P(TetMeshWriter, ReportsUnwritablePaths)
{
    const TemporaryFolder folder;
    const std::string path = folder.path(std::string("missing/mesh") + GetParam());
    EXPECT_THAT(messageOf<std::runtime_error>(
                    [&] {
                        writeTetMeshFile(path, makeBox({1, 1, 1}, {1, 1, 1}));
                    }),
                AllOf(HasSubstr("missing/mesh."), HasSubstr("No such file")));
    EXPECT_FALSE(std::filesystem::exists(folder.path("missing")));
}

std::string formatName(const testing::TestParamInfo<const char*>& info)
{
    return std::string(info.param + 1) + (info.param[1] == 'M' ? "UpperCase" : "");
}

INSTANTIATE_TEST_SUITE_P(Formats, TetMeshWriter,
                         testing::Values(".msh", ".vtk", ".vtu", ".mesh", ".node", ".ele", ".MSH"), formatName);

TEST(TetMeshWriterEndings, OthersAreRefusedAndNothingIsWritten)
{
    const TemporaryFolder folder;
    for (const char* name : {"mesh.vtp", "mesh.stl", "mesh", "mesh.msh.gz"})
    {
        const std::string path = folder.path(name);
        EXPECT_THAT(messageOf<std::runtime_error>(
                        [&] {
                            writeTetMeshFile(path, makeBox({1, 1, 1}, {1, 1, 1}));
                        }),
                    AllOf(HasSubstr("'" + path + "'"), HasSubstr("must be .msh, .vtk, .vtu, .mesh, .node or .ele")));
        EXPECT_THAT(messageOf<std::runtime_error>([&] { checkTetMeshOutput(path); }),
                    HasSubstr("must be .msh, .vtk, .vtu, .mesh, .node or .ele"));
        EXPECT_FALSE(std::filesystem::exists(path));
    }
}

TEST(TetMeshWriterEndings, OneTetGenFileIsNotWrittenWithoutTheOther)
{
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder.path("a.ele"));
    const auto refused = [&](const auto& act) { EXPECT_THAT(messageOf<std::runtime_error>(act), HasSubstr("a.ele'")); };
    refused([&] { checkTetMeshOutput(folder.path("a.node")); });
    refused([&] { writeTetMeshFile(folder.path("a.node"), makeBox({1, 1, 1}, {1, 1, 1})); });
    EXPECT_THAT(folder.names(), testing::ElementsAre("a.ele"));
}

TEST(TetMeshWriterEndings, BothTetGenFilesAreWritten)
{
    const TemporaryFolder folder;
    writeTetMeshFile(folder.path("a.ele"), makeBox({1, 1, 1}, {1, 1, 1}));
    EXPECT_THAT(folder.read("a.node"), testing::StartsWith("8 3 0 0\n0 "));
    EXPECT_THAT(folder.read("a.ele"), testing::StartsWith("5 4 0\n0 "));
}

}  // namespace
}  // namespace bullet_fem
