// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

namespace bullet_fem
{

/// A code block of a document, between lines of three backquotes.
struct Snippet
{
    std::string m_language;           ///< after the backquotes: cpp, cmake, sh, ...
    std::size_t m_line = 0;           ///< number of its first line of code, from 1
    std::vector<std::string> m_code;  ///< line by line
    bool m_isFragment = false;  ///< marked <!-- snippet: fragment --> in the line above: it does not compile by itself
    std::string m_file;         ///< path in a line <!-- file: path --> above: the snippet is that whole file
};

/// The parts of a Markdown document that tests read.
struct Document
{
    std::string m_path;
    std::size_t m_bytes = 0;
    std::size_t m_lines = 0;
    std::vector<Snippet> m_snippets;
    std::vector<std::string> m_links;  ///< targets of [text](...), outside of snippets
    std::vector<std::string>
        m_anchors;  ///< of the headings, as GitHub makes them: `## Build and test` is build-and-test
};

/// Reads a document. Throws std::runtime_error if the file cannot be read, or if a snippet is not closed.
Document readDocument(const std::string& path);

}  // namespace bullet_fem
