// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "io/text/file_bytes.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace bullet_fem
{

std::string lowerCaseEnding(const std::string& path)
{
    std::string ending = std::filesystem::path(path).extension().string();
    for (char& c : ending)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return ending;
}

void checkIsFile(const std::string& path)
{
    std::error_code ignored;  // a path that cannot be queried counts as missing
    if (!std::filesystem::exists(path, ignored)) throw std::runtime_error("there is no such file");
    if (!std::filesystem::is_regular_file(path, ignored))
        throw std::runtime_error("it is a directory or device, not a file");
}

std::string readBytes(const std::string& path)
{
    checkIsFile(path);
    std::ifstream file(path, std::ios::binary);
    std::string bytes(std::istreambuf_iterator<char>(file), {});
    if (!file || file.bad()) throw std::runtime_error("the file cannot be opened or read; check its permissions");
    return bytes;
}

std::string readHead(const std::string& path, std::size_t most)
{
    checkIsFile(path);
    std::ifstream file(path, std::ios::binary);
    std::string bytes(most, '\0');
    file.read(bytes.data(), static_cast<std::streamsize>(most));
    bytes.resize(static_cast<std::size_t>(file.gcount()));
    return bytes;
}

}  // namespace bullet_fem
