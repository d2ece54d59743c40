// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
// The program bulletfem, from its command line: exit codes, messages, figures, files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "bullet_fem/io/tet_mesh_file.h"
#include "tools/program_run.h"
#include "tools/scene_samples.h"

namespace bullet_fem
{
namespace
{

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

class Program : public testing::Test
{
protected:
    Program() { writeSampleMeshes(m_folder); }
    std::string path(const std::string& name) const { return "'" + m_folder.path(name) + "'"; }
    bool exists(const std::string& name) const
    {
        return std::filesystem::exists(std::filesystem::symlink_status(m_folder.path(name)));
    }
    /// Runs a command that must succeed, and returns its --json figures.
    json figures(const std::string& arguments) const
    {
        const ProgramRun run = bulletfem(arguments + " --json");
        EXPECT_EQ(run.m_code, 0) << run.m_output;
        const json told = json::parse(run.m_output, nullptr, false);
        EXPECT_TRUE(told.is_object()) << run.m_output;
        return told;
    }
    void refused(const std::string& arguments, int code, const std::string& part) const
    {
        const ProgramRun run = bulletfem(arguments);
        EXPECT_EQ(run.m_code, code) << arguments << '\n' << run.m_output;
        EXPECT_THAT(run.m_output, HasSubstr(part)) << arguments;
    }

