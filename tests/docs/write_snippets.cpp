// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// write_snippets <document.md> <out.cpp>: writes the document's C++ snippets, except fragments and whole files, as one
// source file: each snippet is the body of a function that sees the declarations of snippet_context.h; includes are
// moved to the top.
// write_snippets <document.md> <folder>/CMakeLists.txt: writes its first CMake snippet, as a project with a main.cpp.
// write_snippets <document.md> <folder>: writes its whole-file snippets at their paths.
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>

#include "docs/documents.h"

using namespace bullet_fem;

namespace
{

bool isInclude(const std::string& line)
{
    return line.compare(0, 8, "#include") == 0;
}

bool isFunctionBody(const Snippet& snippet)
{
    return snippet.m_language == "cpp" && !snippet.m_isFragment && snippet.m_file.empty();
}

void writeCpp(const Document& document, std::ostream& out)
{
    out << "#include \"docs/snippet_context.h\"\n";
    for (const Snippet& snippet : document.m_snippets)
        if (isFunctionBody(snippet))
            for (const std::string& line : snippet.m_code)
                if (isInclude(line)) out << line << '\n';
    for (const Snippet& snippet : document.m_snippets)
    {
        if (!isFunctionBody(snippet)) continue;
        out << "void snippetOfLine" << snippet.m_line << "()\n{\n#line " << snippet.m_line << " \"" << document.m_path
            << "\"\n";
        for (const std::string& line : snippet.m_code) out << (isInclude(line) ? "" : line) << '\n';
        out << "}\n";
    }
}

void writeCMake(const Document& document, std::ostream& out)
{
    for (const Snippet& snippet : document.m_snippets)
    {
        if (snippet.m_language != "cmake") continue;
        out << "cmake_minimum_required(VERSION 3.25)\nproject(Snippet LANGUAGES C CXX)\n";
        for (const std::string& line : snippet.m_code) out << line << '\n';
        return;
    }
    throw std::runtime_error(document.m_path + " has no snippet of CMake");
}

void writeFiles(const Document& document, const std::filesystem::path& folder)
{
    for (const Snippet& snippet : document.m_snippets)
    {
        if (snippet.m_file.empty()) continue;
        std::filesystem::create_directories((folder / snippet.m_file).parent_path());
        std::ofstream out(folder / snippet.m_file);
        for (const std::string& line : snippet.m_code) out << line << '\n';
        if (!out.flush()) throw std::runtime_error("cannot write " + (folder / snippet.m_file).string());
    }
}

}  // namespace

int main(int argc, char** argv)
{
    try
    {
        if (argc != 3)
            throw std::runtime_error("usage: write_snippets <document.md> <out.cpp, CMakeLists.txt or folder>");
        const std::filesystem::path path = argv[2];
        const Document document = readDocument(argv[1]);
        if (path.extension().empty())
        {
            writeFiles(document, path);
            return 0;
        }
        std::ofstream out(path);
        if (path.extension() == ".cpp")
            writeCpp(document, out);
        else
            writeCMake(document, out);
        if (!out.flush()) throw std::runtime_error("cannot write " + path.string());
        return 0;
    }
    catch (const std::exception& error)
    {
        std::cerr << "write_snippets: " << error.what() << '\n';
        return 1;
    }
}
