// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

namespace bullet_fem
{

/// A block of code in a document, between lines of three backquotes.
struct Snippet
{
    std::string m_language;           ///< behind the backquotes: cpp, cmake, sh, ...
    std::size_t m_line = 0;           ///< of its first line of code, from 1
    std::vector<std::string> m_code;  ///< line by line
    bool m_isFragment = false;        ///< a line <!-- snippet: fragment --> stands above it: it does not compile alone
    std::string m_file;               ///< path of the line <!-- file: path --> above it: it is that file, whole
};

/// A document in Markdown, as far as tests need it.
struct Document
{
    std::string m_path;
    std::size_t m_bytes = 0;
    std::size_t m_lines = 0;
    std::vector<Snippet> m_snippets;
    std::vector<std::string> m_links;  ///< what stands in the parentheses of [text](...), outside of snippets
    std::vector<std::string>
        m_anchors;  ///< of the headings, as GitHub makes them: `## Build and test` is build-and-test
};

/// Reads a document. Throws std::runtime_error if the file cannot be read, or if a snippet is not closed.
Document readDocument(const std::string& path);

}  // namespace bullet_fem
