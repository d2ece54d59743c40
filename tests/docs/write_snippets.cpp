// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// write_snippets <document.md> <out.cpp>: the document's snippets of C++, fragments and whole files apart, as a source
// file that compiles if they do: each is the body of a function that sees what snippet_context.h declares, and its
// includes stand above all. write_snippets <document.md> <folder>/CMakeLists.txt: its first snippet of CMake, as a
// project with a main.cpp. write_snippets <document.md> <folder>: its snippets that are whole files, each at its path.
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
