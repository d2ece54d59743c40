// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Invalid baked files are refused, and so are paths that cannot be written.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>

#include "fem/scenes/baked_files.h"
#include "io/full_disk.h"

namespace bullet_fem
{
namespace
{

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class BakedFiles : public testing::Test
{
protected:
    std::string readingOf(const std::string& bytes) const
    {
        m_folder.write("changed.bfem", bytes);
        return messageOf<std::runtime_error>([this] { readBakedBody(m_folder.path("changed.bfem")); });
    }
    // Replaces four or eight bytes at an offset of the header.
    template <class Number>
    std::string with(std::size_t place, Number number) const
    {
        std::string bytes = m_bytes;
        std::memcpy(&bytes[place], &number, sizeof number);
        return bytes;
    }

    const TemporaryFolder m_folder;
    const std::string m_bytes = bytesOf(bakeCase());
};

TEST_F(BakedFiles, AreRejectedWithAnyByteChanged)
{
    for (std::size_t k = 0; k < m_bytes.size(); ++k)
        for (const int change : {1, 0x80, 0xFF})
        {
            std::string bytes = m_bytes;
            bytes[k] = static_cast<char>(bytes[k] ^ change);
            ASSERT_NE(complaint(bytes), "") << "byte " << k;
        }
}

TEST_F(BakedFiles, AreRejectedWithAnyOtherLength)
{
    for (std::size_t length = 0; length < m_bytes.size(); ++length)
        ASSERT_NE(complaint(m_bytes.substr(0, length)), "") << length;
    EXPECT_NE(complaint(m_bytes + '\0'), "");
    EXPECT_NE(complaint(m_bytes + m_bytes), "");
    EXPECT_EQ(complaint(m_bytes), "");
}

TEST_F(BakedFiles, AreRefusedWithNameReasonAndRemedy)
{
    const auto says = [](const char* reason, const char* remedy)
    { return AllOf(HasSubstr("changed.bfem"), HasSubstr(reason), HasSubstr(remedy)); };
    EXPECT_THAT(readingOf(""), says("0 bytes", "anew"));
    EXPECT_THAT(readingOf(m_bytes.substr(0, 100)), says("100 bytes", "anew"));
    EXPECT_THAT(readingOf(m_bytes.substr(0, 1000)), says("1000 bytes", "anew"));
    EXPECT_THAT(readingOf(std::string(1000, 'x')), says("not a baked body", "give a .bfem file"));
    EXPECT_THAT(readingOf(with(8, std::uint32_t(0x04030201))), says("other byte order", "bake it on"));
    EXPECT_THAT(readingOf(with(8, std::uint32_t(0x01020305))), says("byte order mark", "anew"));
    EXPECT_THAT(readingOf(with(12, kBakedVersion - 1)), says("older version 1", "bake it anew"));
    EXPECT_THAT(readingOf(with(12, kBakedConstantsVersion + 1)), says("newer version 5", "newer BulletFEM"));
    EXPECT_THAT(readingOf(with(100, '\7')), says("header is damaged", "anew"));
    EXPECT_THAT(readingOf(with(m_bytes.size() - 1, '\7')), says("damaged", "anew"));
}

TEST_F(BakedFiles, UnreadablePathsAreRejected)
{
    const auto reading = [](const std::string& path)
    { return messageOf<std::runtime_error>([&path] { readBakedBody(path); }); };
    EXPECT_THAT(reading(m_folder.path("missing.bfem")), AllOf(HasSubstr("missing.bfem"), HasSubstr("no such file")));
    EXPECT_THAT(reading(m_folder.path("")), HasSubstr("directory or device"));
    EXPECT_THAT(reading("/dev/zero"), HasSubstr("directory or device"));
    EXPECT_THAT(messageOf<std::runtime_error>([&] { inspectBakedBody(m_folder.path("missing.bfem")); }),
                HasSubstr("no such file"));
    EXPECT_THAT(messageOf<std::runtime_error>([] { readBakedBody(nullptr, 9, "nothing"); }),
                AllOf(HasSubstr("nothing"), HasSubstr("null")));
}

TEST_F(BakedFiles, HeadersAreInspectedWithTheSameChecks)
{
    const auto inspected = [this](const std::string& bytes)
    {
        std::string why;
        inspectBakedBody(m_folder.write("begin.bfem", bytes), &why);
        return why;
    };
    EXPECT_EQ(inspected(m_bytes), "");
    EXPECT_THAT(inspected(m_bytes.substr(0, 300)), HasSubstr("300 bytes"));
    EXPECT_THAT(inspected(m_bytes.substr(0, 30)), HasSubstr("30 bytes"));
    for (std::size_t k = 0; k < sizeof(BakedHeader); ++k)
    {
        std::string bytes = m_bytes;
        bytes[k] = static_cast<char>(bytes[k] ^ 1);
        ASSERT_NE(inspected(bytes), "") << k;
    }
}

class BakedFileWriting : public testing::Test
{
protected:
    const TemporaryFolder m_folder;
    const BakedBody m_body = bakeCase();
};

TEST_F(BakedFileWriting, ReportsUnwritablePaths)
{
    const auto writing = [this](const std::string& path)
    { return messageOf<std::runtime_error>([&] { writeBakedBody(path, m_body); }); };
    EXPECT_THAT(writing(m_folder.path("missing/body.bfem")),
                AllOf(HasSubstr("missing/body.bfem"), HasSubstr("folder")));
    EXPECT_THAT(writing(m_folder.path("")), HasSubstr("it is a directory"));
    EXPECT_THAT(writing("/dev/full"), AllOf(HasSubstr("/dev/full"), HasSubstr("No space left")));
    std::string why;
    EXPECT_FALSE(writeBakedBody(m_folder.path("missing/body.bfem"), m_body, &why));
    EXPECT_THAT(why, HasSubstr("missing/body.bfem"));
    EXPECT_THAT(m_folder.names(), IsEmpty());
}

TEST_F(BakedFileWriting, LeavesTheOldFileOnAFullDisk)
{
    const std::string path = m_folder.write("body.bfem", "what was there");
    std::string why;
    {
        const FullDisk full(1000);
        EXPECT_FALSE(writeBakedBody(path, m_body, &why));
    }
    EXPECT_THAT(why, AllOf(HasSubstr("body.bfem"), HasSubstr("disk not full")));
    EXPECT_EQ(m_folder.read("body.bfem"), "what was there");
    EXPECT_THAT(m_folder.names(), ElementsAre("body.bfem"));
    writeBakedBody(path, m_body);
    EXPECT_THAT(m_folder.names(), ElementsAre("body.bfem"));
}

TEST_F(BakedFileWriting, RejectsBodiesWithInconsistentParts)
{
    const auto writing = [this](const BakedBody& body)
    { return messageOf<std::runtime_error>([&] { writeBakedBody(m_folder.path("bad.bfem"), body); }); };
    EXPECT_THAT(writing({}), HasSubstr("no model"));
    BakedBody bad = m_body;
    bad.m_inverseMass.pop_back();
    EXPECT_THAT(writing(bad), HasSubstr("11 inverse masses for 12 nodes"));
    bad = m_body;
    bad.m_filled.pop_back();
    EXPECT_THAT(writing(bad), HasSubstr("filled fractions"));
    bad = m_body;
    bad.m_embedding[0].m_tet = 1000;
    EXPECT_THAT(writing(bad), HasSubstr("embedded vertex 0"));
    bad = m_body;
    bad.m_triangles[0][2] = 3;
    EXPECT_THAT(writing(bad), HasSubstr("triangle 0"));
    EXPECT_THAT(m_folder.names(), IsEmpty());
}

}  // namespace
}  // namespace bullet_fem