    TemporaryFolder m_folder;
};

TEST_F(Program, ExplainsItself)
{
    const ProgramRun all = bulletfem("--help");
    EXPECT_EQ(all.m_code, 0);
    EXPECT_THAT(all.m_output, AllOf(HasSubstr("Exit code: 0 if all is well, 1 on bad data, 2 on bad usage, 3 if")));
    for (const char* command : {"cage", "bake", "info", "convert", "simulate"})
    {
        EXPECT_THAT(all.m_output, HasSubstr(std::string("\n  ") + command + " ")) << command;
        const ProgramRun help = bulletfem(std::string(command) + " --help");
        EXPECT_EQ(help.m_code, 0);
        EXPECT_THAT(help.m_output, AllOf(HasSubstr("Usage"), HasSubstr(command))) << command;
    }
    EXPECT_EQ(bulletfem("--version").m_code, 0);
}

TEST_F(Program, ListsItsSubcommandsWithoutOne)
{
    const ProgramRun run = bulletfem("");
    EXPECT_EQ(run.m_code, 2) << "nothing was done";
    for (const char* command : {"cage", "bake", "info", "convert", "simulate"})
        EXPECT_THAT(run.m_output, HasSubstr(std::string("\n  ") + command + " ")) << command;
    EXPECT_THAT(run.m_output, HasSubstr("A subcommand is required"));
    EXPECT_EQ(run.m_output.find("\n  cage "), run.m_output.rfind("\n  cage ")) << "once";
}

TEST_F(Program, BadUsageIsToldWithItsRange)
{
    refused("mesh a.off", 2, "mesh");
    refused("simulate", 2, "scene is required");
    refused("simulate a.json --fast", 2, "--fast");
    refused("simulate --mesh a.off", 2, "--window");
    refused("simulate a.json --tets 50", 2, "--window");
    refused("simulate --window --scale 0", 2, "must be a number in");
    refused("simulate --window --history-memory 0", 2, "must be a number in [1, 65536]");
    refused("simulate a.json --seconds -1", 2, "is -1, must be a number in [1e-06, 100000]");
    refused("simulate a.json --seconds nan", 2, "is nan, must be a number in [1e-06, 100000]");
    refused("simulate a.json --film run.avi", 2, "run.avi must end in .mp4 or .gif");
    refused("bake a.msh -o a.bfem --young 0", 2, "must be a number in [0.001, 1e+13]");
    refused("bake a.msh -o a.bfem --poisson 0.5", 2, "must be a number in [0, 0.499]");
    refused("bake a.msh -o a.bfem --step 0", 2, "must be in [1e-6, 1] s");
    refused("bake a.msh -o a.bfem --step 1/0", 2, "must be in [1e-6, 1] s");
    refused("bake a.msh -o a.bfem --material gold", 2, "gold");
    refused("bake a.msh -o a.bfem --pin 1 2 3", 2, "--pin");
    refused("bake a.msh", 2, "--output is required");
    refused("cage a.off --tets 1", 2, "must be a number in [5, 5");
    refused("cage a.off --tets 100 --cell 1", 2, "excludes");
    refused("convert a.msh", 2, "output is required");
}

TEST_F(Program, BadDataIsToldWithTheFile)
{
    m_folder.write("bad.json", R"({ "step": 0, "softBodies": [] })");
    m_folder.write("damaged.off", "OFF\n3 1 0\n0 0 0\n");
    refused("simulate " + path("missing.json"), 1, m_folder.path("missing.json") + "': there is no such file");
    refused("simulate " + path("bad.json"), 1, "bad.json': step is 0; it must be a number in [1e-06, 1]");
    refused("info " + path("missing.off"), 1, m_folder.path("missing.off"));
    refused("info " + path("damaged.off"), 1, m_folder.path("damaged.off"));
    refused("info " + path("bad.json"), 1, m_folder.path("bad.json"));
    refused("cage " + path("two.node"), 1, "is no surface file; it must end in .off, .obj, .stl or .ply");
    refused("cage " + path("damaged.off"), 1, m_folder.path("damaged.off"));
    refused("cage " + path("cube.off") + " -o " + path("a.stl"), 1, "must be .msh, .vtk, .vtu, .mesh, .node or .ele");
    refused("convert " + path("cube.off") + " " + path("a.msh"), 1, "bulletfem cage makes them");
    refused("convert " + path("two.node") + " " + path("a.off"), 1, "surfaces are written as .obj or .ply");
    refused("bake " + path("damaged.off") + " -o " + path("a.bfem"), 1, m_folder.path("damaged.off"));
    refused("bake " + path("two.node") + " -o " + path("a.bfem") + " --pin 5 5 5 6 6 6", 1, "--pin box holds no node");
    for (const char* name : {"a.stl", "a.msh", "a.off", "a.bfem"}) EXPECT_FALSE(exists(name)) << name;
}

TEST_F(Program, CagesReportTheirFigures)
{
    const json told = figures("cage " + path("cube.off") + " --tets 600 -o " + path("cage.msh"));
    EXPECT_NEAR(told["tets"].get<double>(), 600, 300);
    EXPECT_NEAR(told["volume"].get<double>(), 1, 1e-6);
    EXPECT_GE(told["leastQuality"].get<double>(), told["qualityBound"].get<double>());
    const json mesh = figures("info " + path("cage.msh"));
    EXPECT_EQ(mesh["kind"], "tetrahedra");
    EXPECT_EQ(mesh["tets"], told["tets"]);
    EXPECT_EQ(mesh["nodes"], told["nodes"]);
    EXPECT_NEAR(mesh["volume"].get<double>() / told["volumeRatio"].get<double>(), 1, 1e-6);
}

TEST_F(Program, GradedCagesTellTheirSizes)
{
    m_folder.write("slab.off", R"(OFF
8 6 0
0 0 0
1 0 0
1 1 0
0 1 0
0 0 .1
1 0 .1
1 1 .1
0 1 .1
4 3 2 1 0
4 4 5 6 7
4 0 1 5 4
4 1 2 6 5
4 2 3 7 6
4 3 0 4 7
)");
    const json told = figures("cage " + path("slab.off") + " --cell 0.2 --grade 2 --levels 2");
    EXPECT_EQ(told["levels"], 2);
    EXPECT_NEAR(told["smallestCell"].get<double>(), 0.05, 1e-9);
    EXPECT_EQ(told["levelTets"][2], told["tets"]);
    EXPECT_EQ(figures("bake " + path("slab.off") + " --cell 0.2 --grade 2 --levels 2 -o " + path("slab.bfem"))["tets"],
              told["tets"]);
    EXPECT_FALSE(figures("cage " + path("slab.off") + " --cell 0.2").contains("levels"));
    refused("cage " + path("slab.off") + " --grade 9", 2, "--grade");
    refused("cage " + path("slab.off") + " --levels 2", 2, "--levels requires --grade");
}

TEST_F(Program, ConvertsWithoutLosingABit)
{
    ASSERT_EQ(bulletfem("convert " + path("two.node") + " " + path("a.vtk")).m_code, 0);
    ASSERT_EQ(bulletfem("convert " + path("a.vtk") + " " + path("b.MSH")).m_code, 0);
    ASSERT_EQ(bulletfem("convert " + path("b.MSH") + " " + path("c.node")).m_code, 0);
    EXPECT_EQ(m_folder.read("c.node"), m_folder.read("two.node"));
    EXPECT_EQ(m_folder.read("c.ele"), m_folder.read("two.ele"));
    ASSERT_EQ(bulletfem("convert " + path("body.bfem") + " " + path("d.node")).m_code, 0);
    EXPECT_EQ(m_folder.read("d.ele"), m_folder.read("two.ele"));
    ASSERT_EQ(bulletfem("convert " + path("two.ele") + " " + path("skin.ply") + " --scale 2").m_code, 0);
    const json skin = figures("info " + path("skin.ply"));
    EXPECT_EQ(skin["triangles"], 48);
    EXPECT_NEAR(skin["signedVolume"].get<double>(), 8, 1e-5);
}

TEST_F(Program, ConvertsToVtuWithRegions)
{
    ASSERT_EQ(bulletfem("convert " + path("regions.msh") + " " + path("a.vtu")).m_code, 0);
    EXPECT_EQ(figures("info " + path("a.vtu"))["region -2"], figures("info " + path("regions.msh"))["region -2"]);
    ASSERT_EQ(bulletfem("convert " + path("a.vtu") + " " + path("b.msh")).m_code, 0);
    ASSERT_EQ(bulletfem("convert " + path("regions.msh") + " " + path("c.msh")).m_code, 0);
    EXPECT_EQ(m_folder.read("b.msh"), m_folder.read("c.msh"));
    figures("bake " + path("regions.msh") + " --region 1:rubber --region=-2:foam -o " + path("r.bfem"));
    ASSERT_EQ(bulletfem("convert " + path("r.bfem") + " " + path("r.vtu")).m_code, 0);
    EXPECT_EQ(readTetMeshFile(m_folder.path("r.vtu")).m_regions,
              readTetMeshFile(m_folder.path("regions.msh")).m_regions);
    refused("convert " + path("cube.off") + " " + path("d.vtu"), 1, "bulletfem cage makes them");
    EXPECT_FALSE(exists("d.vtu"));
}

TEST_F(Program, ReportsFaultsOfAReadableFile)
{
    m_folder.write("one.vtk",
                   "# vtk DataFile Version 2.0\none\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n0 0 0\n1 0 0\n"
                   "0 1 0\n0 0 1\n\nCELLS 1 1\n4 0 1 2 3\n\nCELL_TYPES 10\n");
    const std::string sizes = "line 11: CELLS should state 5 numbers for 1 cells, not 1; read cell by cell";
    const json told = figures("info " + path("one.vtk"));
    EXPECT_EQ(told["note"], sizes);
    EXPECT_THAT(told["note 2"].get<std::string>(), HasSubstr("line 14: CELL_TYPES lists 0 types for 1 cells"));
    const ProgramRun run = bulletfem("convert " + path("one.vtk") + " " + path("one.vtu"));
    EXPECT_EQ(run.m_code, 0);
    EXPECT_THAT(run.m_output, HasSubstr("one.vtk: " + sizes + "\n"));
    EXPECT_FALSE(figures("info " + path("one.vtu")).contains("note"));
    m_folder.write("packed.msh", std::string("\x1f\x8b\x08\0\0", 5));
    refused("info " + path("packed.msh"), 1, "packed.msh': byte 0: it is a gzip archive, which is not read; unpack it");
}

TEST_F(Program, InfoReportsTheBakedBody)
{
    const json baked =
        figures("bake " + path("cube.off") + " --tets 300 --material jelly --young 2e4 --step 1/100 -o " +
                path("cube.bfem") + " --pin -1 -1 -1 2 0.01 2");
    const json told = figures("info " + path("cube.bfem"));
    EXPECT_EQ(told["kind"], "baked body");
    EXPECT_EQ(told["tets"], baked["tets"]);
    EXPECT_EQ(told["young"], 2e4);
    EXPECT_EQ(told["law"], "neoHooke");
    EXPECT_NEAR(told["poisson"].get<double>(), 0.45, 1e-6);
    EXPECT_NEAR(told["step"].get<double>(), 0.01, 1e-9);
    EXPECT_GT(told["pinned"].get<int>(), 3);
    EXPECT_EQ(told["pinned"], baked["pinned"]);
    EXPECT_EQ(told["embeddedVertices"], 8);
    EXPECT_EQ(told["bytes"].get<std::uintmax_t>(), std::filesystem::file_size(m_folder.path("cube.bfem")));
}

TEST_F(Program, BakesWithTheGivenLaw)
{
    const std::string bake = "bake " + path("two.node") + " -o " + path("law.bfem");
    const auto law = [&](const std::string& options)
    {
        figures(bake + options);
        return figures("info " + path("law.bfem")).value("law", "hooke");
    };
    EXPECT_EQ(law(" --material flesh"), "neoHooke");
    EXPECT_EQ(law(" --material flesh --law hooke --bending accurate"), "hooke");
    EXPECT_EQ(law(" --material foam"), "hooke");
    EXPECT_EQ(law(" --material foam --law neoHooke"), "neoHooke");
    EXPECT_EQ(law(" --material flesh --bending accurate"), "neoHooke");
    refused(bake + " --material flesh --bending accurate --mean-dilatation off", 1,
            "accurate bending does not go with mean dilatation off; take automatic or on");
}

TEST_F(Program, BakesWithTheGivenBending)
{
    const std::string bake = "bake " + path("two.node") + " -o " + path("bent.bfem");
    const auto element = [&](const std::string& options)
    {
        figures(bake + options);
        const json told = figures("info " + path("bent.bfem"));
        return told.value("bending", "") + ", mean dilatation " + told.value("meanDilatation", "");
    };
    EXPECT_EQ(element(""), "accurate, mean dilatation on");
    EXPECT_EQ(element(" --bending plain"), "plain, mean dilatation off");
    EXPECT_EQ(element(" --bending accurate"), "accurate, mean dilatation on");
    EXPECT_EQ(element(" --bending auto"), "accurate, mean dilatation on");
    EXPECT_EQ(element(" --bending auto --mean-dilatation off"), "plain, mean dilatation off");
    EXPECT_EQ(element(" --bending auto --material flesh"), "accurate, mean dilatation on");
}

TEST_F(Program, BakesRubberByItsHardness)
{
    const std::string bake = "bake " + path("two.node") + " -o " + path("rubber.bfem");
    figures(bake + " --shore-a 40 --loss 0.2 5");
    const json rubber = figures("info " + path("rubber.bfem"));
    EXPECT_NEAR(rubber["young"].get<double>() / 1.689639e6, 1, 1e-5);
    EXPECT_NEAR(rubber["poisson"].get<double>(), .499, 1e-6);
    figures(bake + " --shore-d 50 --poisson .45");
    EXPECT_NEAR(figures("info " + path("rubber.bfem"))["poisson"].get<double>(), .45, 1e-6);
    refused(bake + " --shore-a 5", 2, "must be a number in [10, 95]");
    refused(bake + " --shore-a 50 --shore-d 50", 2, "excludes");
    refused(bake + " --shore-a 50 --material foam", 2, "excludes");
    refused(bake + " --loss 0.2", 2, "--loss");
    refused(bake + " --loss 0.2 5 --stiffness-damping 0.1", 2, "excludes");
    refused(bake + " --loss 3 5", 1, "loss factor [-] is 3, outside [0, 2]");
}

TEST_F(Program, TellsRegionsAndBakesThem)
{
    const json mesh = figures("info " + path("regions.msh"));
    EXPECT_EQ(mesh["region 1"]["tets"], 20);
    EXPECT_EQ(mesh["region -2"]["tets"], 20);
    EXPECT_NEAR(mesh["region 1"]["volume"].get<double>(), 0.5, 1e-12);
    EXPECT_FALSE(figures("info " + path("two.node")).contains("region 0"));
    const std::string bake = "bake " + path("regions.msh") + " -o " + path("regions.bfem") + " --density 1500";
    figures(bake + " --region 1:rubber --region=-2:young=3e7,poisson=.25");
    const json told = figures("info " + path("regions.bfem"));
    refused(bake + " --region 1:shoreA=5 --region=-2:foam", 1, "hardness [Shore A] is 5, outside [10, 95]");
    EXPECT_EQ(told["version"], 3);
    EXPECT_FALSE(told.contains("young"));
    EXPECT_EQ(told["region 1"]["young"], 2e6);
    EXPECT_NEAR(told["region 1"]["mass"].get<double>(), 550, 1e-3);
    EXPECT_EQ(told["region -2"]["young"], 3e7);
    EXPECT_EQ(told["region -2"]["poisson"], .25);
    EXPECT_NEAR(told["region -2"]["mass"].get<double>(), 750, 1e-3);
    EXPECT_EQ(told["region -2"]["tets"], 20);
    EXPECT_EQ(told["region 1"]["meanDilatation"], "on");
    EXPECT_EQ(told["region -2"]["meanDilatation"], "on") << "bends accurately";
    figures(bake);
    EXPECT_EQ(figures("info " + path("regions.bfem"))["version"], 2) << "one material for all";

    refused(bake + " --region 1:rubber", 1, "region -2 (element ");
    refused(bake + " --region rubber", 1, "it has no label with ':' behind; give its label");
    refused(bake + " --region 1", 1, "it has no label");
    refused(bake + " --region 1:", 1, "there is no material");
    refused(bake + " --region 1:gold", 1, "'gold' is no material");
    refused(bake + " --region 1:nu=.3", 1, "'nu' is no value of a region");
    refused(bake + " --region 1:young=soft", 1, "'soft' is no number");
    refused(bake + " --region 1:poisson=.5", 1, "Poisson's ratio [-] is 0.5, outside [0, 0.499]");
    refused(bake + " --region 1:foam --region 1:wood", 1, "was given before");
    refused("bake " + path("two.node") + " -o " + path("a.bfem") + " --region 1:foam", 1, "has no regions");
    EXPECT_FALSE(exists("a.bfem"));
}

TEST_F(Program, BakesPaintedSurfaces)
{
    const std::string head =
        "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\n"
        "element face 6\nproperty list uchar int vertex_indices\nend_header\n";
    m_folder.write("painted.ply",
                   head +
                       "0 0 0 0 0 1\n1 0 0 0 0 2\n0 1 0 0 0 1\n1 1 0 0 0 2\n0 0 1 0 0 1\n1 0 1 0 0 2\n0 1 1 0 0 1\n"
                       "1 1 1 0 0 2\n4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n");
    const json surface = figures("info " + path("painted.ply"));
    EXPECT_EQ(surface["painted"], 2);
    EXPECT_EQ(surface["region 1"]["vertices"], 4);
    figures("bake " + path("painted.ply") + " --tets 600 --region 1:foam --region 2:wood -o " + path("painted.bfem"));
    const json told = figures("info " + path("painted.bfem"));
    EXPECT_NEAR(told["region 1"]["volume"].get<double>(), .5, .1);
    EXPECT_NEAR(told["region 2"]["volume"].get<double>(), .5, .1);
    m_folder.write("painted.json",
                   R"({ "seconds": 0.02, "softBodies": [{ "name": "a", "mesh": { "surface": "painted.ply",
        "tets": 300 }, "materials": { "1": "foam", "2": "rubber" } }] })");
    const ProgramRun run = bulletfem("simulate " + path("painted.json") + " --quiet --pvd -o " + path("run"));
    EXPECT_EQ(run.m_code, 0) << run.m_output;
    EXPECT_FALSE(readTetMeshFile(m_folder.path("run/elements_000000.vtu")).m_regions.empty());
    refused("bake " + path("cube.off") + " -o " + path("a.bfem") + " --region 1:foam", 1, "is not painted");
}

