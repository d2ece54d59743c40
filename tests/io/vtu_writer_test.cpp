// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/io/vtu_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <locale>
#include <sstream>

#include "io/temporary_folder.h"

namespace bullet_fem
{
namespace
{

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

const std::vector<Vec3> kPositions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.1234567894, -1e-7, 1e20}};
const std::vector<Triangle> kTriangles = {{0, 1, 2}, {3, 2, 1}};
const std::vector<Vec3> kDisplacement = {{0, 0, 0.5}, {0, 0, 0.25}, {0, 0, 0}, {1, 2, 3}};

/// The numbers of the DataArray `name`.
std::vector<double> numbersOf(const std::string& text, const std::string& name)
{
    const std::size_t array = text.find("Name=\"" + name + "\"");
    EXPECT_NE(array, std::string::npos) << name;
    const std::size_t begin = text.find('>', array) + 1;
    std::istringstream stream(text.substr(begin, text.find('<', begin) - begin));
    std::vector<double> numbers;
    for (double number; stream >> number;) numbers.push_back(number);
    return numbers;
}

TEST(VtuSeries, FrameHoldsPointsCellsAndDisplacement)
{
    const TemporaryFolder folder;
    VtuSeries series(folder.path("new/deep"), "drop");
    series.writeTriangles(0, kPositions, kTriangles, kDisplacement);
    const std::string text = folder.read("new/deep/drop_000000.vtu");
    EXPECT_THAT(text, AllOf(HasSubstr("NumberOfPoints=\"4\" NumberOfCells=\"2\""),
                            HasSubstr("Vectors=\"displacement\""), HasSubstr("type=\"UnstructuredGrid\"")));
    EXPECT_THAT(numbersOf(text, "Points"), ElementsAre(0, 0, 0, 1, 0, 0, 0, 1, 0, 0.123456789, -1e-7, 1e20));
    EXPECT_THAT(numbersOf(text, "displacement"), ElementsAre(0, 0, 0.5, 0, 0, 0.25, 0, 0, 0, 1, 2, 3));
    EXPECT_THAT(numbersOf(text, "connectivity"), ElementsAre(0, 1, 2, 3, 2, 1));
    EXPECT_THAT(numbersOf(text, "offsets"), ElementsAre(3, 6));
    EXPECT_THAT(numbersOf(text, "types"), ElementsAre(5, 5));
}

TEST(VtuSeries, AcceptsFramesWithoutTrianglesOrDisplacement)
{
    const TemporaryFolder folder;
    VtuSeries series(folder.path("out"), "drop");
    series.writeTriangles(0, {}, {});
    EXPECT_THAT(folder.read("out/drop_000000.vtu"),
                AllOf(HasSubstr("NumberOfPoints=\"0\" NumberOfCells=\"0\""), Not(HasSubstr("displacement"))));
}

TEST(VtuSeries, PvdListsEveryFrameWithItsTime)
{
    const TemporaryFolder folder;
    VtuSeries series(folder.path("out"), "drop");
    EXPECT_EQ(series.pvdPath(), folder.path("out/drop.pvd"));
    EXPECT_THAT(folder.read("out/drop.pvd"),
                Not(HasSubstr("DataSet")));  // an empty, well-formed collection
    series.writeTriangles(0, kPositions, kTriangles);
    EXPECT_THAT(folder.read("out/drop.pvd"), HasSubstr("timestep=\"0\" part=\"0\" file=\"drop_000000.vtu\""));
    series.writeTriangles(1. / 60, kPositions, kTriangles);
    EXPECT_EQ(series.frameCount(), 2);
    EXPECT_THAT(
        folder.read("out/drop.pvd"),
        AllOf(HasSubstr("timestep=\"0\" part=\"0\" file=\"drop_000000.vtu\""),
              HasSubstr("timestep=\"0.0166666667\" part=\"0\" file=\"drop_000001.vtu\""), HasSubstr("</VTKFile>")));
}

