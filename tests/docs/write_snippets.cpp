// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// write_snippets <document.md> <out.cpp>: the document's snippets of C++, fragments apart, as a source file that
// compiles if they do: each is the body of a function that sees what snippet_context.h declares, and its includes stand
// above all. write_snippets <document.md> <folder>/CMakeLists.txt: its first snippet of CMake, as a project with a
// main.cpp.
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

void writeCpp(const Document& document, std::ostream& out)
{
    out << "#include \"docs/snippet_context.h\"\n";
    for (const Snippet& snippet : document.m_snippets)
        if (snippet.m_language == "cpp" && !snippet.m_isFragment)
            for (const std::string& line : snippet.m_code)
                if (isInclude(line)) out << line << '\n';
    for (const Snippet& snippet : document.m_snippets)
    {
        if (snippet.m_language != "cpp" || snippet.m_isFragment) continue;
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

}  // namespace

int main(int argc, char** argv)
{
    try
    {
        if (argc != 3) throw std::runtime_error("usage: write_snippets <document.md> <out.cpp or CMakeLists.txt>");
        const std::string path = argv[2];
        const Document document = readDocument(argv[1]);
        std::ofstream out(path);
        if (path.size() > 4 && path.substr(path.size() - 4) == ".cpp")
            writeCpp(document, out);
        else
            writeCMake(document, out);
        if (!out.flush()) throw std::runtime_error("cannot write " + path);
        return 0;
    }
    catch (const std::exception& error)
    {
        std::cerr << "write_snippets: " << error.what() << '\n';
        return 1;
    }
}
