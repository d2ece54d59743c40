// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "fem/common/output_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "fem/common/unfinished_files.h"
#include "io/full_disk.h"
#include "io/temporary_folder.h"

namespace bullet_fem
{
namespace
{

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsSupersetOf;
using testing::UnorderedElementsAre;

std::string messageOfWriting(const std::string& path)
{
    return messageOf<std::runtime_error>([&] { writeOutputFile(path, std::string(100000, 'x')); });
}

TEST(OutputFile, ReplacesTheExistingFile)
{
    const TemporaryFolder folder;
    const std::string path = folder.write("a", "something longer");
    writeOutputFile(path, std::string_view("ne\0w", 4));
    EXPECT_EQ(folder.read("a"), std::string("ne\0w", 4));
    writeOutputFile(path, {});
    EXPECT_EQ(folder.read("a"), "");
    EXPECT_THAT(folder.names(), ElementsAre("a"));
}

TEST(OutputFile, HasItsNameOnlyWhenItIsWhole)
{
    const TemporaryFolder folder;
    const std::string path = folder.write("a", "old");
    {
        OutputFile abandoned(path), another(path);
        abandoned.write("lost", 4);
        another.write("ne", 2);
        another.write("w", 1);
        another.sync();
        EXPECT_EQ(folder.read("a"), "old");
        another.commit();
        EXPECT_EQ(folder.read("a"), "new");
    }
    EXPECT_EQ(folder.read("a"), "new");
    EXPECT_THAT(folder.names(), ElementsAre("a"));
}

TEST(OutputFile, FullDiskKeepsTheOldFileAndLeavesNoPart)
{
    const TemporaryFolder folder;
    const std::string path = folder.write("a", "old");
    std::string many, few, synced;
    {
        const FullDisk full(10);
        many = messageOfWriting(path);
        few = messageOf<std::runtime_error>([&] { writeOutputFile(path, "a buffer holds it until the end"); });
        OutputFile file(path);
        file.write("a buffer holds it until now", 27);
        synced = messageOf<std::runtime_error>([&] { file.sync(); });
    }
    for (const std::string& why : {many, few, synced})
        EXPECT_THAT(why, AllOf(HasSubstr("cannot write '" + path + "': File too large"), HasSubstr("disk not full")));
    EXPECT_EQ(folder.read("a"), "old");
    EXPECT_THAT(folder.names(), ElementsAre("a"));
}

TEST(OutputFile, UnfinishedFilesCanBeRemovedByASignalHandler)
{
    const TemporaryFolder folder;
    writeOutputFile(folder.path("whole"), "kept");
    std::vector<std::unique_ptr<OutputFile>> files;
    for (int k = 0; k < 70; ++k)  // six more than the list holds
        files.push_back(std::make_unique<OutputFile>(folder.path(std::to_string(k))));
    files.front()->commit();
    removeUnfinishedFiles();
    EXPECT_EQ(folder.names().size(), 2u + 6u);
    EXPECT_THAT(folder.names(), IsSupersetOf({"0", "whole"}));
    files.clear();
    EXPECT_THAT(folder.names(), UnorderedElementsAre("0", "whole"));
    for (int k = 0; k < 200; ++k) OutputFile(folder.path("often"));  // entries are reused
    const OutputFile last(folder.path("last"));
    removeUnfinishedFiles();
    EXPECT_THAT(folder.names(), UnorderedElementsAre("0", "whole"));
}

TEST(OutputFile, DevicesAreWrittenToAndStayDevices)
{
    EXPECT_THAT(messageOfWriting("/dev/full"), AllOf(HasSubstr("/dev/full"), HasSubstr("No space left")));
    EXPECT_THROW(writeOutputFile("/dev/full", "few, which a buffer holds until the end"), std::runtime_error);
    writeOutputFile("/dev/null", "nothing");
    OutputFile null("/dev/null");
    EXPECT_EQ(null.temporaryPath(), "/dev/null");
    null.sync();
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST(OutputFile, UnwritablePathsAreNamed)
{
    const TemporaryFolder folder;
    folder.write("file", "in the way");
    EXPECT_THAT(messageOfWriting(""), HasSubstr("it has no name"));
    EXPECT_THAT(messageOfWriting(folder.path("")), HasSubstr("it is a directory"));
    EXPECT_THAT(messageOfWriting(folder.path("missing/a")), AllOf(HasSubstr("missing/a'"), HasSubstr("No such file")));
    EXPECT_THAT(messageOfWriting(folder.path("file/a")), AllOf(HasSubstr("file/a'"), HasSubstr("Not a directory")));
    EXPECT_THAT(folder.names(), ElementsAre("file"));
}

TEST(CheckWritable, FindsOutWithoutATrace)
{
    const TemporaryFolder folder;
    const auto messageOfChecking = [&](const std::string& name)
    { return messageOf<std::runtime_error>([&] { checkWritable(folder.path(name)); }); };
    checkWritable(folder.path("new"));
    EXPECT_THAT(folder.names(), IsEmpty());
    folder.write("old", "kept");
    checkWritable(folder.path("old"));
    EXPECT_EQ(folder.read("old"), "kept");
    checkWritable("/dev/null");
    EXPECT_THAT(messageOfChecking("missing/a"), AllOf(HasSubstr("missing/a'"), HasSubstr("No such file")));
    EXPECT_THAT(messageOfChecking("old/a"), AllOf(HasSubstr("old/a'"), HasSubstr("Not a directory")));
    EXPECT_THAT(messageOfChecking(""), HasSubstr("it is a directory"));
    EXPECT_THAT(folder.names(), ElementsAre("old"));
}

}  // namespace
}  // namespace bullet_fem
