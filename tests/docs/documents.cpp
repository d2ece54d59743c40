// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "docs/documents.h"

#include <cctype>
#include <fstream>
#include <regex>
#include <stdexcept>

namespace bullet_fem
{
namespace
{

const std::string kFence = "```";

bool startsWith(const std::string& line, const std::string& start)
{
    return line.compare(0, start.size(), start) == 0;
}

/// The anchor that GitHub gives a heading: lower-case letters, digits, - and _, with - in place of spaces.
std::string anchorOf(const std::string& heading)
{
    std::string anchor;
    for (const char c : heading.substr(heading.find_first_not_of("# ")))
        if (std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_')
            anchor += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        else if (c == ' ')
            anchor += '-';
    return anchor;
}

/// The path in a line <!-- file: path -->; empty for other lines.
std::string fileOf(const std::string& line)
{
    static const std::regex mark(R"(<!-- file: (\S+) -->)");
    std::smatch match;
    return std::regex_match(line, match, mark) ? match[1].str() : std::string();
}

void readLine(const std::string& line, Document& document)
{
    static const std::regex link(R"(\]\(([^)]+)\))");
    if (startsWith(line, "#")) document.m_anchors.push_back(anchorOf(line));
    for (std::sregex_iterator at(line.begin(), line.end(), link), end; at != end; ++at)
        document.m_links.push_back((*at)[1]);
}

}  // namespace

Document readDocument(const std::string& path)
{
    std::ifstream in(path);
    if (!in) throw std::runtime_error("cannot read " + path);
    Document document;
    document.m_path = path;
    bool inSnippet = false, isFragment = false;
    std::string file;
    for (std::string line; std::getline(in, line);)
    {
        document.m_bytes += line.size() + 1;
        ++document.m_lines;
        const bool isFence = startsWith(line, kFence);
        if (isFence && !inSnippet)
            document.m_snippets.push_back({line.substr(kFence.size()), document.m_lines + 1, {}, isFragment, file});
        else if (inSnippet && !isFence)
            document.m_snippets.back().m_code.push_back(line);
        else if (!isFence)
            readLine(line, document);
        if (isFence) inSnippet = !inSnippet;
        isFragment = line == "<!-- snippet: fragment -->";
        file = fileOf(line);
    }
    if (inSnippet) throw std::runtime_error(path + ": the last snippet is not closed");
    return document;
}

}  // namespace bullet_fem
