// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Mesh files are loaded into bodies by a background thread.
#include "tools/scene/mesh_loading.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "io/temporary_folder.h"
#include "tools/mesh_files.h"

namespace bullet_fem
{
namespace
{

MeshRequest requestOf(const std::string& path, int tets = 300)
{
    MeshRequest request;
    request.m_path = path;
    request.m_cage.m_targetTets = tets;
    request.m_cage.m_maxTets = 5000000;
    request.m_bake.m_material = Material::rubber();
    return request;
}

void waitFor(const MeshLoading& loading)
{
    for (double share = 0; !loading.finished(); std::this_thread::sleep_for(std::chrono::milliseconds(1)))
    {
        const double now = loading.share();
        ASSERT_GE(now, share);
        ASSERT_LE(now, 1);
        ASSERT_STRNE(loading.stage(), "");
        share = now;
    }
}

class MeshLoadingTest : public testing::Test
{
protected:
    std::string refusal(const MeshRequest& request)
    {
        MeshLoading loading(request);
        waitFor(loading);
        return messageOf<std::exception>([&] { loading.take(); });
    }
    void write(const std::string& name, const std::string& text) { std::ofstream(m_folder.path(name)) << text; }

    TemporaryFolder m_folder;
};

TEST_F(MeshLoadingTest, ASurfaceGetsACageAndAFactor)
{
    writeBall(m_folder.path("ball.off"), 2, 12);
    MeshRequest request = requestOf(m_folder.path("ball.off"));
    request.m_scale = 0.5;
    MeshLoading loading(request);
    waitFor(loading);
    EXPECT_EQ(loading.share(), 1);
    const BakedBody body = loading.take();
    ASSERT_TRUE(body.m_model);
    EXPECT_NEAR(body.m_model->mesh().tetCount(), 300, 60);
    double mass = 0;
    for (const double inverse : body.m_inverseMass) mass += 1 / inverse;
    EXPECT_NEAR(mass, 4. / 3 * 3.14159 * Material::rubber().m_density, 0.04 * mass)
        << "of a ball of radius 1, less facets";
    EXPECT_EQ(body.m_triangles.size(), 2u * 24 * 11) << "the surface follows";
}

TEST_F(MeshLoadingTest, TetrahedraStayAsTheyAre)
{
    write("one.node", "4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n");
    write("one.ele", "1 4 0\n0 0 1 2 3\n");
    MeshLoading loading(requestOf(m_folder.path("one.node")));
    waitFor(loading);
    EXPECT_EQ(loading.take().m_model->mesh().tetCount(), 1);
}

TEST_F(MeshLoadingTest, ReportsFaultsWithTheFile)
{
    using testing::AllOf;
    using testing::HasSubstr;
    write("broken.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n");
    write("flat.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    write("noise.stl", std::string(3000, '7'));
    write("empty.msh", "");
    write("song.mp3", "la");
    write("bad.bfem", "no body");
    for (const char* name : {"broken.off", "flat.off", "noise.stl", "empty.msh", "song.mp3", "bad.bfem", "missing.ply"})
    {
        const std::string words = refusal(requestOf(m_folder.path(name)));
        EXPECT_THAT(words, HasSubstr(m_folder.path(name))) << words;
        EXPECT_LT(words.size(), 1200u);
    }
    writeBall(m_folder.path("ball.off"), 1, 6);
    MeshRequest regions = requestOf(m_folder.path("ball.off"));
    regions.m_bake.m_regionMaterials[1] = Material::foam();
    EXPECT_THAT(refusal(regions), AllOf(HasSubstr("ball.off"), HasSubstr("no regions")));
    MeshRequest large = requestOf(m_folder.path("ball.off"));
    large.m_bake.m_maxBytes = 1000;
    EXPECT_THAT(refusal(large), HasSubstr("ball.off"));
}

TEST_F(MeshLoadingTest, CanBeCancelled)
{
    writeBall(m_folder.path("ball.off"), 1, 40);
    MeshLoading loading(requestOf(m_folder.path("ball.off"), 400000));
    loading.cancel();
    waitFor(loading);
    EXPECT_LT(loading.share(), 0.6) << "before the factor";
    EXPECT_THROW(loading.take(), CageCancelled);
}

}  // namespace
}  // namespace bullet_fem
