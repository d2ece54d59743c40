// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/games/tetgen_source.h"

#include <fstream>
#include <sstream>
#include <stdexcept>

namespace bullet_fem
{
namespace
{

// Concatenates the string literals between the function's name and the next semicolon; only the escape \n is supported.
std::string literalsOf(const std::string& text, const std::string& function, const std::string& path)
{
    std::string joined;
    bool isInside = false;
    const std::size_t begin = text.find(function + "()");
    for (std::size_t i = begin; i < text.size() && (isInside || text[i] != ';'); ++i)
    {
        if (text[i] == '"')
            isInside = !isInside;
        else if (isInside && text[i] == '\\')
            joined += text[++i] == 'n' ? '\n' : text[i];
        else if (isInside)
            joined += text[i];
    }
    if (joined.empty())
        throw std::runtime_error(path + " has no function " + function +
                                 "() that returns string literals: give a checkout of Bullet 3.24 or later");
    return joined;
}

}  // namespace

TetGenSource readTetGenSource(const std::string& path)
{
    std::ifstream file(path);
    if (!file) throw std::runtime_error(path + " cannot be read: give a checkout of Bullet with its examples");
    std::stringstream text;
    text << file.rdbuf();
    return {literalsOf(text.str(), "getNodes", path), literalsOf(text.str(), "getElements", path)};
}

}  // namespace bullet_fem