// The file for ParaView has the regions of the mesh file.
TEST_F(Program, WritesTheRegionOfEveryElement)
{
    m_folder.write("regions.json", R"({ "seconds": 0.02, "softBodies": [{ "name": "a",
        "mesh": { "tetrahedra": "regions.msh" }, "materials": { "1": "foam", "-2": "rubber" } }] })");
    const ProgramRun run = bulletfem("simulate " + path("regions.json") + " --quiet --pvd -o " + path("run"));
    ASSERT_EQ(run.m_code, 0) << run.m_output;
    const std::vector<int> expected = readTetMeshFile(m_folder.path("regions.msh")).m_regions;
    EXPECT_EQ(readTetMeshFile(m_folder.path("run/elements_000000.vtu")).m_regions, expected);
}

TEST_F(Program, PinsAsManyBoxesAsAreGiven)
{
    const std::string bake = "bake " + path("two.node") + " -o " + path("pinned.bfem");
    const std::string low = " --pin -9 -9 -9 9 9 0.01", high = " --pin -9 -9 0.99 9 9 9";
    const int below = figures(bake + low)["pinned"], above = figures(bake + high)["pinned"];
    EXPECT_GT(below, 3);
    EXPECT_GT(above, 3);
    EXPECT_EQ(figures(bake + low + high)["pinned"], below + above);
    EXPECT_EQ(figures("bake" + low + " " + path("two.node") + " -o " + path("pinned.bfem"))["pinned"], below);
    refused(bake + low + " 7", 2, "7");
    refused(bake + low + " --pin 1 2 3 4 5", 2, "--pin");
    refused(bake + " --pin -9 -9 -9 9 9 nan", 2, "must be a number in [-1000000, 1000000]");
}

