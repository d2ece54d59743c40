// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Each output file of bulletfem, on a path or disk that cannot be written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tools/program_run.h"
#include "tools/scene_samples.h"

namespace bullet_fem
{
namespace
{

using testing::AllOf;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

struct OutputCase
{
    const char* m_command;  // without the output
    const char* m_file;     // in the output folder
};

void PrintTo(const OutputCase& output, std::ostream* out)
{
    *out << output.m_command << ": " << output.m_file;
}

class ProgramOutput : public testing::TestWithParam<OutputCase>
{
protected:
    ProgramOutput()
    {
        writeSampleMeshes(m_samples);
        m_samples.write("scene.json",
                        R"({ "softBodies": [{ "name": "a", "mesh": { "box": [1, 1, 1], "tets": 40 } }],
                             "framesPerSecond": 1, "pictures": { "width": 64, "height": 48 } })");
    }

    bool isScene() const { return std::string(GetParam().m_command).find("simulate") == 0; }

    /// Runs the command with its output in a folder, after the shell commands `before`.
    ProgramRun run(const std::string& folder, const std::string& before = "", const char* seconds = "0.05") const
    {
        std::string line = "cd '" + m_samples.path("") + "'; " + before + " '" BULLETFEM_PROGRAM "' ";
        line += GetParam().m_command;
        line += isScene() ? std::string(" --seconds ") + seconds + " --out '" + folder + "'"
                          : " '" + folder + "/" + GetParam().m_file + "'";
        return runShell(line);
    }

    static bool cannotBeHad(const ProgramRun& run) { return run.m_output.find("install") != std::string::npos; }

    const TemporaryFolder m_samples, m_folder;
    const std::string m_file = m_folder.path(GetParam().m_file);
};

// A file size limit of zero acts as a full disk. By default the limit's signal ends a program without a message.
TEST_P(ProgramOutput, LeavesNothingOnAFullDisk)
{
    const ProgramRun full = run(m_folder.path(""), "ulimit -f 0;");
    if (cannotBeHad(full)) GTEST_SKIP() << full.m_output;
    EXPECT_EQ(full.m_code, 1) << full.m_output;
    EXPECT_THAT(full.m_output, HasSubstr("cannot write '" + m_folder.path("")));
    EXPECT_THAT(m_folder.names(), IsEmpty());
}

TEST_P(ProgramOutput, ReportsADeviceWithoutRoom)
{
    std::filesystem::create_symlink("/dev/full", m_file);
    const ProgramRun full = run(m_folder.path(""));
    if (cannotBeHad(full)) GTEST_SKIP() << full.m_output;
    EXPECT_EQ(full.m_code, 1) << full.m_output;
    EXPECT_THAT(full.m_output, AllOf(HasSubstr("cannot write '"), HasSubstr(GetParam().m_file), HasSubstr("No space")));
    EXPECT_TRUE(std::filesystem::is_symlink(m_file));
}

TEST_P(ProgramOutput, ReportsAPathBelowAFile)
{
    m_folder.write("file", "in the way");
    const ProgramRun blocked = run(m_folder.path("file/run"));
    if (cannotBeHad(blocked)) GTEST_SKIP() << blocked.m_output;
    EXPECT_EQ(blocked.m_code, 1) << blocked.m_output;
    EXPECT_THAT(blocked.m_output,
                AllOf(HasSubstr("cannot "), HasSubstr("'" + m_folder.path("file/run")), HasSubstr("Not a directory")));
    EXPECT_EQ(m_folder.read("file"), "in the way");
    EXPECT_THAT(m_folder.names(), ElementsAre("file"));
}

TEST_P(ProgramOutput, LeavesNoPartWhenInterrupted)
{
    if (!isScene()) GTEST_SKIP() << "it is done before it could be ended";
    const ProgramRun ended = run(m_folder.path(""), "timeout --preserve-status -s TERM 0.4", "1e5");
    if (cannotBeHad(ended)) GTEST_SKIP() << ended.m_output;
    EXPECT_EQ(ended.m_code, 128 + 15) << ended.m_output;
    EXPECT_THAT(m_folder.names(), Each(Not(HasSubstr(".part"))));
}

// More than a day of simulated time: an output that cannot be written is reported before.
TEST_P(ProgramOutput, IsTriedBeforeTheWork)
{
    std::filesystem::create_directory(m_file);
    const ProgramRun blocked = run(m_folder.path(""), "timeout 20", "1e5");
    if (cannotBeHad(blocked)) GTEST_SKIP() << blocked.m_output;
    EXPECT_EQ(blocked.m_code, 1) << blocked.m_output;
    EXPECT_THAT(blocked.m_output, AllOf(HasSubstr("cannot write '"), HasSubstr(GetParam().m_file),
                                        HasSubstr("it is a directory; give the name of a file")));
    EXPECT_TRUE(std::filesystem::is_directory(m_file));
}

std::string outputName(const testing::TestParamInfo<OutputCase>& info)
{
    std::string name = info.param.m_file;
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    return name;
}

INSTANTIATE_TEST_SUITE_P(
    Files, ProgramOutput,
    testing::Values(OutputCase{"simulate scene.json --pvd", "elements.pvd"},
                    OutputCase{"simulate scene.json --pvd", "surfaces_000000.vtu"},
                    OutputCase{"simulate scene.json --glb", "run.glb"},
                    OutputCase{"simulate scene.json --png", "strip.png"},
                    OutputCase{"simulate scene.json --film a.mp4", "a.mp4"},
                    OutputCase{"simulate scene.json --film a.gif", "a.gif"}, OutputCase{"convert two.node", "a.msh"},
                    OutputCase{"convert two.node", "a.vtk"}, OutputCase{"convert two.node", "a.mesh"},
                    OutputCase{"convert two.node", "a.node"}, OutputCase{"convert two.node", "a.ele"},
                    OutputCase{"convert two.node", "a.obj"}, OutputCase{"convert two.node", "a.ply"},
                    OutputCase{"cage cube.off -o", "cage.msh"}, OutputCase{"bake two.node -o", "a.bfem"}),
    outputName);

}  // namespace
}  // namespace bullet_fem
