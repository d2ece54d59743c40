// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "io/output_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/temporary_folder.h"

namespace bullet_fem
{
namespace
{

using testing::AllOf;
using testing::HasSubstr;

std::string messageOfWriting(const std::string& path)
{
    return messageOf<std::runtime_error>([&] { writeOutputFile(path, std::string(100000, 'x')); });
}

TEST(OutputFile, ReplacesWhatWasThere)
{
    const TemporaryFolder folder;
    const std::string path = folder.write("a", "something longer");
    writeOutputFile(path, std::string_view("ne\0w", 4));
    EXPECT_EQ(folder.read("a"), std::string("ne\0w", 4));
    writeOutputFile(path, {});
    EXPECT_EQ(folder.read("a"), "");
    EXPECT_FALSE(std::filesystem::exists(path + ".part"));
}

// The bytes go to a device that has no room.
TEST(OutputFile, OnAFullDiskTheOldFileStaysAndNoPartIsLeft)
{
    const TemporaryFolder folder;
    const std::string path = folder.write("a", "old");
    std::filesystem::create_symlink("/dev/full", path + ".part");
    EXPECT_THAT(messageOfWriting(path), AllOf(HasSubstr("'" + path + "'"), HasSubstr("No space left")));
    EXPECT_EQ(folder.read("a"), "old");
    EXPECT_FALSE(std::filesystem::is_symlink(path + ".part"));
}

TEST(OutputFile, DevicesAreWrittenToAndStayDevices)
{
    EXPECT_THAT(messageOfWriting("/dev/full"), AllOf(HasSubstr("/dev/full"), HasSubstr("No space left")));
    EXPECT_THROW(writeOutputFile("/dev/full", "few, which a buffer holds until the end"), std::runtime_error);
    writeOutputFile("/dev/null", "nothing");
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST(OutputFile, PlacesThatCannotBeWrittenAreNamed)
{
    const TemporaryFolder folder;
    EXPECT_THAT(messageOfWriting(folder.path("")), HasSubstr("directory"));
    EXPECT_THAT(messageOfWriting(folder.path("missing/a")), AllOf(HasSubstr("missing/a'"), HasSubstr("No such file")));
    std::filesystem::create_directory(folder.path("a.part"));
    EXPECT_THAT(messageOfWriting(folder.path("a")), HasSubstr("directory"));
    EXPECT_TRUE(std::filesystem::exists(folder.path("a.part")));
    EXPECT_FALSE(std::filesystem::exists(folder.path("a")));
}

}  // namespace
}  // namespace bullet_fem