TEST(VtuSeries, FramesDoNotDependOnTheLocaleOfStreams)
{
    struct DecimalComma : std::numpunct<char>
    {
        char do_decimal_point() const override { return ','; }
        char do_thousands_sep() const override { return '.'; }
        std::string do_grouping() const override { return "\3"; }
    };
    const std::locale before = std::locale::global(std::locale(std::locale::classic(), new DecimalComma));
    const TemporaryFolder folder;
    VtuSeries series(folder.path("out"), "drop");
    series.writeTriangles(0.5, std::vector<Vec3>(1234, Vec3{0.5, 0, 0}), {{0, 1, 1233}});
    std::locale::global(before);
    EXPECT_THAT(folder.read("out/drop_000000.vtu"),
                AllOf(HasSubstr("0.5 0 0"), HasSubstr("0 1 1233"), Not(HasSubstr(","))));
    EXPECT_THAT(folder.read("out/drop.pvd"), HasSubstr("timestep=\"0.5\""));
}

TEST(VtuSeries, RejectsInvalidFileNames)
{
    const TemporaryFolder folder;
    for (const std::string name : {"", "a/b", "a\"b", "a b"})
        EXPECT_THAT(messageOf<std::invalid_argument>([&] { VtuSeries(folder.path("out"), name); }),
                    AllOf(HasSubstr("'" + name + "'"), HasSubstr("letters, digits")));
    EXPECT_FALSE(std::filesystem::exists(folder.path("out")));
}

TEST(VtuSeries, RejectsUncreatableFolders)
{
    const TemporaryFolder folder;
    const std::string file = folder.write("file", "");
    EXPECT_THAT(messageOf<std::runtime_error>([&] { VtuSeries(file, "drop"); }),
                AllOf(HasSubstr(file), HasSubstr("cannot make the folder")));
    EXPECT_THAT(messageOf<std::runtime_error>([&] { VtuSeries(file + "/sub", "drop"); }), HasSubstr(file + "/sub"));
    EXPECT_THROW(VtuSeries("", "drop"), std::runtime_error);
}

TEST(VtuSeries, RejectsBadFramesWithoutCountingThem)
{
    const TemporaryFolder folder;
    VtuSeries series(folder.path("out"), "drop");
    const auto rejected = [&](double time, const std::vector<Vec3>& positions, const std::vector<Triangle>& triangles,
                              const std::vector<Vec3>& displacement) {
        return messageOf<std::invalid_argument>([&]
                                                { series.writeTriangles(time, positions, triangles, displacement); });
    };
    EXPECT_THAT(rejected(0, kPositions, kTriangles, {{1, 2, 3}}), HasSubstr("1 displacements for 4 vertices"));
    EXPECT_THAT(rejected(0, kPositions, {{0, 1, 2}, {0, 1, 4}}, {}),
                HasSubstr("triangle 1 uses vertex 4, which is not in [0, 4)"));
    EXPECT_THAT(rejected(0, kPositions, {{0, -1, 2}}, {}), HasSubstr("triangle 0 uses vertex -1"));
    EXPECT_THAT(rejected(std::nan(""), kPositions, kTriangles, {}), HasSubstr("time is nan"));
    EXPECT_THAT(rejected(0, {{0, 0, 0}, {0, HUGE_VAL, 0}}, {}, {}), HasSubstr("position of vertex 1 is not finite"));
    EXPECT_THAT(rejected(0, {{0, 0, 0}}, {}, {{0, std::nan(""), 0}}),
                HasSubstr("displacement of vertex 0 is not finite"));
    EXPECT_EQ(series.frameCount(), 0);
    EXPECT_FALSE(std::filesystem::exists(folder.path("out/drop_000000.vtu")));
}

TEST(VtuSeries, ReportsAFullDiskAndGoesOnAfterwards)
{
    const TemporaryFolder folder;
    VtuSeries series(folder.path("out"), "drop");
    const std::string frame = folder.path("out/drop_000000.vtu");
    std::filesystem::create_symlink("/dev/full", frame);  // opening succeeds, each write fails
    EXPECT_THAT(messageOf<std::runtime_error>([&] { series.writeTriangles(0, kPositions, kTriangles); }),
                AllOf(HasSubstr(frame), HasSubstr("disk not full")));
    EXPECT_EQ(series.frameCount(), 0);
    std::filesystem::remove(frame);
    series.writeTriangles(0, kPositions, kTriangles);
    EXPECT_EQ(series.frameCount(), 1);
}

}  // namespace
}  // namespace bullet_fem
