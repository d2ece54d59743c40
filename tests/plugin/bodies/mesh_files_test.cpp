// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors

// Bullet's readers accept the files that BulletFEM::io writes.
#include <gtest/gtest.h>

#include <memory>

#include "BulletSoftBody/btSoftBodyHelpers.h"
#include "bullet_fem/fem/mesh/generators.h"
#include "bullet_fem/io/tet_mesh_file.h"
#include "bullet_fem/io/tet_mesh_writer.h"
#include "io/temporary_folder.h"

namespace bullet_fem
{
namespace
{

/// Nodes and tetrahedra equal those of the mesh, in its order.
void expectMesh(const btSoftBody& body, const TetMesh& mesh)
{
    ASSERT_EQ(body.m_nodes.size(), mesh.nodeCount());
    ASSERT_EQ(body.m_tetras.size(), mesh.tetCount());
    for (int i = 0; i < mesh.nodeCount(); ++i)
        for (int c = 0; c < 3; ++c)
            EXPECT_FLOAT_EQ(static_cast<float>(body.m_nodes[i].m_x[c]), static_cast<float>(mesh.restPositions()[i][c]));
    for (int e = 0; e < mesh.tetCount(); ++e)
        for (int a = 0; a < 4; ++a) EXPECT_EQ(body.m_tetras[e].m_n[a] - &body.m_nodes[0], mesh.tets()[e][a]) << e;
}

class FilesForBullet : public ::testing::TestWithParam<bool>
{
protected:
    FilesForBullet() : m_mesh(makeBox({1, 2, 3}, {2, 3, 2}, {.1, .2, .3}))
    {
        if (GetParam()) m_regions.assign(m_mesh.tets().size(), 7);
    }

    TemporaryFolder m_folder;
    TetMesh m_mesh;
    std::vector<int> m_regions;
    btSoftBodyWorldInfo m_info;
};

TEST_P(FilesForBullet, AreReadByCreateFromTetGenData)
{
    const std::string path = m_folder.path("box.node");
    writeTetMeshFile(path, m_mesh, m_regions);
    const std::string node = m_folder.read("box.node"), ele = m_folder.read("box.ele");
    const std::unique_ptr<btSoftBody> body(
        btSoftBodyHelpers::CreateFromTetGenData(m_info, ele.c_str(), nullptr, node.c_str(), false, true, true));
    expectMesh(*body, m_mesh);
    EXPECT_EQ(readTetMeshFile(path).mesh().tets(), m_mesh.tets());
}

TEST_P(FilesForBullet, AreReadByCreateFromVtkFile)
{
    const std::string path = m_folder.path("box.vtk");
    writeTetMeshFile(path, m_mesh, m_regions);
    const std::unique_ptr<btSoftBody> body(btSoftBodyHelpers::CreateFromVtkFile(m_info, path.c_str()));
    expectMesh(*body, m_mesh);
}

INSTANTIATE_TEST_SUITE_P(Regions, FilesForBullet, ::testing::Bool(),
                         [](const auto& instance) { return instance.param ? "With" : "Without"; });

}  // namespace
}  // namespace bullet_fem
