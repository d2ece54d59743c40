// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "docs/documents.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace bullet_fem
{
namespace
{

namespace fs = std::filesystem;

const fs::path kRoot = BULLETFEM_SOURCE_DIR;

std::vector<fs::path> documentsOfProject()
{
    std::vector<fs::path> paths;
    for (const fs::path& folder : {kRoot, kRoot / "docs"})
        for (const fs::directory_entry& file : fs::directory_iterator(folder))
            if (file.path().extension() == ".md") paths.push_back(file.path());
    return paths;
}

/// A temporary file with the given text.
class WrittenDocument
{
public:
    explicit WrittenDocument(const std::string& text)
        : m_path(fs::path(testing::TempDir()) /
                 (std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".md"))
    {
        std::ofstream(m_path) << text;
    }
    ~WrittenDocument() { fs::remove(m_path); }
    Document read() const { return readDocument(m_path.string()); }

private:
    fs::path m_path;
};

TEST(Documents, AreReadAsMarkdown)
{
    const WrittenDocument written(
        "# Build & test, 2x\n[a](b.md) and ![c](d.png#e)\n```cpp\nint [x](y);\n\n```\n"
        "<!-- snippet: fragment -->\n```sh\nls\n```\n<!-- file: a/b.txt -->\n```\nc\n```\n## `some_code` here\n");
    const Document document = written.read();
    EXPECT_THAT(document.m_anchors, testing::ElementsAre("build--test-2x", "some_code-here"));
    EXPECT_THAT(document.m_links, testing::ElementsAre("b.md", "d.png#e"));
    EXPECT_EQ(document.m_lines, 15u);
    ASSERT_EQ(document.m_snippets.size(), 3u);
    EXPECT_EQ(document.m_snippets[0].m_language, "cpp");
    EXPECT_EQ(document.m_snippets[0].m_line, 4u);
    EXPECT_THAT(document.m_snippets[0].m_code, testing::ElementsAre("int [x](y);", ""));
    EXPECT_FALSE(document.m_snippets[0].m_isFragment);
    EXPECT_TRUE(document.m_snippets[1].m_isFragment);
    EXPECT_EQ(document.m_snippets[1].m_file, "");
    EXPECT_EQ(document.m_snippets[2].m_file, "a/b.txt");
}

TEST(Documents, AreRejectedIfMalformed)
{
    EXPECT_THROW(readDocument((kRoot / "no_such_document.md").string()), std::runtime_error);
    EXPECT_THROW(WrittenDocument("```cpp\nint x;\n").read(), std::runtime_error);
}

/// Each link within the project names an existing file, and an existing heading of it.
TEST(Documents, LinkToExistingTargets)
{
    std::size_t followed = 0;
    for (const fs::path& path : documentsOfProject())
        for (const std::string& link : readDocument(path.string()).m_links)
        {
            if (link.find("://") != std::string::npos) continue;
            ++followed;
            const std::size_t hash = std::min(link.find('#'), link.size());
            const fs::path target = hash == 0 ? path : path.parent_path() / link.substr(0, hash);
            ASSERT_TRUE(fs::exists(target)) << path << " links to " << link;
            if (hash == link.size()) continue;
            EXPECT_THAT(readDocument(target.string()).m_anchors, testing::Contains(link.substr(hash + 1)))
                << path << " links to " << link;
        }
    EXPECT_GT(followed, 30u);
}

/// Paths of the source tree in documented commands exist.
TEST(Documents, CommandsNameExistingFiles)
{
    std::size_t found = 0;
    for (const fs::path& path : documentsOfProject())
        for (const Snippet& snippet : readDocument(path.string()).m_snippets)
        {
            if (snippet.m_language != "sh") continue;
            for (const std::string& line : snippet.m_code)
            {
                std::istringstream words(line.substr(0, line.find(" #")));
                for (std::string word; words >> word;)
                {
                    const fs::path first = *fs::path(word).begin();
                    if (first == word || !fs::is_directory(kRoot / first) || first == "." || first == "build" ||
                        first == "out")
                        continue;  // or it is created by running the command
                    ++found;
                    EXPECT_TRUE(fs::exists(kRoot / word)) << path << ", from line " << snippet.m_line << ": " << word;
                }
            }
        }
    EXPECT_GT(found, 8u);
}

/// Every page of docs/ can be reached from README.
TEST(Documents, AreAllLinkedFromReadme)
{
    const std::vector<std::string> links = readDocument((kRoot / "README.md").string()).m_links;
    for (const fs::path& path : documentsOfProject())
    {
        if (path.parent_path() != kRoot / "docs") continue;
        EXPECT_THAT(links, testing::Contains("docs/" + path.filename().string()));
    }
}

TEST(Readme, IsReadInFiveMinutes)
{
    const Document readme = readDocument((kRoot / "README.md").string());
    std::size_t codeLines = 0;
    for (const Snippet& snippet : readme.m_snippets) codeLines += snippet.m_code.size() + 2;
    EXPECT_LE(readme.m_lines - codeLines, 110u);
    EXPECT_LE(readme.m_bytes, 10500u);
}

/// README's first program equals that built by demos/run.sh, apart from its header, and so does its CMakeLists.txt.
TEST(Readme, ShowsTheHelloProgram)
{
    const Document readme = readDocument((kRoot / "README.md").string());
    ASSERT_GE(readme.m_snippets.size(), 2u);
    EXPECT_EQ(readme.m_snippets[0].m_file, "demos/hello/hello.cpp");
    EXPECT_LE(readme.m_snippets[0].m_code.size(), 40u);
    for (const Snippet& snippet : readme.m_snippets)
    {
        if (snippet.m_file.compare(0, 12, "demos/hello/") != 0) continue;
        std::ifstream file(kRoot / snippet.m_file);
        ASSERT_TRUE(file.good()) << snippet.m_file;
        std::vector<std::string> lines;
        for (std::string line; std::getline(file, line);)
            if (line.find("SPDX-") == std::string::npos && line.find("Copyright") == std::string::npos)
                lines.push_back(line);
        EXPECT_EQ(snippet.m_code, lines) << snippet.m_file;
    }
}

/// README's first two commands are the two scripts.
TEST(Readme, HasTwoCommands)
{
    const Document readme = readDocument((kRoot / "README.md").string());
    const auto shell = std::find_if(readme.m_snippets.begin(), readme.m_snippets.end(),
                                    [](const Snippet& snippet) { return snippet.m_language == "sh"; });
    ASSERT_NE(shell, readme.m_snippets.end());
    EXPECT_THAT(shell->m_code, testing::ElementsAre("demos/run.sh", "tests/run.sh"));
}

}  // namespace
}  // namespace bullet_fem
