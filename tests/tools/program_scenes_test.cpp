// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
// bulletfem simulate on the scenes of demos/scenes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "io/temporary_folder.h"
#include "tools/program_run.h"

namespace bullet_fem
{
namespace
{

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

class ProgramScene : public testing::TestWithParam<const char*>
{
protected:
    ProgramRun simulate(const std::string& options, const std::string& seconds = "0.2") const
    {
        return bulletfem("simulate '" BULLETFEM_SCENES "/" + std::string(GetParam()) + ".json' --json --seconds " +
                         seconds + " -o '" + m_folder.path("run") + "' " + options);
    }
    std::string file(const std::string& name) const { return m_folder.read("run/" + name); }

    TemporaryFolder m_folder;
};

TEST_P(ProgramScene, GivesSeriesForParaViewAndAFilmForTheWeb)
{
    const ProgramRun run = simulate("--pvd --glb");
    ASSERT_EQ(run.m_code, 0) << run.m_output;
    const json told = json::parse(run.m_output);
    EXPECT_EQ(told["files"].size(), 3u);
    for (const json& name : told["files"]) EXPECT_TRUE(std::filesystem::is_regular_file(name.get<std::string>()));
    EXPECT_EQ(told["frames"], 7) << "thirty a second, and the first";
    EXPECT_GT(told["tets"].get<int>(), 500);
    EXPECT_TRUE(told["flags"].empty()) << told["flags"];
    EXPECT_TRUE(told["faults"].empty()) << told["faults"];
    EXPECT_THAT(file("elements.pvd"),
                AllOf(HasSubstr("elements_000000.vtu"), HasSubstr("elements_000006.vtu"), HasSubstr("</VTKFile>")));
    const std::string last = file("elements_000006.vtu");
    for (const char* name : {"displacement", "velocity", "von_mises", "contact_force"})
        EXPECT_NE(last.find("Name=\"" + std::string(name)), std::string::npos) << name;
    EXPECT_THAT(file("surfaces.pvd"), HasSubstr("surfaces_000006.vtu"));
    const std::string film = file("run.glb");
    EXPECT_EQ(film.substr(0, 4), "glTF");
    EXPECT_NE(film.find("\"targets\""), std::string::npos) << "morph targets";
}

TEST_P(ProgramScene, GivesPictures)
{
    const ProgramRun run = simulate("--png --stress");
    if (run.m_output.find("install") != std::string::npos) GTEST_SKIP() << run.m_output;
    ASSERT_EQ(run.m_code, 0) << run.m_output;
    for (const char* name : {"first.png", "last.png", "strip.png"})
    {
        EXPECT_EQ(file(name).substr(0, 4), "\x89PNG") << name;
        EXPECT_GT(file(name).size(), 20000u) << "a picture of one colour has less";
    }
    EXPECT_TRUE(file("first.png") != file("last.png"));
}

TEST_P(ProgramScene, AStripOfTwoFramesEndsWithTheLast)
{
    const ProgramRun run = simulate("--png", "0.01");
    if (run.m_output.find("install") != std::string::npos) GTEST_SKIP() << run.m_output;
    ASSERT_EQ(run.m_code, 0) << run.m_output;
    EXPECT_EQ(json::parse(run.m_output)["frames"], 2);
    EXPECT_TRUE(file("first.png") != file("last.png")) << "their captions differ, at least";
}

TEST_P(ProgramScene, GivesAFilm)
{
    if (runShell("command -v ffmpeg").m_code != 0) GTEST_SKIP() << "ffmpeg is not in PATH";
    const ProgramRun run = simulate("--film a.mp4");
    if (run.m_output.find("install") != std::string::npos) GTEST_SKIP() << run.m_output;
    ASSERT_EQ(run.m_code, 0) << run.m_output;
    EXPECT_THAT(file("a.mp4").substr(4, 4), "ftyp");
    EXPECT_GT(file("a.mp4").size(), 10000u);
}

std::string sceneName(const testing::TestParamInfo<const char*>& info)
{
    return info.param;
}

INSTANTIATE_TEST_SUITE_P(Demos, ProgramScene, testing::Values("beam", "press", "hammer"), sceneName);

}  // namespace
}  // namespace bullet_fem