TEST_F(Program, TellsHowFarARunAndItsPicturesAre)
{
    m_folder.write("scene.json",
                   R"({ "seconds": 0.05, "softBodies": [{ "name": "a", "mesh": { "box": [1, 1, 1], "tets": 40 } }],
                                      "pictures": { "width": 64, "height": 48 } })");
    const std::string simulate = "simulate " + path("scene.json") + " --png -o " + path("run");
    const ProgramRun run = bulletfem(simulate);
    if (run.m_output.find("install") != std::string::npos) GTEST_SKIP() << run.m_output;
    EXPECT_EQ(run.m_code, 0) << run.m_output;
    EXPECT_THAT(run.m_output, testing::ContainsRegex("100 %  simulating\n(.*\n)*100 %  drawing\n"));
    EXPECT_THAT(bulletfem(simulate + " --quiet").m_output, testing::Not(HasSubstr("%")));
}

// A bar under twice the force that it can bear.
TEST_F(Program, TellsHowManyPartsABodyHasSplitInto)
{
    const std::string scene = R"({ "gravity": [0, 0, 0], "softBodies": [{ "name": "bar",
      "mesh": { "box": [1, 0.2, 0.2], "cell": 0.1 }, "material": { "young": 1e5 }%,
      "pins": [{ "low": [-1, -1, -1], "high": [-0.49, 1, 1] }] }], "forces": [{ "body": "bar", "force": [100, 0, 0] }] })";
    const auto run = [&](const std::string& fracture, const std::string& options)
    {
        std::string text = scene;
        text.replace(text.find('%'), 1, fracture);
        m_folder.write("bar.json", text);
        return bulletfem("simulate '" + m_folder.path("bar.json") + "' --json --seconds 1 -o '" + m_folder.path("run") +
                         "' " + options);
    };
    const std::string fracture = R"(, "fracture": { "tension": 1000 })";
    const ProgramRun splits = run(fracture, "--pvd");
    ASSERT_EQ(splits.m_code, 0) << splits.m_output;
    const json told = json::parse(splits.m_output);
    EXPECT_GE(told["splits"].get<int>(), 1);
    EXPECT_GE(told["parts"].get<int>(), 2);
    const ProgramRun whole = run("", "--pvd");
    ASSERT_EQ(whole.m_code, 0) << whole.m_output;
    EXPECT_FALSE(json::parse(whole.m_output).contains("parts")) << "of bodies that do not split";
    const ProgramRun film = run(fracture, "--glb");
    ASSERT_EQ(film.m_code, 0) << film.m_output;
    const auto trianglesIn = [&]
    {
        const std::string file = m_folder.read("run/run.glb");
        const json model = json::parse(file.substr(20, file.find("BIN") - 24));
        const json mesh = model["meshes"][0]["primitives"][0], first = mesh["attributes"]["POSITION"];
        EXPECT_NEAR(model["accessors"][first.get<int>()]["max"][0].get<double>(), 0.5, 1e-6) << "whole at first";
        return model["accessors"][mesh["indices"].get<int>()]["count"].get<int>() / 3;
    };
    const int cracked = trianglesIn();
    ASSERT_EQ(run("", "--glb").m_code, 0);
    EXPECT_GE(cracked, trianglesIn() + 16) << "both sides of a section of four cells, two triangles each";
}

TEST_F(Program, FiguresForPeopleHaveTheSameNames)
{
    const json told = figures("info " + path("two.node"));
    const ProgramRun run = bulletfem("info " + path("two.node"));
    for (const auto& [name, value] : told.items()) EXPECT_THAT(run.m_output, HasSubstr(name + " ")) << value;
}

TEST_F(Program, TellsHowManyThingsOfEachKindASceneHas)
{
    const auto scene = [this](const std::string& demo)
    { return figures("info '" + std::string(BULLETFEM_SCENES) + "/../" + demo + "/" + demo + ".json'"); };
    const json finger = scene("finger"), thrown = scene("throw");
    EXPECT_GE(finger["actuators"], 1);
    EXPECT_EQ(finger["springs"], 0);
    EXPECT_GE(thrown["springs"], 1);
    EXPECT_EQ(thrown["actuators"], 0);
    EXPECT_EQ(finger["welds"], 0);
}

}  // namespace
}  // namespace bullet_fem
